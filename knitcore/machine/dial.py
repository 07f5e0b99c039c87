"""The stitch number of a machine for a loop length.

The yarn of a stitch grows with the depth of the stitch cam, in proportion to its number within the
machine's range:

    L = L₀ + s (number - default).

Swatches of one yarn on one machine give L₀ and s by least squares, together with a guess in
proportion to the distance of needles that swatches outweigh: L₀ = 3.2 ± 0.5 and s = 2.4 ± 1.2 over
the whole range, in needles. The guess is from two yarns of the library (lace on a Stoll machine,
stitch size 12: 3.6; worsted on needles of its stitch width: 3.1). Where a machine's numbers are
places in its own table (its default lies at the end of the range), there is no guess, and two
swatches are needed.
"""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.machine.profile import MachineProfile, profile
from knitcore.materials import Interval

LEVEL, LEVEL_SD = 3.2, 0.5
SLOPE, SLOPE_SD = 2.4, 1.2
SWATCH_ERROR = 0.03
"""Relative error of a loop length from a weighed or unravelled swatch; assumed."""
FORMAT = "knitcore-dial"
_Z_90 = 1.645


@dataclass(frozen=True)
class DialSwatch:
    """A swatch knitted at a stitch number, and its yarn per stitch."""

    number: float
    loop_length_mm: float

    @classmethod
    def unravelled(cls, number: float, yarn_mm: float, stitches: int) -> "DialSwatch":
        """A swatch of which the yarn of some stitches was measured."""
        return cls(number, yarn_mm / stitches)

    @classmethod
    def weighed(cls, number: float, mass_g: float, tex: float, stitches: int) -> "DialSwatch":
        """A swatch that was weighed.

        Examples
        --------
        >>> DialSwatch.weighed(6, mass_g=4.0, tex=250, stitches=1600).loop_length_mm
        10.0
        """
        return cls(number, mass_g / tex * 1e6 / stitches)


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
    machine : whose numbers they are.
    yarn : its name.
    swatches : of that yarn on that machine.

    Raises
    ------
    InputError
        If there is no guess for this machine and fewer than two numbers were knitted, or a swatch
        cannot be right.

    Examples
    --------
    >>> dial = Dial(profile("kniterate"), "wool", (DialSwatch(5, 9.2), DialSwatch(7, 11.6)))
    >>> dial.setting(10.4).number
    6.0
    """

    machine: MachineProfile
    yarn: str = ""
    swatches: tuple[DialSwatch, ...] = ()

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
        exact = numbers.default + (loop_length_mm - float(self._fit[0][0])) / self._slope
        value, interval = self.loop_length_mm(exact)
        spread = (value - interval.low) / self._slope
        number = float(round(exact)) if numbers.whole else round(exact, 1)
        if not numbers.least <= number <= numbers.most:
            shortest, longest = (self.loop_length_mm(n)[0] for n in (numbers.least, numbers.most))
            raise InputError(
                "loop_length_mm",
                f"{self.machine.name} makes loops of about {shortest:.1f} to {longest:.1f} mm, "
                f"not of {loop_length_mm:g} mm.",
                "Choose another yarn, or a machine of another gauge.",
            )
        there, around = self.loop_length_mm(number)
        ends = Interval(exact - spread, exact + spread)
        return DialSetting(number, exact, ends, there, around, guessed=not self.swatches)

    def to_json(self) -> str:
        """The dial as the content of a file."""
        swatches = [asdict(swatch) for swatch in self.swatches]
        document = {
            "format": FORMAT,
            "machine": self.machine.identifier,
            "yarn": self.yarn,
            "swatches": swatches,
        }
        return json.dumps(document, indent=2, ensure_ascii=False) + "\n"

    @classmethod
    def read(cls, content: bytes | str, machines: Sequence[MachineProfile] = ()) -> "Dial":
        """Read the content of a file; machines of the user's own are looked up first.

        Raises
        ------
        InputError
            If it is no such file, or names a machine that is not known.
        """
        try:
            document = json.loads(content)
            if document["format"] != FORMAT:
                raise ValueError
            swatches = tuple(
                DialSwatch(float(s["number"]), float(s["loop_length_mm"]))
                for s in document["swatches"]
            )
            name, yarn = str(document["machine"]), str(document.get("yarn", ""))
        except (ValueError, KeyError, TypeError) as error:
            raise InputError(
                "dial", "this is no file of stitch numbers.", "Give one that Knitcore wrote."
            ) from error
        own = {machine.identifier: machine for machine in machines}
        return cls(own.get(name) or profile(name), yarn, swatches)
