"""Damped Newton iterations on the energy of a cell, every step certified.

The Hessian is exact and small (48 unknowns a stitch, half of it with a wale axis), so a dense
Cholesky factor costs less than anything iterative up to several hundred stitches' worth of
unknowns. Where the energy is not convex the factor is taken of H + mu D until it exists
(Levenberg-Marquardt); the length of each course is held by an augmented Lagrangian whose tension is
updated at every step once the iteration has settled.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack

from knitcore.errors import CancelledError, UnravelledError
from knitcore.threads import one_blas_thread
from knitcore.yarnlevel.energy import CellEnergy, Terms
from knitcore.yarnlevel.topology import Guard

Array = NDArray[np.float64]

COURSE, WALE = -2, -1
"""Places of the two cell sizes among the unknowns."""


@dataclass(frozen=True)
class Options:
    """How the minimisation goes about it.

    Parameters
    ----------
    pair_cap : longest change of the vector between near samples in one step, in radii.
    skin : how much farther than 2r the list of pairs reaches, in radii.
    relief : by how much a step that went as predicted lessens the damping.
    tolerance : stop when a Newton step would lower the energy by less than this part of it.
    iterations : most Newton steps.
    """

    pair_cap: float = 0.3
    skin: float = 0.8
    relief: float = 6.0
    tolerance: float = 1e-7
    iterations: int = 400


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where a minimisation ended.

    Attributes
    ----------
    state : unknowns.
    tension : (rows,) tension of each course, N.
    terms : parts of the energy.
    force : (2,) dE/d(size of a stitch), N, course-wise and wale-wise, for the whole cell.
    min_distance_mm : smallest distance of centre lines.
    converged : whether the tolerance was reached.
    steps, evaluations : Newton steps taken, energies evaluated.
    """

    state: Array
    tension: Array
    terms: Terms
    force: Array
    min_distance_mm: float
    converged: bool
    steps: int
    evaluations: int


def minimise(  # noqa: PLR0912, PLR0915 - one iteration, told in order
    energy: CellEnergy,
    state: Array,
    *,
    tension: Array | None = None,
    fixed: tuple[int, ...] = (),
    target: Array | None = None,
    options: Options | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Minimum:
    """Lowest energy that is reached from a state without yarn crossing yarn.

    Parameters
    ----------
    energy : the energy of the cell.
    state : unknowns to begin with.
    tension : (rows,) tension to begin with, N.
    fixed : COURSE and/or WALE: cell sizes that are prescribed.
    target : (2,) sizes of a stitch to move the fixed ones to, mm; by default where they are.
    cancel : asked before every step.

    Raises
    ------
    UnravelledError
        If no step can be certified any more.
    CancelledError
        If ``cancel`` says so.
    """
    opts = options or Options()
    cell, yarn = energy.cell, energy.yarn
    touch = 2.0 * yarn.radius_mm
    reach = touch + opts.skin * yarn.radius_mm
    cap = opts.pair_cap * yarn.radius_mm
    size = cell.unknowns
    free = np.ones(size, bool)
    free[list(fixed)] = False
    held = np.flatnonzero(~free)
    goal = state[held] if target is None else target[held - size + 2]
    all_free = bool(free.all())
    natural = 100.0 * energy.unit / energy.mean_loop_mm**2
    damping_floor = 1e-6 * natural
    damping = natural
    pull = np.zeros(cell.rows) if tension is None else tension.copy()

    curve = energy.curve(state)
    evaluations = 1
    converged = False
    steps = 0
    while True:
        pairs, start = energy.pairs(curve, state, reach)
        guard = Guard.at(cell, state, curve, pairs, reach, touch)
        terms = energy.value(state, curve, pairs)
        merit = energy.merit(terms, pull)
        gradient, hessian = energy.derivatives(state, curve, pairs, start, pull)
        evaluations += 1
        if steps >= opts.iterations:
            break
        if cancel is not None and cancel():
            raise CancelledError("The relaxation was cancelled.")
        remaining = goal - state[held]
        moving = bool(np.abs(remaining).max(initial=0.0) > 1e-12)
        accepted = indefinite = False
        for _ in range(60):
            with one_blas_thread():
                step = _step(gradient, hessian, free, all_free, held, remaining, damping)
            if step is None:
                indefinite = True
                damping = max(4.0 * damping, damping_floor)
                continue
            trial = state + step
            if trial[COURSE] <= 0.0 or trial[WALE] <= 0.0:
                damping = max(4.0 * damping, damping_floor)
                continue
            trial_curve = energy.curve(trial)
            scale = guard.longest_step(trial, trial_curve, cap)
            if scale < 1.0:
                step = scale * step
                trial = state + step
                trial_curve = curve + scale * (trial_curve - curve)
            predicted = -float(gradient @ step + 0.5 * step @ hessian @ step)
            trial_terms = energy.value(trial, trial_curve, pairs)
            evaluations += 1
            actual = merit - energy.merit(trial_terms, pull)
            ratio = actual / predicted if predicted > 0.0 else -1.0
            tiny = abs(predicted) < 1e-11 * abs(merit)
            if moving or ratio > 1e-3 or tiny:
                accepted = True
                if ratio > 0.5 and not indefinite:
                    damping = max(damping / opts.relief, damping_floor)
                elif ratio < 0.2 and not moving:
                    damping *= 2.0
                break
            damping = max(4.0 * damping, damping_floor)
        if not accepted:
            break
        if scale < 1e-9:
            raise UnravelledError("No step from here keeps the strands apart.")
        state, curve, terms = trial, trial_curve, trial_terms
        steps += 1
        settled = scale == 1.0 and not moving and predicted < 2e-3 * abs(terms.energy)
        if settled:
            excess = terms.excess_mm
            pull = pull + energy.penalty * excess
            exact = bool(np.abs(excess).max() < 1e-7 * energy.mean_loop_mm)
            if (
                predicted < opts.tolerance * abs(terms.energy)
                and damping <= 1e-1 * natural
                and exact
            ):
                converged = True
                opts = replace(opts, iterations=steps)
    return Minimum(
        state, pull, terms, gradient[-2:].copy(), guard.min_distance_mm, converged, steps,
        evaluations,
    )  # fmt: skip


def _step(
    gradient: Array, hessian: Array, free: NDArray[np.bool_], all_free: bool,
    held: NDArray[np.int64], remaining: Array, damping: float,
) -> Array | None:  # fmt: skip
    """Damped Newton step, None where the damped Hessian is not positive definite."""
    if all_free:
        matrix, slope = hessian.copy(), gradient
    else:
        matrix = hessian[np.ix_(free, free)]
        slope = gradient[free] + hessian[np.ix_(free, held)] @ remaining
    matrix.flat[:: len(matrix) + 1] += damping
    factor, info = lapack.dpotrf(matrix.T, lower=0, overwrite_a=1, clean=0)
    if info != 0:
        return None
    solution, _ = lapack.dpotrs(factor, -slope, lower=0)
    if all_free:
        return np.asarray(solution)
    step = np.empty(len(gradient))
    step[free] = solution
    step[held] = remaining
    return step
