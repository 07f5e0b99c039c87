"""The constitutive law of a pair of simulated stretches (the paper's Note 7).

Poisson ratios are the slopes of straight lines through transverse over axial strain. They tie the
couplings to the two stiffnesses, so the joint least squares of both stretches separates into one
problem a direction, solved by non-negative least squares in stiffness and beta over a scan of alpha
(:mod:`knitcore.law.least_squares`). The result depends on the range of stress: knits stiffen.
"""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.least_squares import LINEAR_FLOOR, DirectionFit, fit_direction, law_of_directions
from knitcore.yarn.model.relaxed_cell import Sweep

MAX_STRESS_N_PER_MM = 0.3
"""Upper end of the range that is fitted unless another is asked for."""
_MIN_POINTS = 5


@dataclass(frozen=True)
class SimulatedLaw:
    """A fitted law and how it was fitted.

    Parameters
    ----------
    law : the eight constants.
    max_stress_n_per_mm : upper end of the fitted range of stress, which starts at 0: as requested,
        or where the first of the stretches ends.
    largest_strain_course, largest_strain_wale : largest strains fitted.
    rms_course_n_per_mm, rms_wale_n_per_mm : residuals, root mean square.
    """

    law: ConstitutiveLaw
    max_stress_n_per_mm: float
    largest_strain_course: float
    largest_strain_wale: float
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float


def fit_sweeps(
    course: Sweep, wale: Sweep, max_stress_n_per_mm: float = MAX_STRESS_N_PER_MM
) -> SimulatedLaw:
    """Fit the eight constants to a stretch along the course and one along the wale.

    Parameters
    ----------
    course, wale : the stretches.
    max_stress_n_per_mm : points above this stress are left out.

    Raises
    ------
    InputError
        If a stretch has the wrong direction or fewer than five points in the range, if the points
        leave no positive initial stiffness, or if the constants make no stable law.
    """
    points = {}
    for direction, sweep in ((Direction.COURSE, course), (Direction.WALE, wale)):
        if sweep.direction is not direction:
            raise InputError(
                str(direction), f"is a stretch along the {sweep.direction}.", "Swap the two."
            )
        points[direction] = _in_range(sweep, max_stress_n_per_mm)
    poisson_yx = _slope(*points[Direction.COURSE][:2])
    poisson_xy = _slope(*points[Direction.WALE][:2])
    x = _fit(Direction.COURSE, points[Direction.COURSE], poisson_xy)
    y = _fit(Direction.WALE, points[Direction.WALE], poisson_yx)
    law = law_of_directions(x, y, poisson_yx, poisson_xy)
    top = min(max_stress_n_per_mm, *(float(c.stress_n_per_mm.max()) for c in (course, wale)))
    return SimulatedLaw(law, top, x.largest_strain, y.largest_strain, x.rms, y.rms)


def _in_range(sweep: Sweep, max_stress: float) -> tuple[Array, Array, Array]:
    inside = sweep.stress_n_per_mm <= max_stress
    beyond = np.flatnonzero(~inside)
    if len(beyond):  # the first excess ends the range, even if the stress falls again at a jump
        inside[beyond[0] :] = False
    if np.count_nonzero(inside) < _MIN_POINTS:
        raise InputError(
            "max_stress_n_per_mm",
            f"only {np.count_nonzero(inside)} points of the {sweep.direction} stretch lie below "
            f"{max_stress:g} N/mm.",
            "Stretch in smaller steps, or raise the stress.",
        )
    return sweep.strain[inside], sweep.transverse_strain[inside], sweep.stress_n_per_mm[inside]


def _slope(along: Array, across: Array) -> float:
    return -float(np.polyfit(along, across, 1)[0])


def _fit(direction: Direction, points: tuple[Array, Array, Array], coupling: float) -> DirectionFit:
    along, across, stress = points
    fit = fit_direction(along, across, stress, np.ones_like(stress), coupling)
    floor = LINEAR_FLOOR * float(stress.max()) / fit.largest_strain
    if fit.stiffness <= floor * (1.0 + 1e-6):
        # at its bound it is not a property of the fabric, nor would the modulus from it be
        raise InputError(
            "max_stress_n_per_mm",
            f"up to {stress.max():.3g} N/mm the {direction} stretch stiffens faster than the law "
            "can, and leaves no positive initial stiffness.",
            "Fit a smaller range of stress.",
        )
    return fit
