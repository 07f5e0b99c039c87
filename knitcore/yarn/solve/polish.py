"""Descent of a whole sheet: limited-memory BFGS steps, preconditioned by the factors of windows.

The Hessian of a sheet of thousands of stitches is never made. Its windows' are, once for a descent;
their factors together are the first guess of its inverse, to which the stiffness of the two sizes
of a stitch is added. Steps of windows keep the lengths of yarn, so the descent does too, except for
yarn that passes from window to window; the next descent has its windows elsewhere.

A descent begins with the two sizes alone, while the windows follow them to first order: the sheet
shrinks evenly, so that no jammed pair of strands anywhere cuts these steps short, as it does the
others in a large sheet.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, check_cancelled
from knitcore.base.threads import on_halves
from knitcore.linear.dense import dot, product, solved, times
from knitcore.linear.elimination_order import dissected
from knitcore.yarn.kernels.structures import Ints
from knitcore.yarn.model.energy import CellEnergy, Slope
from knitcore.yarn.solve.fronts import Room, elimination
from knitcore.yarn.solve.newton import Minimum
from knitcore.yarn.solve.systems import SparseSystem
from knitcore.yarn.solve.topology import Trajectory
from knitcore.yarn.solve.windows import Window, each, window_energy

PAIR_CAP = 0.3
"""Longest change of the vector between near samples in a step of a sheet, in radii."""
_DAMPING = 0.1
"""Least damping of a window's Hessian, in B / L³."""
_INDEFINITE_DAMPING = 5.0
"""Least damping that is tried where that is not enough."""
_GROWTH = 3.0
_LONGEST = 0.5
"""Longest step of a window, in radii: its Hessian is damped until its Newton step is shorter."""
_ANSWER = 8.0
"""Farthest that a window's control point may move where a size of the stitch changes by one."""
_MEMORY = 12
"""Steps whose change of gradient is remembered."""
_ENOUGH = 1e-4
"""Part of the predicted decrease that a step has to bring."""
_SHORTER = 0.3
_TRIALS = 8
_SIZE_STEPS = 8
_LARGEST_STRAIN, _LEAST_STRAIN = 0.03, 2e-3
"""Largest strain of a step of the sizes, and least after which another one follows."""
_PROBE_MM = 1e-6
"""Change of a size for the stiffness of the sheet."""
_LEAST_STIFFNESS = 1e-3
"""Least eigenvalue of that stiffness, relative to the largest."""


@dataclass(frozen=True, eq=False)
class _Part:
    """A window's share of the inverse: its factor, and where its unknowns are in the sheet's.

    ``answers`` (2, unknowns) are how they follow either size of a stitch.
    """

    system: SparseSystem
    answers: Array
    lengths: Array
    unknowns: Ints
    rows: Ints
    share: float


class _Inverse:
    """The guess of the sheet's inverse Hessian."""

    def __init__(
        self, sheet: CellEnergy, state: Array, tension: Array, windows: list[Window], flat: bool
    ) -> None:
        self._sheet = sheet

        def made(some: Sequence[Window]) -> list[_Part]:
            room = Room()
            return [_part(sheet, state, tension, window, flat, room) for window in some]

        self._parts = list(chain.from_iterable(on_halves(made, windows, 2)))
        self._sizes = np.array([self._with_size(k, len(state)) for k in range(2)])
        here = _gradient(sheet, state, tension)
        slopes = [
            (_gradient(sheet, state + _PROBE_MM * move, tension) - here) / _PROBE_MM
            for move in self._sizes
        ]
        stiffness = product(np.array(slopes), self._sizes.T)
        self._stiffness = _definite(0.5 * (stiffness + stiffness.T))

    def times(self, gradient: Array, excess: Array) -> Array:
        """The inverse times a gradient (unknowns,), less a step that mends the lengths."""
        step, _ = self.relaxed(gradient, excess)
        return self.resized(gradient) - step

    def resized(self, gradient: Array) -> Array:
        """The inverse times a gradient, among changes of the two sizes that the windows follow."""
        by_size = solved(self._stiffness, times(self._sizes, gradient))
        return times(self._sizes.T, by_size)

    def relaxed(self, gradient: Array, excess: Array) -> tuple[Array, Array]:
        """Newton steps of all windows at once, and the mean change of the tensions (rows,), N."""
        step = np.zeros(len(gradient))

        def solved(parts: Sequence[_Part]) -> Array:
            change = np.zeros(len(excess))
            for part in parts:
                slope = Slope(np.append(gradient[part.unknowns], (0.0, 0.0)), part.lengths)
                missing = np.zeros(len(part.lengths))
                missing[: len(part.rows)] = part.share * excess[part.rows]
                moved, pull = part.system.solve(slope, missing, np.zeros(2))
                step[part.unknowns] = moved[:-2]  # no other part has them
                change[part.rows] += part.share * pull[: len(part.rows)]
            return change

        return step, np.sum(on_halves(solved, self._parts, 2), axis=0)

    def _with_size(self, size: int, unknowns: int) -> Array:
        """How the windows answer to a change of one size of a stitch, and that change."""
        out = np.zeros(unknowns)
        out[size - 2] = 1.0
        for part in self._parts:
            out[part.unknowns] = part.answers[size]
        return out


def polished(
    sheet: CellEnergy, path: Trajectory, tension: Array, windows: list[Window], *, flat: bool,
    steps: int, cancelled: Cancelled | None = None,
) -> Minimum:  # fmt: skip
    """Lower the energy of a whole sheet, its two sizes included, along certified steps.

    Parameters
    ----------
    sheet : energy of a plain periodic cell whose own ``flat`` is False.
    path : where to begin; it moves.
    tension : (rows,) of the courses, N.
    windows : cover the sheet without overlap.
    flat : keep the middle of every stitch where it is.
    steps : most steps.
    """
    inverse = _Inverse(sheet, path.here.state, tension, windows, flat)
    slope = path.slope(tension, hessian=False, lengths=False)
    tension = tension + inverse.relaxed(slope.gradient, path.here.terms.excess_mm)[1]
    slope = _resized(sheet, path, inverse, tension)
    past: deque[tuple[Array, Array]] = deque(maxlen=_MEMORY)
    taken = 0
    while taken < steps:
        check_cancelled(cancelled)
        terms, gradient = path.here.terms, slope.gradient
        step = -_two_loops(inverse, past, gradient, terms.excess_mm)
        before = sheet.merit(terms, tension)
        pull = sheet.pulled(path.here.curve, sheet.penalty * terms.excess_mm)
        downhill = min(dot(gradient + pull, step), 0.0)
        share = 1.0
        for _ in range(_TRIALS):
            trial = path.certified(share * step)
            share *= trial.fraction
            if sheet.merit(trial.to.terms, tension) < before + _ENOUGH * share * downhill:
                break
            share *= _SHORTER
        else:
            if not past:
                break
            past.clear()  # what was learned of the curvature holds no more
            continue
        moved = trial.to.state - path.here.state
        path.advance(trial)
        slope = path.slope(tension, hessian=False, lengths=False)
        if dot(moved, slope.gradient - gradient) > 0.0:
            past.append((moved, slope.gradient - gradient))
        taken += 1
    here = path.here
    return Minimum(
        state=here.state, tension=tension, terms=here.terms, force=slope.gradient[-2:].copy(),
        min_distance_mm=path.min_distance_mm, converged=False, stable=False, steps=taken,
        evaluations=taken,
    )  # fmt: skip


def _resized(sheet: CellEnergy, path: Trajectory, inverse: _Inverse, tension: Array) -> Slope:
    """Let the sizes go where they want to, as far as that pays; the slope there."""
    for _ in range(_SIZE_STEPS):
        slope, here = path.slope(tension, hessian=False, lengths=False), path.here
        step = -inverse.resized(slope.gradient)
        strain = float(np.abs(step[-2:] / here.state[-2:]).max())
        trial = path.certified(_LARGEST_STRAIN / max(strain, _LARGEST_STRAIN) * step)
        if sheet.merit(trial.to.terms, tension) >= sheet.merit(here.terms, tension):
            return slope
        path.advance(trial)
        if trial.fraction * strain < _LEAST_STRAIN:
            break
    return path.slope(tension, hessian=False, lengths=False)


def _part(
    sheet: CellEnergy, state: Array, tension: Array, window: Window, flat: bool, room: Room
) -> _Part:
    rows, wales = window
    none = np.zeros(sheet.cell.rows)
    controls = sheet.cell.controls(state)
    energy, here = window_energy(sheet, controls, state[-2:], window, none, flat=flat)
    curve = energy.curve(here)
    pairs, start = energy.pairs(curve, here, 2.0 * sheet.yarn.radius_mm)
    pulls = np.concatenate([tension[rows.own], np.zeros(len(energy.held))])
    slope = energy.derivatives(here, curve, pairs, start, pulls, sparse=True)
    assert slope.sparse is not None  # noqa: S101 - asked for
    touching = slope.sparse.touching
    free = np.arange(len(here)) < len(here) - 2
    fronts = elimination(touching, dissected(touching))
    system = SparseSystem(slope, energy.penalty, free, fronts, room, np.float32)
    unit = sheet.unit / sheet.mean_loop_mm**2
    damping, longest = _DAMPING, _LONGEST * sheet.yarn.radius_mm
    while True:
        answers = _answers(system, slope, longest) if system.factorise(damping * unit) else None
        if answers is not None:
            break
        damping = max(_GROWTH * damping, _INDEFINITE_DAMPING)
    system.keep()  # the factors of all windows are there at a time
    places = np.arange(controls.size).reshape(controls.shape)
    places = places[np.ix_(rows.stitches, each(wales.stitches, sheet.cell.grid.controls))]
    unknowns = places[energy.cell.free].ravel()
    share = len(wales.own) / sheet.cell.wales
    return _Part(system, answers[:, :-2], slope.lengths, unknowns, rows.own, share)


def _answers(system: SparseSystem, slope: Slope, longest_mm: float) -> Array | None:
    """How a window's unknowns follow either size; None if that, or its Newton step, moves a point
    too far."""
    none = np.zeros(len(slope.lengths))
    still = Slope(np.zeros(len(slope.gradient)), slope.lengths)
    if not np.abs(system.solve(slope, none, np.zeros(2))[0]).max() < longest_mm:
        return None
    answers = np.array([system.solve(still, none, size)[0] for size in np.eye(2)])
    return answers if np.abs(answers).max() < _ANSWER else None


def _definite(matrix: Array) -> Array:
    """A symmetric matrix (2, 2) with the moduli of its eigenvalues, kept away from zero."""
    mean, half = 0.5 * (matrix[0, 0] + matrix[1, 1]), 0.5 * (matrix[0, 0] - matrix[1, 1])
    apart = max(np.sqrt(half**2 + matrix[0, 1] ** 2), 1e-300)
    values = np.abs([mean - apart, mean + apart])
    values = np.maximum(values, _LEAST_STIFFNESS * values.max())
    upper = (matrix - (mean - apart) * np.eye(2)) / (2.0 * apart)  # projects on the greater one's
    return np.asarray(values[0] * np.eye(2) + (values[1] - values[0]) * upper)


def _gradient(sheet: CellEnergy, state: Array, tension: Array) -> Array:
    """Gradient of the Lagrangian at any state."""
    curve = sheet.curve(state)
    pairs, start = sheet.pairs(curve, state, 2.0 * sheet.yarn.radius_mm)
    slope = sheet.derivatives(
        state, curve, pairs, start, tension, hessian=False, lengths=False
    )  # fmt: skip
    return slope.gradient


def _two_loops(
    inverse: _Inverse, past: deque[tuple[Array, Array]], gradient: Array, excess: Array
) -> Array:
    """The inverse times a gradient, with what the last steps tell of it (Nocedal 1980)."""
    direction = gradient.copy()
    weights = []
    for moved, turned in reversed(past):
        weights.append(dot(moved, direction) / dot(moved, turned))
        direction -= weights[-1] * turned
    direction = inverse.times(direction, excess)
    for (moved, turned), weight in zip(past, reversed(weights), strict=True):
        direction += moved * (weight - dot(turned, direction) / dot(moved, turned))
    return direction
