"""The stitch number of a piece on a machine, and the yarn of its loops there."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import count, takewhile

from knitcore.base.errors import InputError
from knitcore.garment.piece import Piece
from knitcore.garment.regions import yarn_use
from knitcore.machine.dial import Dial, DialSetting
from knitcore.machine.profile import MachineProfile
from knitcore.machine.tension import LoopYarn
from knitcore.materials import Laws, Material
from knitcore.materials.yarn_per_stitch import MeasuredYarn

MOST_LOOSER = 1.3
"""Loops of a loosened row over those of the others: beyond, the row shows as a gap."""
_MARK = re.compile(r"\.[0-9a-f]{6}$")


@dataclass(frozen=True)
class MachineSetting:
    """How a machine is set for a piece.

    Attributes
    ----------
    number : the stitch number.
    yarn : of the loops that it gives; None if the material does not say enough.
    note : what the number is based on, in a sentence.
    looser : larger stitch numbers with the yarn of their loops, for rows before transfers.
    """

    number: float
    yarn: LoopYarn | None
    note: str
    looser: Mapping[float, LoopYarn] = field(default_factory=dict)


def yarn_identifier(material: Material) -> str:
    """The name under which a profile has the swatches of a material.

    It has no mark of laws, nor of the content of a user's material, which may change.
    """
    return _MARK.sub("", Laws.REFITTED.of(material.identifier).removeprefix("own:"))


def setting_of(
    piece: Piece,
    machine: MachineProfile,
    material: Material,
    *,
    stitch_number: float | None = None,
    linear_density_tex: float | None = None,
    measured: MeasuredYarn | None = None,
) -> MachineSetting:
    """Set a machine for the loops of a piece.

    Parameters
    ----------
    stitch_number : given by the user; loops are then those that it makes.
    linear_density_tex : of the yarn; the material's if left out.
    measured : yarn in a stitch of this piece, if known; the material's otherwise.

    Examples
    --------
    >>> from knitcore import StitchChart, material
    >>> from knitcore.machine.profile import profile
    >>> piece = Piece.of(StitchChart.of_fabric("rib", rows=4, columns=4))
    >>> print(setting_of(piece, profile("kniterate"), material("glove-wool")).note)
    Stitch number 7 for loops of 12.6 mm (9.4 to 15.7): a guess from the gauge, so knit two \
swatches, or change it.
    """
    loops_mm = _loop_length_mm(piece, material, measured)
    dial = _dial(machine, yarn_identifier(material))
    number = machine.stitch_number.default if stitch_number is None else stitch_number
    note = f"Stitch number {number:g}, as given."
    if stitch_number is None:
        note = f"Stitch number {number:g}: a start, so knit two swatches, or change it."
        if dial is not None and loops_mm is not None:
            setting = dial.nearest(loops_mm)
            number, note = setting.number, _words(setting, loops_mm, machine)
    if dial is not None and number in dial and (loops_mm is not None or stitch_number is not None):
        loops_mm = dial.loop_length_mm(number)[0]
    yarn = _yarn(material, loops_mm, linear_density_tex)
    return MachineSetting(number, yarn, note, _looser(dial, number, yarn))


def _looser(dial: Dial | None, number: float, yarn: LoopYarn | None) -> dict[float, LoopYarn]:
    """Whole steps of the dial above a number, with their loops, as far as a row may differ."""
    if dial is None or yarn is None:
        return {}
    steps = (number + step for step in count(1.0))
    loops = (
        (loose, replace(yarn, loop_length_mm=dial.loop_length_mm(loose)[0]))
        for loose in takewhile(lambda loose: loose in dial, steps)
    )
    most = MOST_LOOSER * yarn.loop_length_mm
    return dict(takewhile(lambda of: of[1].loop_length_mm <= most, loops))


def _words(setting: DialSetting, loops_mm: float, machine: MachineProfile) -> str:
    low, high = setting.loop_length_interval_mm
    guess = "a guess from the gauge, so knit two swatches, or change it."
    basis = guess if setting.guessed else "by your swatches."
    thirds = round(3 * setting.number)
    is_between = not machine.reads_programs and setting.number % 1
    on_dial = f" (dial at {thirds // 3}{'•' * (thirds % 3)})" if is_between else ""
    far = ""
    if abs(setting.number - setting.exact) > 1:
        far = f" It comes nearest to the {loops_mm:.1f} mm that the yarn has in other cloth."
    return (
        f"Stitch number {setting.number:g}{on_dial} for loops of {setting.loop_length_mm:.1f} mm "
        f"({low:.1f} to {high:.1f}): {basis}{far}"
    )


def _dial(machine: MachineProfile, yarn: str) -> Dial | None:
    """The dial; None where numbers are a machine's own table, and no swatch says what they mean."""
    try:
        return Dial(machine, yarn)
    except InputError:
        if any(swatch.yarn == yarn for swatch in machine.swatches):
            raise
        return None


def _loop_length_mm(
    piece: Piece, material: Material, measured: MeasuredYarn | None
) -> float | None:
    """Mean yarn of the piece's stitches, if it is known."""
    try:
        use = yarn_use(piece.shaped, material, size=piece.gauge, measured=measured)
    except InputError:
        return None
    return 1000 * use.length_m / int(piece.shaped.stitch.sum())


def _yarn(
    material: Material, loops_mm: float | None, linear_density_tex: float | None
) -> LoopYarn | None:
    if loops_mm is None:
        return None
    try:
        return LoopYarn.of(material, loop_length_mm=loops_mm, linear_density_tex=linear_density_tex)
    except InputError:  # no linear density, and no diameter to guess it from
        return None
