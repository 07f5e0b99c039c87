"""The pressure of a garment where it is worn, and the width that gives a target pressure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from numbers import Real

import numpy as np

from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.materials import Material
from knitcore.mechanics.pressure import LimbPressure, limb_pressure, rest_circumference

Profile = Sequence[tuple[float, float]]
"""Pressure along a limb: pairs of a place in mm and a pressure in mmHg."""


@dataclass(frozen=True)
class Worn(Result):
    """One place along a limb.

    Attributes
    ----------
    at_mm : along the limb, from where the garment begins.
    part : of the garment there.
    rest_mm, worn_mm : circumferences of the garment unworn, and of the limb.
    pressure : on the limb; None where there is none.
    problem : why there is none, such as a loose fit or a strain beyond the lock-up; else empty.
    """

    at_mm: float
    part: str
    rest_mm: float
    worn_mm: float
    pressure: LimbPressure | None
    problem: str = ""

    @property
    def ease(self) -> float:
        """Rest over worn circumference, minus one: negative where the garment is stretched."""
        return self.rest_mm / self.worn_mm - 1

    @property
    def highest_mmhg(self) -> float:
        """Upper end of the pressure: 0 where it is loose, infinite where the fabric is locked."""
        if self.pressure is None:
            return math.inf if self.ease < 0 else 0.0
        return self.pressure.mmhg.high


def worn(
    material: Material,
    fabric: Fabric,
    around: Direction,
    rest_mm: float,
    worn_mm: float,
    *,
    at_mm: float = 0.0,
    part: str = "",
) -> Worn:
    """A place of a garment of one fabric, whose direction ``around`` runs around the limb."""
    try:
        pressure = limb_pressure(material.law(fabric), around, rest_mm, worn_mm)
    except InputError as error:
        return Worn(at_mm, part, rest_mm, worn_mm, None, f"{error.problem} {error.remedy}")
    return Worn(at_mm, part, rest_mm, worn_mm, pressure)


@dataclass(frozen=True)
class Fit:
    """How tight a garment is: by its ease, or by a target pressure.

    Parameters
    ----------
    ease : rest circumference over the limb's, minus one; negative is tighter.
    mmhg : target pressure; takes precedence over the ease. For graded pressure a profile of pairs
        (mm along the limb, mmHg) in rising order, even between them.
    """

    ease: float = -0.15
    mmhg: float | Profile | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.ease, Real):
            problem = f"is of type {type(self.ease).__name__}."
            raise InputError("ease", problem, "Give one number for the whole garment.")
        check_range("ease", self.ease, -0.6, 1, what="an ease")
        if self.mmhg is None or isinstance(self.mmhg, Real):
            return
        pairs = tuple(self.mmhg) if isinstance(self.mmhg, Sequence) else ()
        if not pairs or not all(isinstance(p, Sequence) and len(p) == 2 for p in pairs):
            problem = f"is of type {type(self.mmhg).__name__}, no pressure and no profile of pairs."
            raise InputError("mmhg", problem, "Give one number, or pairs of a place and mmHg.")
        if any(after[0] <= before[0] for before, after in pairwise(pairs)):
            problem = "the places of the profile do not increase."
            raise InputError("mmhg", problem, "Give them in rising order.")

    @property
    def places_mm(self) -> tuple[float, ...]:
        """Places along the limb at which a profile of pressure bends; none without a profile."""
        return tuple(at for at, _ in self.mmhg) if isinstance(self.mmhg, Sequence) else ()

    def mmhg_at(self, at_mm: float) -> float | None:
        """The target pressure at a place along the limb; None if the fit is by ease."""
        if not isinstance(self.mmhg, Sequence):
            return self.mmhg
        return float(np.interp(at_mm, self.places_mm, [mmhg for _, mmhg in self.mmhg]))

    def rest_mm(
        self,
        worn_mm: float,
        material: Material,
        fabric: Fabric,
        around: Direction,
        *,
        at_mm: float = 0.0,
    ) -> float:
        """The rest circumference for a limb; for a pressure, the middle of the interval of sizes.

        Raises
        ------
        InputError
            If the pressure or the circumference cannot be used.
        """
        mmhg = self.mmhg_at(at_mm)
        if mmhg is None:
            return worn_mm * (1 + self.ease)
        sizes = rest_circumference(material.law(fabric), around, worn_mm, mmhg)
        return (sizes.low + sizes.high) / 2
