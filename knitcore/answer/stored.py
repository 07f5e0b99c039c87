"""What the packaged store knows of a repeat, as a measured material would have it.

The composite describes repeats in two directions (basket, moss, broken rib …) only when they are
stretched. For those that were relaxed and stretched on the yarn level the law and the relaxed size
are here, carried to the measured material by the ratio of the pure fabrics
(:mod:`knitcore.answer.carry`). Ribs and welts are left to the corrected composite, which was
checked against sweeps more closely.
"""

from __future__ import annotations

from dataclasses import dataclass

from knitcore.answer.carry import carried_law
from knitcore.answer.composite import layout_of
from knitcore.answer.relaxed import RelaxedSize, SizeSource
from knitcore.chart import StitchChart
from knitcore.fabric import Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials import Material
from knitcore.phases import quarter_phases, reference_fabric
from knitcore.yarnlibrary.store import StoredStitch, stored_stitch

STORED_MATERIALS = ("acrylic", "cotton")
_JUMPS = (
    "Stretched on the yarn level, the folds of this repeat open abruptly; its law is a smooth "
    "curve through that."
)
MOST_STITCHES = 16
"""Larger repeats are not in the store, and not looked for."""


@dataclass(frozen=True)
class KnownRepeat:
    """A repeat that was relaxed and stretched on the yarn level.

    Attributes
    ----------
    law : of the repeat in the measured material.
    relaxed : size of its mean stitch at rest.
    notes : what a user should know about the law.
    """

    law: ConstitutiveLaw
    relaxed: RelaxedSize
    notes: tuple[str, ...] = ()


def known_repeat(chart: StitchChart, material: Material) -> KnownRepeat | None:
    """What the store knows of a chart, or None: pure fabrics, ribs, welts and unknown repeats.

    Parameters
    ----------
    chart : a repeat, or a swatch that may cut its last repeat off.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> basket = StitchChart.parse("KKPP\\nKKPP\\nPPKK\\nPPKK")
    >>> known = known_repeat(basket, material("acrylic"))
    >>> known is not None and known.law.modulus_course < 0.05  # it unfolds
    True
    >>> known_repeat(StitchChart.parse("KKPP"), material("acrylic")) is None
    True
    """
    repeat = chart.repeat_cut()
    if (
        material.identifier not in STORED_MATERIALS
        or repeat.rows * repeat.columns > MOST_STITCHES
        or layout_of(repeat) is not None
        or len(set(quarter_phases(repeat, periodic=True).ravel().tolist())) == 1
    ):
        return None
    stored = stored_stitch(repeat, material.identifier)
    if stored is None or stored.law is None or not stored.converged:
        return None
    pure = {fabric: _pure(fabric, material.identifier) for fabric in Fabric}
    laws = {f: s.law for f, s in pure.items() if s is not None and s.law is not None}
    reference = reference_fabric(repeat)
    like = pure[reference]
    if like is None or len(laws) < len(Fabric):
        return None
    record = material.record(reference)
    return KnownRepeat(
        law=carried_law(stored.law, laws, repeat, material),
        relaxed=RelaxedSize(
            stored.cell_course_mm / like.cell_course_mm * record.stitch_course_mm,
            stored.cell_wale_mm / like.cell_wale_mm * record.stitch_wale_mm,
            SizeSource.YARN_LEVEL,
        ),
        notes=(_JUMPS,) if any(stored.law_jumps) else (),
    )


def _pure(fabric: Fabric, material: str) -> StoredStitch | None:
    return stored_stitch(StitchChart.of_fabric(fabric, rows=2, columns=2), material)
