"""Pressure of a knitted tube of any chart on a limb: a sleeve, a sock, a wrist.

Laplace's law is used with the prediction for the chart; :mod:`knitcore.mechanics.pressure` uses it
with the law of a pure fabric. Along the limb the tube is either free and shortens as in a strip
test, or held at its length. The limb's girth may change along its length.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.chart.result import Result
from knitcore.law.response import MAX_STRESS_N_PER_MM
from knitcore.materials.law_uncertainty import Interval
from knitcore.mechanics.pressure import MAX_CIRCUMFERENCE_MM, MIN_LENGTH, MMHG_PER_KPA, worn_strain
from knitcore.prediction.prediction import Along

PLACES = 21
"""Number of places along the limb, evenly spaced."""
MAX_GIRTHS = 100
LEAST_GIRTH_MM = 10.0
"""Smallest girth that is accepted: half that of the thinnest finger."""


@dataclass(frozen=True)
class TubePressure(Result):
    """Mean pressure of a tube on a limb; intervals go from axially free to fixed, or back.

    Attributes
    ----------
    rest_mm, worn_mm : circumferences, unworn and on the limb.
    strain : around the limb.
    kpa : pressure.
    kpa_with_spread : the same, widened by the 90 % interval of the chart's stress.
    tension_n_per_mm : hoop tension per worn length.
    axial_strain_free : along the limb if nothing holds the tube.
    """

    rest_mm: float
    worn_mm: float
    strain: float
    kpa: Interval
    kpa_with_spread: Interval
    tension_n_per_mm: Interval
    axial_strain_free: float


def tube_pressure(along: Along, rest_mm: float, worn_mm: float) -> TubePressure:
    """Pressure of a tube of a chart on a limb.

    Parameters
    ----------
    along : the chart's prediction for a pull around the limb.
    rest_mm, worn_mm : circumferences, unworn and on the limb.

    Raises
    ------
    InputError
        If a circumference is impossible, the tube is loose, or the limb too large for the fabric.

    Examples
    --------
    >>> from knitcore.prediction.predict import predict
    >>> from knitcore.chart.stitch_chart import StitchChart
    >>> from knitcore.chart.fabric import Direction
    >>> from knitcore.materials import material
    >>> rib = predict(StitchChart.parse("KP"), material("acrylic")).along(Direction.COURSE)
    >>> tube_pressure(rib, 150, 190).kpa.high > tube_pressure(rib, 150, 170).kpa.high
    True
    """
    strain = worn_strain(rest_mm, worn_mm)
    free = float(along.stress(strain))
    axial = float(along.across_strain(free))
    tensions = _tensions(along, strain, free, axial)
    if tensions.high >= MAX_STRESS_N_PER_MM:
        problem = f"this chart runs out of stretch before {100 * strain:.0f} %."
        raise InputError("worn_mm", problem, "Make the tube larger.")
    soft, stiff = (float(end) / free if free else 1.0 for end in along.stress_interval(strain))
    kpa = tensions.scaled(2 * math.pi / worn_mm * 1000.0)
    return TubePressure(
        rest_mm=rest_mm,
        worn_mm=worn_mm,
        strain=strain,
        kpa=kpa,
        kpa_with_spread=Interval(kpa.low * soft, kpa.high * stiff),
        tension_n_per_mm=tensions,
        axial_strain_free=axial,
    )


def tube_for(along: Along, worn_mm: float, mmhg: float) -> Interval:
    """Rest circumferences (mm) of a tube that presses by a target: axially free to fixed.

    Raises
    ------
    InputError
        If the target or the circumference cannot be used, or the chart locks before it.
    """
    check_positive("target_mmhg", mmhg, "mmHg", "a target pressure", 300)
    check_positive("worn_mm", worn_mm, "mm", "a circumference", MAX_CIRCUMFERENCE_MM)
    tension = mmhg / MMHG_PER_KPA / 1000.0 * worn_mm / (2 * math.pi)
    sizes = []
    for end in (0, 1):

        def missing(strain: float, end: int = end) -> float:
            free = float(along.stress(strain))
            both = _tensions(along, strain, free, float(along.across_strain(free)))
            return (both.low, both.high)[end] - tension

        upper = 0.1
        while missing(upper) < 0 and upper < 10:
            upper *= 2
        if missing(upper) < 0:
            raise InputError(
                "target_mmhg", f"no size gives {mmhg:g} mmHg.", "Ask for less pressure."
            )
        sizes.append(worn_mm / (1 + float(scipy.optimize.brentq(missing, 0.0, upper, xtol=1e-9))))
    return Interval(min(sizes), max(sizes))


def _tensions(along: Along, strain: float, free: float, axial: float) -> Interval:
    """Hoop tension per worn length (N/mm), axially free (by a stress and strain) and fixed."""
    shortened = free / max(1 + axial, MIN_LENGTH)
    fixed = float(along.held_stress(strain))
    return Interval(min(shortened, fixed), max(shortened, fixed))


@dataclass(frozen=True)
class MeasuredLimb:
    """A limb by its girths, which change evenly between the places where they were taken.

    Attributes
    ----------
    at_mm : increasing places along the limb, two at least.
    girths_mm : there.

    Raises
    ------
    InputError
        If the lists do not fit each other, the places do not increase, or a girth is too small.
    """

    at_mm: tuple[float, ...]
    girths_mm: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.at_mm) != len(self.girths_mm) or not 2 <= len(self.at_mm) <= MAX_GIRTHS:
            remedy = f"Give 2 to {MAX_GIRTHS} places, and as many sizes."
            raise InputError("girths", "the lists differ in length.", remedy)
        if min(np.diff(self.at_mm)) <= 0.0:
            raise InputError("girths", "the places do not increase.", "Give them in order.")
        if min(self.girths_mm) < LEAST_GIRTH_MM:
            problem = f"{min(self.girths_mm):g} mm around is no limb and no tube."
            remedy = f"Give {LEAST_GIRTH_MM:g} mm or more: the length around, not the width."
            raise InputError("girths", problem, remedy)

    def girth_mm(self, at_mm: Array) -> Array:
        """Circumference at places along the limb; beyond an end it stays as at the end."""
        return np.interp(at_mm, self.at_mm, self.girths_mm)


@dataclass(frozen=True)
class LimbPlace(Result):
    """One place along the limb.

    Attributes
    ----------
    at_mm : along the limb.
    rest_mm, girth_mm : circumferences of the unworn tube, and of the limb.
    lock_up_share : strain around the limb over that at which the chart is locked.
    pressure : on the limb; None where there is none.
    problem : why there is none, such as a loose fit; else empty.
    """

    at_mm: float
    rest_mm: float
    girth_mm: float
    lock_up_share: float
    pressure: TubePressure | None
    problem: str = ""

    @property
    def ease(self) -> float:
        """Circumference of the tube over that of the limb, minus one: negative where stretched."""
        return self.rest_mm / self.girth_mm - 1.0

    @property
    def highest_mmhg(self) -> float:
        """Upper end of the pressure: 0 where it is loose, infinite where the chart is locked."""
        if self.pressure is None:
            return math.inf if self.ease < 0.0 else 0.0
        return MMHG_PER_KPA * self.pressure.kpa.high


def on_limb(
    along: Along,
    at_mm: Sequence[float],
    girths_mm: Sequence[float],
    rests_mm: Sequence[float],
    *,
    places: int = PLACES,
) -> tuple[LimbPlace, ...]:
    """Fit and pressure of a tube along a limb; girths change evenly between those given.

    Parameters
    ----------
    along : the chart's prediction for a pull around the limb.
    at_mm : increasing places along the limb at which girths are given, two at least.
    girths_mm, rests_mm : of the limb and of the unworn tube there.
    places : at which the fit is given.

    Raises
    ------
    InputError
        If the lists do not fit each other or their places do not increase.
    """
    limb = MeasuredLimb(tuple(at_mm), tuple(girths_mm))
    rest = MeasuredLimb(limb.at_mm, tuple(rests_mm))
    at = np.linspace(limb.at_mm[0], limb.at_mm[-1], places)
    sizes = zip(at.tolist(), limb.girth_mm(at).tolist(), rest.girth_mm(at).tolist(), strict=True)
    return tuple(place_on(along, *size) for size in sizes)


def place_on(along: Along, at_mm: float, girth_mm: float, rest_mm: float) -> LimbPlace:
    """Fit of a tube at one place of a limb.

    Parameters
    ----------
    along : the chart's prediction for a pull around the limb.
    at_mm, girth_mm, rest_mm : as in :class:`LimbPlace`.
    """
    share = max(girth_mm / rest_mm - 1.0, 0.0) / along.response.lock_up_strain
    try:
        pressure = tube_pressure(along, rest_mm, girth_mm)
    except InputError as error:
        problem = f"{error.problem} {error.remedy}"
        return LimbPlace(at_mm, rest_mm, girth_mm, share, None, problem)
    return LimbPlace(at_mm, rest_mm, girth_mm, share, pressure)
