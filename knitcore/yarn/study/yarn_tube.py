"""A repeat relaxed in the round: the yarn of a tube with a given number of wales, free of force.

The cell is bent along its courses until its stitches go once around
(:mod:`knitcore.yarn.study.bent_cell`): every stitch turns by 2π over the number of wales. The size
of a stitch along and across and the yarn's shape are free. The tube is long: its ends are far away,
and its courses are closed rings.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, ConvergenceError, InputError, check_cancelled
from knitcore.chart.stitch_chart import check_stitches
from knitcore.yarn.solve.newton import COURSE, WALE
from knitcore.yarn.solve.splines import RelaxedRepeat
from knitcore.yarn.study.bending import MAX_STITCHES
from knitcore.yarn.study.bent_cell import BentCell, Deformation, settled

MIN_WALES = 8
"""Fewest wales around: in narrower tubes yarn from one side meets that of the other."""
MAX_WALES = 100_000
_TURN = 0.05
"""Most by which the angle of a stitch grows at once, rad."""
_LEAST_TURN = 0.002
"""Where a step fails it is halved, down to this, rad."""
_PROBE = 1e-4
"""Change of the curvature for its derivative, times the loop length."""
_REACH = 1.05
"""Pairs are listed up to this many yarn diameters in the bent cell."""
_SETTLED = 1e-5
"""Step, in radii, after which a shape counts as settled."""
_STEPS = 20
"""Most Newton steps to a shape."""


@dataclass(frozen=True)
class Tube:
    """A relaxed tube.

    Attributes
    ----------
    wales : around it.
    face_outside : whether the face is outside.
    cell_course_mm, cell_wale_mm : size of a stitch around, on the surface of mean height, and up.
    energy_n_mm : of a stitch, N·mm; that of the flat repeat is ``flat_energy_n_mm``.
    flat_course_mm, flat_wale_mm : size of a stitch of the flat repeat.
    """

    wales: int
    face_outside: bool
    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    flat_course_mm: float
    flat_wale_mm: float
    flat_energy_n_mm: float

    @property
    def diameter_mm(self) -> float:
        """Diameter of the surface of mean height."""
        return self.wales * self.cell_course_mm / math.pi


def in_the_round(
    relaxed: RelaxedRepeat,
    wales: int,
    *,
    face_outside: bool = True,
    cancelled: Cancelled | None = None,
) -> Tube:
    """Relax a repeat in a tube.

    Parameters
    ----------
    relaxed : the repeat, free of force; symmetries imposed on it are dropped.
    wales : number around the tube, a multiple of the repeat's.
    face_outside : whether the face is outside.
    cancelled : called before every step; True stops with CancelledError.

    Raises
    ------
    InputError
        If the repeat is held or too large, or the number of wales is out of range or not a multiple
        of the repeat's.
    ConvergenceError, UnravelledError
        If the repeat is not in equilibrium without its symmetries, or no shape is found on the way
        to the tube.
    CancelledError
        If ``cancelled`` says so.
    """
    check_stitches(relaxed.chart.stitches, MAX_STITCHES, "its repeat")
    check_range("wales", wales, MIN_WALES, MAX_WALES)
    if wales % relaxed.chart.columns:
        raise InputError(
            "wales",
            f"{wales} is not a multiple of the repeat's {relaxed.chart.columns} columns.",
            "Let the repeat go around a whole number of times.",
        )
    flat = settled(relaxed)
    angle = (1.0 if face_outside else -1.0) * 2.0 * math.pi / wales
    here, value = flat, flat.lagrangian(Deformation()).value
    flat_value = value
    done, parts = 0, math.ceil(abs(angle) / _TURN)
    while done < parts:
        turned = _turned(here, angle * (done + 1) / parts, cancelled)
        if turned is not None:
            (here, value), done = turned, done + 1
        elif abs(angle) < 2.0 * _LEAST_TURN * parts:
            raise ConvergenceError(
                f"The shape gives way in tubes of fewer than {math.ceil(wales * parts / done)} "
                "wales: no equilibrium follows. Use more wales."
                if done
                else "No equilibrium follows from the flat repeat when it is bent. Use more wales."
            )
        else:
            done, parts = 2 * done, 2 * parts
    stitches = flat.energy.cell.stitches
    return Tube(
        wales, face_outside, float(here.state[COURSE]), float(here.state[WALE]), value / stitches,
        float(flat.state[COURSE]), float(flat.state[WALE]), flat_value / stitches,
    )  # fmt: skip


def _turned(
    begin: BentCell, turn: float, cancelled: Cancelled | None
) -> tuple[BentCell, float] | None:
    """Equilibrium with every stitch turned by ``turn``, rad, and its energy, N·mm; None if it is
    not found.

    The equations are multiplied by the inverse of the unbent shape's Hessian, so that a residual is
    a step of the points, and solved by a Newton-Krylov method.
    """
    lengths = len(begin.tension)
    height = begin.rows[lengths]

    def moved(x: Array) -> BentCell:
        state, tension = begin.state + x[: len(begin.state)], x[len(begin.state) :]
        thick = float(np.abs(begin.curve[:, 0, 2]).max()) * abs(turn) / float(state[COURSE])
        reach = _REACH / max(1.0 - thick, 0.1)
        return BentCell(begin.energy, state, begin.tension + tension[:lengths], reach)

    def residual(x: Array) -> Array:
        check_cancelled(cancelled)
        here = moved(x)
        course = float(here.state[COURSE])
        curvature = turn / course
        bent = here.lagrangian(Deformation(course_per_mm=curvature))
        probe = _PROBE / here.energy.mean_loop_mm
        plus, minus = (
            here.lagrangian(Deformation(course_per_mm=curvature + side)).value
            for side in (probe, -probe)
        )
        change, extra = x[: len(begin.state)], x[len(begin.state) + lengths :]
        gradient = bent.gradient + extra @ begin.rows[lengths:]
        gradient[COURSE] -= (plus - minus) / (2.0 * probe) * curvature / course
        off = np.concatenate([bent.excess_mm, begin.rows[lengths:] @ change])
        off[lengths] = height @ here.state
        return np.concatenate(begin.solve(gradient, off, None))

    nothing = np.zeros(len(begin.state) + len(begin.rows))
    try:
        solution = scipy.optimize.root(
            residual, nothing, method="krylov",
            options={"fatol": _SETTLED * begin.energy.yarn.radius_mm, "maxiter": _STEPS},
        )  # fmt: skip
    except ZeroDivisionError:  # scipy's, when its steps no longer change the residual
        return None
    if not solution.success:
        return None
    here = moved(np.asarray(solution.x))
    curvature = turn / float(here.state[COURSE])
    return here, here.lagrangian(Deformation(course_per_mm=curvature)).value
