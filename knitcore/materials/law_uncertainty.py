"""Uncertainty of a law's linear constants, and intervals made of it.

Moduli are positive and their relative errors are large (the paper prints 0.003 ± 0.005 N/mm for
cotton rib), so they are carried as standard deviations of the logarithm: a coefficient of variation
c becomes sqrt(ln(1 + c²)), which has the same variance and never crosses zero.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction

COVERAGE = 0.90
"""Probability content of all intervals."""

Z_SCORE = NormalDist().inv_cdf(0.5 + COVERAGE / 2)
"""Half width of a 90 % interval in standard deviations."""

DEFAULT_POISSON_SD = 0.02
"""Standard deviation of a measured Poisson ratio printed without one: the largest ± of acrylic and
cotton."""

MODEL_POISSON_SD = 0.05
"""Standard deviation of a Poisson ratio from a model."""

YARN_LEVEL_LOG_SD = 0.37
"""Standard deviation of the logarithm of a yarn-level modulus. Yarn-level moduli of the pure
fabrics are off by a factor of 2.1 (rms). Scaling a law to the measured pure fabrics removes the
error that its phases have in common; half of the rest, in logarithms, is kept."""


YARN_LEVEL_SIZE_LOG_SD = 0.16
"""Standard deviation of the logarithm of a relaxed width or height: rms of yarn-level over knitted
sizes, the four pure fabrics of acrylic and cotton (``studies/against_knitted.py``)."""

YARN_LEVEL_FREE_SIZE_LOG_SD = 0.27
"""Standard deviation of the same logarithm for shapes relaxed without the chart's symmetries."""

YARN_LEVEL_STRAIN_LOG_SD = 0.41
"""Standard deviation of the logarithm of the strain at 0.05 to 0.3 N/mm, likewise."""

YARN_LEVEL_ERRORS = (
    "The yarn level against knitted fabric: the four pure fabrics of acrylic and cotton. Mixed "
    "charts, which fold too far without friction, may be further off."
)

RS_LOG_SD = 0.72
"""Standard deviation of the logarithm of a modulus of the reduced-symmetry model, likewise."""

RS_ERRORS = "The model against the measured moduli of the pure fabrics of acrylic and cotton."

QUIET_STRESS_N_PER_MM = 0.03
"""Stress below which a stretch test shows slack rather than the law."""


@dataclass(frozen=True)
class Interval:
    """An interval, in the unit of its value; it covers 90 % unless stated.

    Examples
    --------
    >>> low, high = Interval(0.1, 0.2)
    """

    low: float
    high: float

    def __iter__(self) -> Iterator[float]:
        """Both ends, the lower one first."""
        return iter((self.low, self.high))

    def scaled(self, factor: float) -> Interval:
        """The interval in another unit."""
        return Interval(self.low * factor, self.high * factor)


@dataclass(frozen=True)
class CurveUncertainty:
    """Standard deviations of a fabric's stress-strain curve in one direction, as logarithms.

    Attributes
    ----------
    log_stress : of the stress at a strain, above about :data:`QUIET_STRESS_N_PER_MM`.
    log_lock_up : of the lock-up strain 1 / alpha.
    """

    log_stress: float
    log_lock_up: float = 0.0


@dataclass(frozen=True)
class LawUncertainty:
    """Standard deviations of a fabric's law.

    Attributes
    ----------
    log_modulus_course, log_modulus_wale : of the logarithms of Y_x and Y_y.
    poisson_yx, poisson_xy : absolute.
    source : where they come from, in words.
    curve_course, curve_wale : of the whole curves; by default the stress is as uncertain as the
        modulus.
    log_shear : of the logarithm of the shear modulus; None where that is an assumption.
    """

    log_modulus_course: float
    log_modulus_wale: float
    poisson_yx: float
    poisson_xy: float
    source: str
    curve_course: CurveUncertainty | None = None
    curve_wale: CurveUncertainty | None = None
    log_shear: float | None = None

    def log_modulus(self, direction: Direction) -> float:
        """Standard deviation of the logarithm of Young's modulus in a direction."""
        return direction.of(self.log_modulus_course, self.log_modulus_wale)

    def poisson(self, direction: Direction) -> float:
        """Standard deviation of the contraction across a pull in a direction."""
        return direction.of(self.poisson_yx, self.poisson_xy)

    def curve(self, direction: Direction) -> CurveUncertainty:
        """Uncertainty of the stress-strain curve in a direction."""
        known = direction.of(self.curve_course, self.curve_wale)
        return known or CurveUncertainty(self.log_modulus(direction))

    def log_stress(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Standard deviation of the logarithm of a stress, at the strain that carries it.

        At small stress it is that of the modulus, then that of the curve.
        """
        first = 1 / (1 + (np.asarray(stress_n_per_mm, dtype=float) / QUIET_STRESS_N_PER_MM) ** 2)
        modulus, curve = self.log_modulus(direction), self.curve(direction).log_stress
        return np.sqrt(first * modulus**2 + (1 - first) * curve**2)


def in_a_sentence(sources: Iterable[str]) -> str:
    """Join the sources of intervals to a sentence, each source once.

    Examples
    --------
    >>> in_a_sentence(["pulls left out", "an assumed shear modulus", "pulls left out"])
    'Pulls left out; an assumed shear modulus.'
    """
    text = "; ".join(dict.fromkeys(sources))
    return f"{text[:1].upper()}{text[1:]}."


def log_deviation(value: float, standard_deviation: float) -> float:
    """Standard deviation of the logarithm of a positive quantity."""
    return math.sqrt(math.log1p((standard_deviation / value) ** 2))


def log_interval(value: float, log_standard_deviation: float) -> Interval:
    """Interval of a positive quantity whose logarithm has this standard deviation.

    Examples
    --------
    >>> interval = log_interval(0.223, log_deviation(0.223, 0.021))
    >>> round(interval.low, 3), round(interval.high, 3)
    (0.191, 0.26)
    """
    factor = math.exp(Z_SCORE * log_standard_deviation)
    return Interval(value / factor, value * factor)


def normal_interval(value: float, standard_deviation: float) -> Interval:
    """Interval of a quantity with a symmetric error."""
    return Interval(value - Z_SCORE * standard_deviation, value + Z_SCORE * standard_deviation)
