"""The stitch number of a machine for a loop length.

The yarn of a stitch grows with the depth of the stitch cam, in proportion to its number within the
machine's range:

    L = L₀ + s (number - default).

Swatches of one yarn on one machine give L₀ and s by least squares, together with a guess in
proportion to the distance of needles that swatches outweigh: L₀ = 3.2 ± 0.5 and s = 2.4 ± 1.2 over
the whole range, in needles. The guess is from two yarns of the library (lace on a Stoll machine,
stitch size 12: 3.6; worsted on needles of its stitch width: 3.1). Where a machine's numbers are
places in its own table (its default lies at the end of the range), there is no guess, and two
swatches are needed. Swatches are kept in the machine's profile.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.machine.profile import DialSwatch, MachineProfile
from knitcore.materials import Interval

LEVEL, LEVEL_SD = 3.2, 0.5
SLOPE, SLOPE_SD = 2.4, 1.2
SWATCH_ERROR = 0.03
"""Relative error of a loop length from a weighed or unravelled swatch; assumed."""
_Z_90 = 1.645


@dataclass(frozen=True)
class DialSetting:
    """A stitch number for a loop length.

    Attributes
    ----------
    number : that the machine can be set to.
    exact, exact_interval : the number before rounding, with its 90 % interval.
    loop_length_mm, loop_length_interval_mm : what that number gives, with its 90 % interval.
    guessed : whether no swatch stands behind it.
    """

    number: float
    exact: float
    exact_interval: Interval
    loop_length_mm: float
    loop_length_interval_mm: Interval
    guessed: bool

    def to_dict(self) -> dict[str, Any]:
        """Collect the figures by name."""
        return {
            **vars(self),
            "exact_interval": list(self.exact_interval),
            "loop_length_interval_mm": list(self.loop_length_interval_mm),
        }

    def __str__(self) -> str:
        low, high = self.loop_length_interval_mm
        basis = "a guess without swatches" if self.guessed else "from swatches"
        return (
            f"stitch number {self.number:g} for loops of {self.loop_length_mm:.1f} mm "
            f"({low:.1f} to {high:.1f}), {basis}"
        )


@dataclass(frozen=True)
class Dial:
    """Loop lengths of a yarn on a machine by stitch number.

    Attributes
    ----------
    machine : whose numbers they are; its profile has the swatches.
    yarn : the identifier of the material.

    Raises
    ------
    InputError
        If there is no guess for this machine and fewer than two numbers were knitted, or a swatch
        cannot be right.

    Examples
    --------
    >>> from knitcore.machine.profile import profile
    >>> swatches = DialSwatch(5, 9.2, "wool"), DialSwatch(7, 11.6, "wool")
    >>> dial = Dial(with_swatches(profile("kniterate"), swatches), "wool")
    >>> dial.setting(10.4).number
    6.0
    """

    machine: MachineProfile
    yarn: str = ""

    def __post_init__(self) -> None:
        numbers = self.machine.stitch_number
        for swatch in self.swatches:
            if not numbers.least <= swatch.number <= numbers.most:
                raise InputError(
                    "swatches",
                    f"{self.machine.name} has no stitch number {swatch.number:g}.",
                    f"Give numbers from {numbers.least:g} to {numbers.most:g}.",
                )
            if not self._pitch_mm < swatch.loop_length_mm < 20 * self._pitch_mm:
                raise InputError(
                    "swatches",
                    f"{swatch.loop_length_mm:g} mm of yarn a stitch do not fit needles "
                    f"{self._pitch_mm:.1f} mm apart.",
                    "Divide the yarn of the swatch by its stitches, in mm.",
                )
        if not self._has_guess and len({swatch.number for swatch in self.swatches}) < 2:
            raise InputError(
                "swatches",
                f"the stitch numbers of {self.machine.name} are places in its own table.",
                "Knit swatches at two numbers and give the yarn per stitch of each.",
            )
        if self._slope <= 0:
            raise InputError(
                "swatches",
                "larger stitch numbers gave shorter loops.",
                "Check which swatch was knitted at which number.",
            )

    @cached_property
    def swatches(self) -> tuple[DialSwatch, ...]:
        """The swatches of the yarn."""
        return tuple(swatch for swatch in self.machine.swatches if swatch.yarn == self.yarn)

    @property
    def _pitch_mm(self) -> float:
        return self.machine.pitch_mm * self.machine.needles_per_column

    @property
    def _range(self) -> float:
        return self.machine.stitch_number.most - self.machine.stitch_number.least

    @property
    def _has_guess(self) -> bool:
        numbers = self.machine.stitch_number
        return 0.1 < (numbers.default - numbers.least) / max(self._range, 1e-9) < 0.9

    @cached_property
    def _fit(self) -> tuple[Array, Array]:
        """Length at the default and its growth by one number, (2,), and their covariance."""
        precision, moment = np.zeros((2, 2)), np.zeros(2)
        if self._has_guess:
            pitch, span = self._pitch_mm, self._range
            precision = np.diag([(LEVEL_SD * pitch) ** -2.0, (SLOPE_SD * pitch / span) ** -2.0])
            moment = precision @ [LEVEL * pitch, SLOPE * pitch / span]
        for swatch in self.swatches:
            row = np.array([1.0, swatch.number - self.machine.stitch_number.default])
            weight = (SWATCH_ERROR * swatch.loop_length_mm) ** -2.0
            precision = precision + weight * np.outer(row, row)
            moment = moment + weight * swatch.loop_length_mm * row
        covariance = np.asarray(np.linalg.inv(precision), dtype=float)
        return covariance @ moment, covariance

    @property
    def _slope(self) -> float:
        return float(self._fit[0][1])

    def loop_length_mm(self, number: float) -> tuple[float, Interval]:
        """The loop length at a number, with its 90 % interval."""
        mean, covariance = self._fit
        row = np.array([1.0, number - self.machine.stitch_number.default])
        value = float(row @ mean)
        spread = math.sqrt(float(row @ covariance @ row) + (SWATCH_ERROR * value) ** 2)
        return value, Interval(value - _Z_90 * spread, value + _Z_90 * spread)

    def setting(self, loop_length_mm: float) -> DialSetting:
        """The stitch number for a loop length.

        Raises
        ------
        InputError
            If the machine has no number for it.
        """
        numbers = self.machine.stitch_number
        if self._number(self._exact(loop_length_mm)) not in self:
            shortest, longest = (self.loop_length_mm(n)[0] for n in (numbers.least, numbers.most))
            raise InputError(
                "loop_length_mm",
                f"{self.machine.name} makes loops of about {shortest:.1f} to {longest:.1f} mm, "
                f"not of {loop_length_mm:g} mm.",
                "Choose another yarn, or a machine of another gauge.",
            )
        return self.nearest(loop_length_mm)

    def nearest(self, loop_length_mm: float) -> DialSetting:
        """The stitch number for a loop length, or the one that comes nearest to it."""
        numbers = self.machine.stitch_number
        exact = self._exact(loop_length_mm)
        value, interval = self.loop_length_mm(exact)
        spread = (value - interval.low) / self._slope
        number = min(max(self._number(exact), numbers.least), numbers.most)
        there, around = self.loop_length_mm(number)
        ends = Interval(exact - spread, exact + spread)
        return DialSetting(number, exact, ends, there, around, guessed=not self.swatches)

    def _exact(self, loop_length_mm: float) -> float:
        default = self.machine.stitch_number.default
        return default + (loop_length_mm - float(self._fit[0][0])) / self._slope

    def _number(self, exact: float) -> float:
        """The nearest number that the machine can be set to."""
        return float(round(exact)) if self.machine.stitch_number.whole else round(exact, 1) + 0.0

    def __contains__(self, number: float) -> bool:
        """Say whether the machine has a number."""
        return self.machine.stitch_number.least <= number <= self.machine.stitch_number.most

    def __str__(self) -> str:
        default = self.machine.stitch_number.default
        value, (low, high) = self.loop_length_mm(default)
        count = len(self.swatches)
        basis = f"{count} swatch{'es' * (count > 1)}" if count else "a guess from the gauge"
        return (
            f"stitch number {default:g} gives loops of {value:.1f} mm ({low:.1f} to {high:.1f}), "
            f"each further number {self._slope:.2g} mm more; by {basis}"
        )


def with_swatches(machine: MachineProfile, swatches: Sequence[DialSwatch]) -> MachineProfile:
    """The machine with further swatches in its profile, and what they say of each yarn.

    Raises
    ------
    InputError
        If a swatch cannot be right, or one more is needed.
    """
    known = [*machine.swatches, *(swatch for swatch in swatches if swatch not in machine.swatches)]
    changed = replace(machine, swatches=tuple(known))
    fits = [f"{yarn or 'yarn'}: {Dial(changed, yarn)}" for yarn in yarns_of(changed)]
    if not fits:
        return machine
    words = f"swatches of the user's; {'; '.join(fits)}"
    return replace(changed, sources={**machine.sources, "swatches": words})


def yarns_of(machine: MachineProfile) -> tuple[str, ...]:
    """Yarns with swatches, in the order of the profile."""
    return tuple(dict.fromkeys(swatch.yarn for swatch in machine.swatches))
