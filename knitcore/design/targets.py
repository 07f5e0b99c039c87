"""Quantities that a fabric can be searched for, and their values for the repeats of an atlas."""

import math
import re
from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.choice import Choice
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.design.atlas import Atlas
from knitcore.materials.law_uncertainty import Z_SCORE
from knitcore.mechanics.pressure import MIN_LENGTH, MMHG_PER_KPA

USUAL_LOAD_N_PER_MM = 0.1
MAX_LOAD_N_PER_MM = 0.5


_UNIT = re.compile(r"_(n_per_mm|mm_per_n|mmhg)$")


class Quantity(Choice):
    """A quantity that a fabric can be searched for."""

    MODULUS_COURSE = "modulus_course_n_per_mm"
    MODULUS_WALE = "modulus_wale_n_per_mm"
    EXTENSIBILITY_COURSE = "extensibility_course_mm_per_n"
    EXTENSIBILITY_WALE = "extensibility_wale_mm_per_n"
    ANISOTROPY = "anisotropy"
    POISSON_COURSE = "poisson_yx"
    POISSON_WALE = "poisson_xy"
    STRETCH_COURSE = "stretch_course"
    STRETCH_WALE = "stretch_wale"
    PRESSURE_COURSE = "pressure_course_mmhg"
    PRESSURE_WALE = "pressure_wale_mmhg"

    @classmethod
    def parse(cls, name: str) -> Self:
        """Find a quantity by its name, with or without its unit.

        Raises
        ------
        InputError
            If there is none of this name.

        Examples
        --------
        >>> Quantity.parse("modulus_course") is Quantity.MODULUS_COURSE
        True
        """
        by_name = {_UNIT.sub("", quantity): quantity for quantity in cls}
        return by_name[name] if name in by_name else super().parse(name)

    @property
    def direction(self) -> Direction:
        """The direction along which it is measured; the course for the anisotropy."""
        wale = self is Quantity.POISSON_WALE or "wale" in self.value
        return Direction.WALE if wale else Direction.COURSE

    @property
    def is_poisson(self) -> bool:
        """Poisson's ratios may be 0 or negative: their deviations are differences."""
        return self in (Quantity.POISSON_COURSE, Quantity.POISSON_WALE)

    @property
    def needs_load(self) -> bool:
        """Say whether the quantity is defined at a load."""
        return self in (Quantity.STRETCH_COURSE, Quantity.STRETCH_WALE)

    @property
    def needs_limb(self) -> bool:
        """Say whether the quantity is defined on a limb."""
        return self in (Quantity.PRESSURE_COURSE, Quantity.PRESSURE_WALE)


@dataclass(frozen=True)
class WornTube:
    """A tube and how far a limb stretches it.

    Attributes
    ----------
    rest_mm, worn_mm : circumference of the tube, unworn and on the limb.
    """

    rest_mm: float
    worn_mm: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.worn_mm) and 0 < self.rest_mm < self.worn_mm <= 5000):
            problem = f"{self.rest_mm:g} mm on {self.worn_mm:g} mm exerts no pressure."
            remedy = "Give a tube that is smaller than the limb, both in mm."
            raise InputError("limb", problem, remedy)

    @property
    def strain(self) -> float:
        """Strain around the limb."""
        return self.worn_mm / self.rest_mm - 1


@dataclass(frozen=True)
class Target:
    """A target value of a quantity.

    Attributes
    ----------
    quantity : what is sought, or its name with or without the unit; the anisotropy is Y_course /
        Y_wale, stretch is a strain (0.5 = 50 %) with the cloth free across the pull, pressure that
        of a tube whose direction runs around the limb.
    value : the target; above 0 except for Poisson's ratios.
    tolerance : relative deviation that still counts as reached (0.1 = 10 %); for Poisson's ratios
        the difference.
    weight : relative to the other targets.
    load_n_per_mm : for a stretch.
    limb : for a pressure.
    """

    quantity: Quantity
    value: float
    tolerance: float = 0.10
    weight: float = 1.0
    load_n_per_mm: float = USUAL_LOAD_N_PER_MM
    limb: WornTube | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "quantity", Quantity.parse(self.quantity))
        for name in ("value", "tolerance", "weight"):
            number = getattr(self, name)
            signed = name == "value" and self.quantity.is_poisson
            if not (math.isfinite(number) and (number > 0 or signed)):
                raise InputError(
                    f"targets.{self.quantity}", f"its {name} is {number:g}.", "Give more than 0."
                )
        if self.quantity.needs_load and not 0 < self.load_n_per_mm <= MAX_LOAD_N_PER_MM:
            problem = f"its load is {self.load_n_per_mm:g} N/mm."
            remedy = f"Give above 0 to {MAX_LOAD_N_PER_MM:g} N/mm."
            raise InputError(f"targets.{self.quantity}", problem, remedy)
        if self.quantity.needs_limb and self.limb is None:
            remedy = "Give the circumference of the tube and of the limb."
            raise InputError(f"targets.{self.quantity}", "it names no limb.", remedy)

    @property
    def label(self) -> str:
        """The quantity, with its load or limb.

        Examples
        --------
        >>> Target(Quantity.STRETCH_COURSE, 0.5, load_n_per_mm=0.05).label
        'stretch_course@0.05'
        """
        if self.quantity.needs_load:
            return f"{self.quantity}@{self.load_n_per_mm:g}"
        if self.limb is not None and self.quantity.needs_limb:
            return f"{self.quantity}@{self.limb.rest_mm:g}/{self.limb.worn_mm:g}"
        return self.quantity.value

    def deviation(self, value: float) -> float:
        """Predicted over target, minus one; the difference for Poisson's ratios."""
        return value - self.value if self.quantity.is_poisson else value / self.value - 1

    def off(self, values: Array) -> Array:
        """Distance of values in tolerances; infinite where there is no value."""
        if self.quantity.is_poisson:
            away = np.abs(values - self.value) / self.tolerance
        else:
            away = np.abs(np.log(values / self.value)) / math.log1p(self.tolerance)
        return np.where(np.isnan(away), np.inf, away) - 1e-12  # allows for rounding

    def chance(self, value: Array, low: Array, high: Array) -> Array:
        """Probability that a quantity is within the tolerance; 0 where there is no value.

        Parameters
        ----------
        value, low, high : prediction and the ends of its 90 % interval, alike in shape. On either
            side of the value the quantity is taken as normal, on a logarithmic scale except for
            Poisson's ratios; an end that is NaN is taken as far away as the other.
        """
        if not self.quantity.is_poisson:
            value, low, high = np.log(value), np.log(low), np.log(high)
            centre, half = math.log(self.value), math.log1p(self.tolerance)
        else:
            centre, half = self.value, self.tolerance
        below, above = (np.maximum(width, 1e-12) / Z_SCORE for width in (value - low, high - value))
        below, above = (
            np.where(np.isnan(below), above, below),
            np.where(np.isnan(above), below, above),
        )

        def up_to(end: float) -> Array:
            away = end - value
            return np.asarray(scipy.special.ndtr(away / np.where(away < 0, below, above)))

        return np.nan_to_num(up_to(centre + half) - up_to(centre - half))


def values_of(atlas: Atlas, target: Target) -> tuple[Array, Array, Array]:
    """Predicted value of every repeat, and the ends of its interval; NaN where there is none.

    Intervals cover 90 %. That of a stretch applies the uncertainty of the modulus to the whole
    scale of stress; that of a pressure goes from axially free to axially fixed, widened by it.
    """
    quantity, direction = target.quantity, target.quantity.direction
    course, wale = (
        tuple(atlas.column(f"modulus_{d}_{part}") for part in ("n_per_mm", "low", "high"))
        for d in Direction
    )
    if quantity is Quantity.ANISOTROPY:
        ratio = course[0] / wale[0]
        spread = np.hypot(*(np.log(high / value) for value, _, high in (course, wale)))
        return ratio, ratio / np.exp(spread), ratio * np.exp(spread)
    if quantity.is_poisson:
        return (
            atlas.column(quantity),
            atlas.column(f"{quantity}_low"),
            atlas.column(f"{quantity}_high"),
        )
    value, low, high = direction.of(course, wale)
    if quantity.needs_load:
        load = target.load_n_per_mm
        return (
            atlas.strain_at(direction, load),
            atlas.strain_at(direction, load * value / high),
            atlas.strain_at(direction, np.minimum(load * value / low, MAX_LOAD_N_PER_MM)),
        )
    if target.limb is not None and quantity.needs_limb:
        loose, tight = _pressures_mmhg(atlas, direction, target.limb)
        return np.sqrt(loose * tight), loose * low / value, tight * high / value
    if quantity in (Quantity.EXTENSIBILITY_COURSE, Quantity.EXTENSIBILITY_WALE):
        return 1 / value, 1 / high, 1 / low
    return value, low, high


def _pressures_mmhg(atlas: Atlas, direction: Direction, limb: WornTube) -> tuple[Array, Array]:
    """Pressures of a tube, the lower and the higher of axially free and axially fixed.

    As :func:`knitcore.mechanics.pressure.limb_pressure`, with the repeats' curves: free across,
    the tube shortens; fixed, its width is held.
    """
    free = atlas.stress_at(direction, limb.strain)
    fixed = atlas.held_stress_at(direction, limb.strain)
    shortened = free / np.maximum(1 + atlas.across_at(direction, free), MIN_LENGTH)
    to_mmhg = 2 * math.pi / limb.worn_mm * 1000.0 * MMHG_PER_KPA
    return np.minimum(shortened, fixed) * to_mmhg, np.maximum(shortened, fixed) * to_mmhg
