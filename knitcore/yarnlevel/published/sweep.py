"""Stretch one stitch in the published description, step by step and back."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.published.minimise import Constraints, Minimum, minimise
from knitcore.yarnlevel.published.relax import (
    STARTS,
    free_constraints,
    is_knitted,
    relax_published,
    relaxed_cell,
)
from knitcore.yarnlevel.published.slide import SlideQuenching
from knitcore.yarnlevel.published.stitch import Stitch
from knitcore.yarnlevel.results import FloatArray, RelaxedCell, Sweep
from knitcore.yarnlevel.yarn import YarnModel

_STEP = 0.012
"""Longest step of the continuation, in loop lengths (the authors' are .003 to .016)."""
_LOWER = 1e-6
"""How much lower, relatively, the way back must be to replace the way out."""
_JUMP = 6.0
"""A step whose shape changes this much more than the steps around it is a jump."""
_JUMP_FLOOR = 0.004
"""And by at least this much, root mean square over the stitch, in loop lengths."""


def sweep_published(
    fabric: Fabric | str,
    yarn: YarnModel,
    loop_length_mm: float,
    direction: Direction | str,
    max_strain: float,
    points: int = 25,
    convention: Convention = Convention.PUBLISHED,
    *,
    slide_quenching: SlideQuenching | None = None,
    max_stress_n_per_mm: float = math.inf,
    starts: int = STARTS,
    zero: RelaxedCell | None = None,
    progress: Callable[[float], None] | None = None,
) -> Sweep:
    """Stretch a stitch from its force-free state, then back, and keep the lower of both ways.

    Parameters
    ----------
    fabric, yarn, loop_length_mm, convention, starts : as for
        :func:`~knitcore.yarnlevel.published.relax.relax_published`.
    direction : course or wale; the other direction is free of force.
    max_strain : strain of the last point.
    points : number of points, the force-free one included.
    slide_quenching : which stretches of yarn keep their length at rest; by default the paper's
        choice (seed along the course only).
    max_stress_n_per_mm : the stretch ends with the first point beyond this stress.
    zero : the force-free state, if it is known.
    progress : called with the share that is done; may raise to stop.

    Returns
    -------
    A sweep; it is shorter than asked, and says so in its notes, when the yarn locks before
    ``max_strain``.

    Raises
    ------
    InputError, ConvergenceError, UnravelledError
        As :func:`relax_published`.
    """
    kind, along = Fabric.parse(fabric), Direction(direction)
    if not (math.isfinite(max_strain) and max_strain > 0):
        raise InputError("max_strain", f"{max_strain} is no stretch.", "Give a positive strain.")
    if points < 2:
        raise InputError("points", f"{points} make no sweep.", "Give 2 or more.")
    if zero is None:
        zero = relax_published(kind, yarn, loop_length_mm, convention=convention, starts=starts)
    stitch = Stitch(kind, yarn, Convention(convention))
    if slide_quenching is None:
        slide_quenching = SlideQuenching.default(kind, along)
    walk = _Walk.begin(stitch, loop_length_mm, along, zero, slide_quenching)
    sizes = zero.cell_mm(along) * (1.0 + np.linspace(0.0, max_strain, points))
    notes = (
        [] if slide_quenching is SlideQuenching.NONE else [f"Slide quenching: {slide_quenching}."]
    )

    first = _Point(walk.minimise_at(float(sizes[0]), zero.state), 0.0, 0)
    out = [first]
    width = zero.cell_mm(along.other)
    for i, size in enumerate(sizes[1:], start=1):
        point = walk.go(out, float(size))
        if point is None:
            strain = max_strain * (i - 1) / (points - 1)
            notes.append(f"The yarn locks: no equilibrium found beyond a strain of {strain:.3g}.")
            break
        out.append(point)
        if progress is not None:
            progress(i / (2 * points))
        if point.minimum.force_n[along.axis] / width > max_stress_n_per_mm:
            break
    replaced = 0
    for i in range(len(out) - 2, 0, -1):
        back = walk.go([out[i + 1]], float(sizes[i]))
        if back is not None and back.minimum.energy_n_mm < out[i].minimum.energy_n_mm * (
            1 - _LOWER
        ):
            out[i] = replace(out[i], minimum=back.minimum, seconds=out[i].seconds + back.seconds)
            replaced += 1
        if progress is not None:
            progress(1.0 - i / (2 * points))
    if replaced:
        notes.append(f"At {replaced} of {len(out)} points the way back was lower.")
    cells = [relaxed_cell(stitch, p.minimum, p.seconds, p.evaluations) for p in out]
    stress = np.array([p.minimum.force_n[along.axis] for p in out]) / width
    jumps = find_jumps([cell.centre_lines for cell in cells], loop_length_mm)
    return Sweep(along, zero, tuple(cells), stress, jumps, tuple(notes))


def find_jumps(centre_lines: list[FloatArray], loop_length_mm: float) -> tuple[int, ...]:
    """Steps i at which the shape changes far more than at the steps around them.

    The change is that of the centre line (root mean square, its mean and its affine part left out).
    """
    if len(centre_lines) < 4:
        return ()
    changes = np.array(
        [_change(before, after) / loop_length_mm for before, after in pairwise(centre_lines)]
    )
    jumps = []
    for i, change in enumerate(changes):
        around = np.delete(changes[max(i - 4, 0) : i + 5], min(i, 4))
        if change > _JUMP_FLOOR and change > _JUMP * float(np.median(around)):
            jumps.append(i + 1)
    return tuple(jumps)


def stress_from_energies(sweep: Sweep) -> tuple[FloatArray, FloatArray]:
    """Strain and stress (N/mm) between the points, by the paper's midpoint derivative of energy.

    It differs from :attr:`Sweep.stress_n_per_mm` where pairs of points enter or leave the exclusion
    along the yarn (the energy as published steps there), and at jumps.
    """
    strain, energy = sweep.strain, sweep.energy_n_mm
    size, width = sweep.zero.cell_mm(sweep.direction), sweep.zero.cell_mm(sweep.direction.other)
    middle: FloatArray = 0.5 * (strain[1:] + strain[:-1])
    return middle, np.diff(energy) / (np.diff(strain) * size * width)


@dataclass(frozen=True, eq=False)
class _Point:
    minimum: Minimum
    seconds: float
    evaluations: int


@dataclass(frozen=True, eq=False)
class _Walk:
    """Continuation of one stitch along one size of its cell."""

    stitch: Stitch
    loop_length_mm: float
    direction: Direction
    held: FloatArray
    held_mm: FloatArray

    @classmethod
    def begin(
        cls,
        stitch: Stitch,
        loop_length_mm: float,
        direction: Direction,
        zero: RelaxedCell,
        slide_quenching: SlideQuenching,
    ) -> _Walk:
        held = slide_quenching.weights
        held_mm = held @ stitch.evaluate(zero.state).lengths_mm
        return cls(stitch, loop_length_mm, direction, held, held_mm)

    def constraints(self, size_mm: float) -> Constraints:
        course = size_mm if self.direction is Direction.COURSE else None
        wale = size_mm if self.direction is Direction.WALE else None
        free = free_constraints(self.loop_length_mm, course, wale)
        return replace(free, held=self.held, held_mm=self.held_mm)

    def minimise_at(self, size_mm: float, start: FloatArray) -> Minimum:
        start = start.copy()
        start[self.direction.axis - 2] = size_mm
        return minimise(self.stitch, start, self.loop_length_mm, self.constraints(size_mm))

    def go(self, path: list[_Point], size_mm: float) -> _Point | None:
        """From the last point of a path to a size; None if there is no equilibrium on the way."""
        began = time.process_time()
        axis = self.direction.axis - 2
        known = [p.minimum for p in path[-2:]]
        evaluations = 0
        while True:
            here = float(known[-1].unknowns[axis])
            left = size_mm - here
            count = max(1, math.ceil(abs(left) / (_STEP * self.loop_length_mm) - 1e-9))
            step = self._step(known, here + left / count)
            if step is None:
                step = self._step(known[-1:], here + 0.25 * left / count)
            if step is None:
                return None
            known = [known[-1], step]
            evaluations += step.evaluations
            if abs(step.unknowns[axis] - size_mm) < 1e-9:
                return _Point(step, time.process_time() - began, evaluations)

    def _step(self, known: list[Minimum], size_mm: float) -> Minimum | None:
        """One minimisation, started on the line through the last two states."""
        axis = self.direction.axis - 2
        start = known[-1].unknowns
        starts = [start]
        if len(known) == 2:
            before = known[0].unknowns
            if abs(start[axis] - before[axis]) > 1e-9:
                ratio = (size_mm - start[axis]) / (start[axis] - before[axis])
                starts.insert(0, start + np.clip(ratio, -2.0, 2.0) * (start - before))
        for first in starts:
            found = self.minimise_at(size_mm, first)
            if found.converged and is_knitted(self.stitch, found):
                return found
        return None


def _change(before: FloatArray, after: FloatArray) -> float:
    a, b = before.reshape(-1, 3), after.reshape(-1, 3)
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    affine = np.linalg.lstsq(a, b, rcond=None)[0]
    return float(np.sqrt(np.mean(np.sum((b - a @ affine) ** 2, axis=1))))
