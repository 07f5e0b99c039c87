"""Pressure of a tube of any chart on a limb: Laplace's law with the chart's own answer.

As :mod:`knitcore.mechanics.pressure`, where a pure fabric has a law: free along the limb the tube
shortens as in a strip test, held there its width stays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq

from knitcore.answer.answer import Along
from knitcore.bounds import check_positive
from knitcore.errors import InputError
from knitcore.law.response import MAX_STRESS_N_PER_MM
from knitcore.materials.uncertainty import Interval
from knitcore.mechanics.pressure import (
    MAX_CIRCUMFERENCE_MM,
    MIN_LENGTH,
    MMHG_PER_KPA,
    worn_strain,
)


@dataclass(frozen=True)
class TubePressure:
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
    along : the chart's answer for a pull around the limb.
    rest_mm, worn_mm : circumferences, unworn and on the limb.

    Raises
    ------
    InputError
        If a circumference is impossible, the tube is loose, or the limb too large for the fabric.

    Examples
    --------
    >>> from knitcore.answer.choose import choose
    >>> from knitcore.chart import StitchChart
    >>> from knitcore.fabric import Direction
    >>> from knitcore.materials import material
    >>> rib = choose(StitchChart.parse("KP"), material("acrylic")).along(Direction.COURSE)
    >>> tube_pressure(rib, 150, 190).kpa.high > tube_pressure(rib, 150, 170).kpa.high
    True
    """
    strain = worn_strain(rest_mm, worn_mm)
    free = float(along.stress(strain))
    axial = float(along.across_strain(free))
    tensions = _tensions(along, strain, free, axial)
    if tensions.high >= MAX_STRESS_N_PER_MM:
        raise InputError(
            "worn_mm",
            f"a strain of {strain:.2f} is at or beyond the lock-up of this chart.",
            "Make the tube larger.",
        )
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
    wanted = mmhg / MMHG_PER_KPA / 1000.0 * worn_mm / (2 * math.pi)
    found = []
    for end in (0, 1):

        def missing(strain: float, end: int = end) -> float:
            free = float(along.stress(strain))
            both = _tensions(along, strain, free, float(along.across_strain(free)))
            return (both.low, both.high)[end] - wanted

        upper = 0.1
        while missing(upper) < 0 and upper < 10:
            upper *= 2
        if missing(upper) < 0:
            raise InputError(
                "target_mmhg", f"no size gives {mmhg:g} mmHg.", "Ask for less pressure."
            )
        found.append(worn_mm / (1 + float(brentq(missing, 0.0, upper, xtol=1e-9))))
    return Interval(min(found), max(found))


def _tensions(along: Along, strain: float, free: float, axial: float) -> Interval:
    """Hoop tension per worn length (N/mm), axially free (by a stress and strain) and fixed."""
    shortened = free / max(1 + axial, MIN_LENGTH)
    fixed = float(along.held_stress(strain))
    return Interval(min(shortened, fixed), max(shortened, fixed))
