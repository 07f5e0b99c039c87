"""Damped Newton iterations on the energy of a cell, every step certified.

The Hessian is exact and small (48 unknowns a stitch, half of that with a wale axis). Where the
energy is not convex, H + mu I is factorised with increasing mu until a factor exists
(Levenberg-Marquardt). The length of each course is a constraint: a step and the change of the
tensions follow from one system (Newton on the Lagrangian), and the augmented Lagrangian with these
tensions is the merit function, which must fall. Inextensible yarn makes its valley narrow and
curved, so that a step along it leaves it; steps with the factor of the last Hessian return to it at
a fraction of the cost.

On convergence the Hessian distinguishes a minimum from a saddle, where a state can be trapped by a
symmetry of the first shape; a saddle is left along its direction of most negative curvature.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, lapack

from knitcore.arrays import Array
from knitcore.errors import CancelledError, UnravelledError
from knitcore.threads import one_blas_thread
from knitcore.yarnlevel.energy import CellEnergy, Slope, Terms
from knitcore.yarnlevel.trajectory import Trajectory

COURSE, WALE = -2, -1
"""Places of the two cell sizes among the unknowns."""

_DAMPING = 100.0
"""First damping, in B / L³."""
_LEAST_DAMPING = 1e-6
"""Least damping, relative to the first."""
_INDEFINITE_DAMPING = 0.05
"""Least damping that is tried where the Hessian is not positive definite, relative to the first."""
_SINGLE_FROM = 450
"""Systems of at least this many unknowns are factored in single precision, in half the time. With
its diagonal
scaled to one the damped matrix has a condition of some 1e5, which leaves steps of two digits."""
_LEAST_DAMPING_SINGLE = 1e-3
"""Least damping for a factor in single precision, relative to the first."""
_TRIALS = 60
_WORTH = 0.2
"""A step with an old factor that gains less than this part of the step before is the last."""
_NO_STEP = 1e-9
_STABLE = 0.02
"""Damping, relative to the first, below which the factor of a minimum exists (rigid motions of the
sheet have no stiffness)."""
_POWER_STEPS = 40
_NUDGES = 6


@dataclass(frozen=True)
class Options:
    """Settings of the minimisation.

    Parameters
    ----------
    pair_cap : longest change of the vector between near samples in one step, in radii.
    relief : factor on the damping after a step that went as predicted.
    chord_steps : most steps with an old factor after each new one.
    tolerance : stop when a Newton step would lower the energy by less than this part of it.
    slack : stop only when the lengths are within this part of a loop length.
    iterations : most Newton steps.
    """

    pair_cap: float = 0.3
    relief: float = 6.0
    chord_steps: int = 3
    tolerance: float = 1e-7
    slack: float = 1e-7
    iterations: int = 400


@dataclass(frozen=True, eq=False)
class Minimum:
    """The result of a minimisation.

    Attributes
    ----------
    state : unknowns.
    tension : (constraints,) tension of each course or stitch, then forces of other constraints, N.
    terms : parts of the energy.
    force : (2,) dE/d(size of a stitch), N, course-wise and wale-wise, for the whole cell.
    min_distance_mm : smallest distance of centre lines.
    converged : whether the tolerance was reached.
    stable : whether it is a minimum among the shapes of its cell, not a saddle.
    steps, evaluations : Newton steps taken, energies evaluated.
    """

    state: Array
    tension: Array
    terms: Terms
    force: Array
    min_distance_mm: float
    converged: bool
    stable: bool
    steps: int
    evaluations: int


def minimise(
    energy: CellEnergy,
    state: Array,
    *,
    tension: Array | None = None,
    fixed: tuple[int, ...] = (),
    target: Array | None = None,
    options: Options | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Minimum:
    """Minimise the energy from a state, without yarn passing through yarn.

    Parameters
    ----------
    energy : the energy of the cell.
    state : unknowns to begin with.
    tension : (constraints,) tensions to begin with, N.
    fixed : COURSE and/or WALE: cell sizes that are prescribed.
    target : (2,) sizes of a stitch to move the fixed ones to, mm; by default where they are.
    cancel : called before every step; True stops with CancelledError.

    Raises
    ------
    UnravelledError
        If no step can be certified any more.
    CancelledError
        If ``cancel`` says so.
    """
    opts = options or Options()
    held = np.array(sorted(f % energy.cell.unknowns for f in fixed), int)
    goal = state[held] if target is None else target[held - energy.cell.unknowns + 2]
    descent = _Descent(energy, state, tension, held, goal, opts)
    while not descent.converged and descent.steps < opts.iterations:
        if cancel is not None and cancel():
            raise CancelledError("The relaxation was cancelled.")
        if not descent.step():
            break
    return descent.minimum()


class _Descent:
    """State of one minimisation."""

    def __init__(
        self, energy: CellEnergy, state: Array, tension: Array | None,
        held: NDArray[np.int64], goal: Array, options: Options,
    ) -> None:  # fmt: skip
        self.energy = energy
        self.options = options
        self.trajectory = Trajectory(energy, state, options.pair_cap)
        self.tension = np.zeros(energy.constraints) if tension is None else tension.copy()
        self.free = np.ones(energy.cell.unknowns, bool)
        self.free[held] = False
        self.held, self.goal = held, goal
        self.first_damping = _DAMPING * energy.unit / energy.mean_loop_mm**2
        self.damping = self.first_damping
        self.single = energy.cell.unknowns >= _SINGLE_FROM
        self.steps, self.evaluations = 0, 1
        self.converged = self.stable = False

    def step(self) -> bool:
        """One Newton step and the chord steps after it; False where there is none."""
        trajectory, energy = self.trajectory, self.energy
        here = trajectory.here
        slope = trajectory.slope(self.tension, hessian=True)
        remaining = self.goal - here.state[self.held]
        moving = bool(np.abs(remaining).max(initial=0.0) > 1e-12)
        system = _System(slope, energy.penalty, self.free, self.single)
        excess = here.terms.excess_mm
        indefinite = blocked = False
        for _ in range(_TRIALS):
            if not system.factorise(self.damping):
                indefinite = True
                self._damp(4.0, _INDEFINITE_DAMPING)
                continue
            step, change = system.solve(slope, excess, remaining)
            taken = trajectory.certified(step)
            blocked = taken.fraction < _NO_STEP
            if blocked:
                self._damp(4.0)
                continue
            self.evaluations += 2
            moved = taken.to.state - here.state
            predicted = system.decrease(slope, moved, change, excess)
            before = energy.merit(here.terms, self.tension + change)
            actual = before - energy.merit(taken.to.terms, self.tension + change)
            ratio = actual / predicted if predicted > 0.0 else -1.0
            rounding = abs(predicted) < 1e-11 * abs(before)
            if rounding:
                ratio = 1.0
            if moving or ratio > 1e-3:
                break
            self._damp(4.0)
        else:
            if blocked:
                raise UnravelledError("No step from here keeps the strands apart.")
            return False
        damping = self.damping
        if ratio > 0.5 and not indefinite:
            self._damp(1.0 / self.options.relief)
        elif ratio < 0.2 and not moving:
            self._damp(2.0)
        trajectory.advance(taken)
        self.tension = self.tension + change
        self.steps += 1
        if not moving:
            self._take_chord_steps(system, predicted)
        terms = trajectory.here.terms
        # rounding moves the yarn along itself, which lengthens it: further steps bring no gain
        slack = (10.0 if rounding else 1.0) * self.options.slack
        self.converged = bool(
            taken.fraction == 1.0
            and not moving
            and self.damping <= 0.1 * self.first_damping
            and predicted < self.options.tolerance * abs(terms.energy)
            and np.abs(terms.excess_mm).max() < slack * energy.mean_loop_mm
        )
        if self.converged:
            least = _STABLE * self.first_damping
            self.stable = damping <= least or system.factorise(least)
            self.converged = self.stable or not self._leave_saddle(system)
        return True

    def _leave_saddle(self, system: _System) -> bool:
        """Descend along the most negative curvature; False if that does not lower the energy."""
        energy, trajectory = self.energy, self.trajectory
        here = trajectory.here
        self.damping = 2.0 * _STABLE * self.first_damping
        while not system.factorise(self.damping):  # the nearer the shift, the faster the iteration
            self._damp(2.0)
        step = system.softest() * energy.yarn.radius_mm
        before = energy.merit(here.terms, self.tension)
        for _ in range(_NUDGES):
            taken = trajectory.certified(step)
            self.evaluations += 1
            if taken.fraction > _NO_STEP and energy.merit(taken.to.terms, self.tension) < before:
                trajectory.advance(taken)
                return True
            step = 0.25 * step
        return False

    def _take_chord_steps(self, system: _System, gain: float) -> None:
        """Steps with the factor of the last Hessian, as long as they pay off."""
        trajectory, energy = self.trajectory, self.energy
        none = np.zeros(len(self.held))
        for _ in range(self.options.chord_steps):
            here = trajectory.here
            excess = here.terms.excess_mm
            slope = trajectory.slope(self.tension, hessian=False)
            step, change = system.solve(slope, excess, none)
            taken = trajectory.certified(step)
            self.evaluations += 2
            tension = self.tension + change
            actual = energy.merit(here.terms, tension) - energy.merit(taken.to.terms, tension)
            moved = taken.to.state - here.state
            if taken.fraction < _NO_STEP or actual < 0.2 * system.decrease_solved(
                slope, moved, change, excess, taken.fraction
            ):
                return
            trajectory.advance(taken)
            self.tension = tension
            if actual < _WORTH * gain:
                return
            gain = actual

    def _damp(self, factor: float, least: float = 0.0) -> None:
        least = max(least, _LEAST_DAMPING_SINGLE if self.single else _LEAST_DAMPING)
        self.damping = max(factor * self.damping, least * self.first_damping)

    def minimum(self) -> Minimum:
        """The result so far."""
        here = self.trajectory.here
        slope = self.trajectory.slope(self.tension, hessian=False)
        return Minimum(
            state=here.state,
            tension=self.tension,
            terms=here.terms,
            force=slope.gradient[-2:].copy(),
            min_distance_mm=self.trajectory.min_distance_mm,
            converged=self.converged,
            stable=self.stable,
            steps=self.steps,
            evaluations=self.evaluations,
        )


@numba.njit(cache=True)
def _scaled(matrix: Array, scale: Array, damping: float) -> NDArray[np.float32]:
    """Lower triangle, damped and scaled, in single precision; entries above it are arbitrary."""
    n = matrix.shape[0]
    out = np.empty((n, n), np.float32)
    for i in range(n):
        for j in range(i + 1):
            out[i, j] = matrix[i, j] * scale[i] * scale[j]
        out[i, i] += damping * scale[i] * scale[i]
    return out


class _System:
    """The linear system of a step: damped Hessian and lengths of the courses."""

    def __init__(self, slope: Slope, penalty: float, free: NDArray[np.bool_], single: bool) -> None:
        self._single = single
        self._penalty = penalty
        self._free = free
        self._held = np.flatnonzero(~free)
        assert slope.hessian is not None  # noqa: S101 - a system is made of both derivatives
        with one_blas_thread():
            # the Hessian of the penalty, added in place (the matrix is symmetric)
            self._hessian = blas.dgemm(
                penalty, slope.lengths, slope.lengths, beta=1.0, c=slope.hessian.T,
                trans_a=True, overwrite_c=True,
            )  # fmt: skip

    def factorise(self, damping: float) -> bool:
        """Cholesky factor of the damped matrix; False where it is not positive definite."""
        self._damping = damping
        matrix = self._hessian.T
        if len(self._held):
            matrix = matrix[np.ix_(self._free, self._free)]
        with one_blas_thread():
            if self._single:
                self._scale = 1.0 / np.sqrt(np.abs(np.diagonal(matrix)) + damping)
                lower = _scaled(matrix, self._scale, damping)
                self._factor, info = lapack.spotrf(lower.T, lower=0, overwrite_a=1, clean=0)
            else:
                damped = matrix.copy()
                damped[np.diag_indices_from(damped)] += damping
                self._factor, info = lapack.dpotrf(damped.T, lower=0, overwrite_a=1, clean=0)
        return int(info) == 0

    def _through_factor(self, right: Array) -> Array:
        """The damped matrix's inverse times the columns given."""
        with one_blas_thread():
            if self._single:
                scaled, _ = lapack.spotrs(self._factor, right * self._scale[:, None], lower=0)
                return np.asarray(scaled * self._scale[:, None])
            found, _ = lapack.dpotrs(self._factor, right, lower=0)
        return np.asarray(found)

    def softest(self) -> Array:
        """Step of greatest component 1 along which the matrix that was factorised is least stiff:
        inverse iteration from a shape without symmetry."""
        v = np.cos(np.arange(np.count_nonzero(self._free)) ** 2.0)[:, None]
        for _ in range(_POWER_STEPS):
            v = self._through_factor(v)
            v /= np.abs(v).max()
        step = np.zeros(len(self._free))
        step[self._free] = v[:, 0]
        return step

    def solve(self, slope: Slope, excess: Array, remaining: Array) -> tuple[Array, Array]:
        """Step to the prescribed lengths, and the change of the tensions."""
        lengths = slope.lengths[:, self._free]
        missing = excess + slope.lengths[:, self._held] @ remaining
        gradient = slope.gradient[self._free] + (self._penalty * excess) @ lengths
        if len(self._held):
            gradient = gradient + self._hessian[np.ix_(self._free, self._held)] @ remaining
        both = self._through_factor(np.column_stack([-gradient, lengths.T]))
        downhill, by_tension = both[:, 0], both[:, 1:]
        schur, missed = lengths @ by_tension, lengths @ downhill + missing
        change = np.asarray(np.linalg.solve(schur, missed), dtype=float)
        step = np.empty(len(self._free))
        step[self._free] = downhill - by_tension @ change
        step[self._held] = remaining
        return step, change

    def decrease(self, slope: Slope, step: Array, change: Array, excess: Array) -> float:
        """Decrease of the merit, with the changed tensions, that the quadratic model predicts."""
        with one_blas_thread():
            bent = self._hessian @ step
        return self._downhill(slope, step, change, excess) - 0.5 * float(step @ bent)

    def decrease_solved(
        self, slope: Slope, step: Array, change: Array, excess: Array, fraction: float
    ) -> float:
        """The same for a fraction of what ``solve`` returned, without a product with the matrix."""
        along = self._downhill(slope, step, change, excess)
        return (1.0 - 0.5 * fraction) * along + 0.5 * self._damping * float(step @ step)

    def _downhill(self, slope: Slope, step: Array, change: Array, excess: Array) -> float:
        by_length = (change + self._penalty * excess) @ (slope.lengths @ step)
        return -float(slope.gradient @ step + by_length)
