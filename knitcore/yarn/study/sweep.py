"""Stretch a relaxed repeat course-wise or wale-wise, out and back, in any branch.

At every size of the stretched direction the other one is free of force. The force is the partial
derivative of the energy with respect to the size at the minimum, so no energies are differenced.
Each point is computed twice, on the way out and on the way back, and the lower state is kept. The
sweep has jumped where the kept state changes from one way to the other, or where the shape changes
abruptly while the force falls or the change of energy differs from the work done.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from knitcore.base.arrays import Array, sum_in_order
from knitcore.base.errors import (
    Cancelled,
    ConvergenceError,
    InputError,
    UnravelledError,
    check_cancelled,
)
from knitcore.chart.fabric import Direction
from knitcore.yarn.model.input_checks import check_at_rest, check_stretch
from knitcore.yarn.model.relaxed_cell import RelaxedCell, Sweep
from knitcore.yarn.model.slides import slides_at
from knitcore.yarn.paper.stretch import PublishedStretch
from knitcore.yarn.solve.newton import COURSE, WALE, Options, minimise
from knitcore.yarn.solve.search import SAME_ENERGY, check_reached
from knitcore.yarn.solve.splines import MAX_STITCHES_RULED, RelaxedRepeat
from knitcore.yarn.solve.topology import clearance_at

DEFAULT_POINTS = 25
_OFF_WORK = 0.1
"""A change of energy that misses the work done by this part of it may be a jump."""
_LOWER = 1e-6
"""How much lower, relatively, the way back must be to replace the way out."""
STRAIGHT = 0.97
"""A stitch is pulled straight when its size nears this part of its loop length."""
_HALVINGS = 3
_TOLERANCE = 4e-6
"""Tolerance of the energy in cells of more than four stitches: stresses differ from those of 1e-7
by 0.03 % of the largest in the median and 1 % at most (with 1e-6 by 0.01 and 0.6 %), in two thirds
of the time."""
_JUMP = 4.0
"""A step whose shape changes this much more than the steps around it is a jump."""
_JUMP_FLOOR = 0.004
"""The change is also at least this much, root mean square over the stitch, in loop lengths."""


class Stretch(Protocol):
    """Stretching of a branch's states along a direction."""

    @property
    def note(self) -> str:
        """Note on the yarn that is held besides its length; empty if none is."""
        ...

    def reach(self, known: Sequence[RelaxedCell], size_mm: float) -> RelaxedCell:
        """The equilibrium at a size, from the last states on the way to it (none: from rest).

        Raises
        ------
        ConvergenceError, UnravelledError
            If the yarn locks or unravels before it gets there.
        """
        ...


@dataclass(frozen=True, eq=False)
class SplineStretch:
    """How a repeat on splines is stretched; a step that is too long is halved.

    Parameters
    ----------
    zero : the relaxed repeat, with its slide constraints.
    along : the direction.
    cancelled : called before every step of the solver.
    """

    zero: RelaxedRepeat
    along: Direction
    cancelled: Cancelled | None = None

    @classmethod
    def of(
        cls,
        zero: RelaxedRepeat,
        along: Direction,
        slide_quenching: bool,
        cancelled: Cancelled | None,
    ) -> SplineStretch:
        """The stretch of a relaxed repeat, its slides held or not."""
        return cls(with_slides_held(zero) if slide_quenching else zero, along, cancelled)

    @property
    def note(self) -> str:
        """How many slides are held; empty if none is."""
        held = len(self.zero.slides)
        return f"Slide quenching: {held} slides are held." if held else ""

    def reach(self, known: Sequence[RelaxedCell], size_mm: float) -> RelaxedRepeat:
        """The relaxed state with one size prescribed, continued from the last state.

        Raises
        ------
        ConvergenceError, UnravelledError
            If the yarn locks or unravels on the way, in halved steps too.
        CancelledError
            If ``cancelled`` says so.
        """
        last = known[-1] if known else self.zero
        assert isinstance(last, RelaxedRepeat)  # noqa: S101 - the states are this stretch's own
        return self._reach(last, size_mm, _HALVINGS)

    def _reach(self, last: RelaxedRepeat, size_mm: float, halvings: int) -> RelaxedRepeat:
        try:
            return self._held(last, size_mm)
        except (ConvergenceError, UnravelledError):
            if halvings == 0:
                raise
            middle = (last.cell_mm(self.along) + size_mm) / 2.0
            return self._reach(self._reach(last, middle, halvings - 1), size_mm, halvings - 1)

    def _held(self, last: RelaxedRepeat, size_mm: float) -> RelaxedRepeat:
        if size_mm > STRAIGHT * float(last.loop_lengths_mm.max()):
            raise ConvergenceError("the yarn is pulled straight.")
        small = last.cell.stitches <= 4
        minimum = minimise(
            last.energy, last.state, tension=last.tension_n,
            fixed=(COURSE if self.along is Direction.COURSE else WALE,),
            target=np.array([size_mm, size_mm]), cancelled=self.cancelled,
            options=Options(tolerance=1e-8 if small else _TOLERANCE, iterations=80),
        )  # fmt: skip
        check_reached(last.energy, minimum)
        if abs(minimum.state[self.along.axis - 2] - size_mm) > 1e-9:
            raise ConvergenceError("the yarn locks before it gets there.")
        return last.at(last.energy, minimum, seconds=0.0)


def with_slides_held(cell: RelaxedRepeat) -> RelaxedRepeat:
    """Keep the yarn of a state from sliding where it touches.

    Raises
    ------
    InputError
        If the cell is too large.
    """
    if cell.cell.stitches > MAX_STITCHES_RULED:
        raise InputError(
            "slide_quenching",
            f"is not available for a cell of {cell.cell.stitches} stitches.",
            f"Use a repeat of at most {MAX_STITCHES_RULED} stitches.",
        )
    energy = replace(cell.energy, slides=())
    near = clearance_at(energy, cell.state)
    slides = slides_at(
        cell.cell, cell.state, near.pairs, near.distances_mm, near.touch_mm, energy.mean_loop_mm
    )
    tension = np.concatenate([cell.tension_n[: energy.constraints], np.zeros(len(slides))])
    return replace(cell, slides=slides, tension_n=tension)


def sweep(
    zero: RelaxedCell,
    direction: Direction | str,
    max_strain: float,
    *,
    points: int = DEFAULT_POINTS,
    max_stress_n_per_mm: float | None = None,
    back: bool = True,
    slide_quenching: bool | None = None,
    cancelled: Cancelled | None = None,
) -> Sweep:
    """Stretch in one direction, the other free of force.

    Where the yarn locks or unravels, the stretch ends, with a note.

    Parameters
    ----------
    zero : the relaxed repeat, free of force.
    direction : course or wale.
    max_strain : largest strain, above 0.
    points : number of strains, the first of them 0.
    max_stress_n_per_mm : stop the way out beyond this nominal stress.
    back : also go back from the end and keep the lower state of each strain.
    slide_quenching : keep the yarn from sliding where it touches at rest; by default only in the
        published branch, and there as the paper did, for seed along the course.
    cancelled : called before every point; True stops with CancelledError.

    Raises
    ------
    InputError
        If a size of the repeat is held, the strain, the stress or the number of points cannot be
        used, or the cell is too large for slide quenching.
    CancelledError
        If ``cancelled`` says so.
    """
    along = Direction.parse(direction)
    check_stretch(max_strain, points, max_stress_n_per_mm)
    check_at_rest(zero, "zero")
    if isinstance(zero, RelaxedRepeat):
        stretch: Stretch = SplineStretch.of(zero, along, bool(slide_quenching), cancelled)
    else:
        stretch = PublishedStretch.of(zero, along, slide_quenching)
    return follow(
        stretch, zero, along, np.linspace(0.0, max_strain, points),
        max_stress_n_per_mm=max_stress_n_per_mm, back=back, cancelled=cancelled,
    )  # fmt: skip


def follow(
    stretch: Stretch, zero: RelaxedCell, along: Direction, strain: Array, *,
    max_stress_n_per_mm: float | None = None, back: bool = True, cancelled: Cancelled | None = None,
) -> Sweep:  # fmt: skip
    """The sweep of a relaxed state at given strains (see :func:`sweep`)."""
    rest, width = zero.cell_mm(along), zero.cell_mm(along.other)
    notes = [*zero.notes, *filter(None, [stretch.note])]
    best: list[RelaxedCell] = []
    for target in rest * (1.0 + strain):
        check_cancelled(cancelled)
        try:
            best.append(_timed(stretch, best[-2:], float(target)))
        except (ConvergenceError, UnravelledError) as error:
            reached = best[-1].cell_mm(along) / rest - 1.0 if best else 0.0
            notes.append(
                f"Stopped between strain {reached:.3g} and {target / rest - 1.0:.3g}: {error} "
                "Ask for less, or for more points."
            )
            break
        stress = best[-1].force_n[along.axis] / width
        if max_stress_n_per_mm is not None and stress > max_stress_n_per_mm:
            break
    other: set[int] = set()
    for i in range(len(best) - 2, -1, -1) if back else ():
        check_cancelled(cancelled)
        try:
            returned = _timed(stretch, best[i + 1 : i + 2], best[i].cell_mm(along))
        except (ConvergenceError, UnravelledError) as error:
            notes.append(f"The way back stopped at point {i}: {error}")
            break
        ratio = returned.energy_n_mm / best[i].energy_n_mm
        if ratio < 1.0 - SAME_ENERGY:
            other.add(i)
        if ratio < 1.0 - _LOWER:
            best[i] = returned
    if 0 in other:
        notes.append("The way back ends in a state lower than that at rest.")
    # above a run of lower states the two ways agree, so the kept states jump only below it
    jumps = {i for i in other if i > 0 and i - 1 not in other} | _abrupt(best, along)
    if jumps:
        notes.append(f"{len(jumps)} jump(s): the shape changes abruptly, there or on the way back.")
    stress_n_per_mm = np.array([cell.force_n[along.axis] / width for cell in best])
    return Sweep(along, zero, tuple(best), stress_n_per_mm, tuple(sorted(jumps)), tuple(notes))


def _timed(stretch: Stretch, known: Sequence[RelaxedCell], size_mm: float) -> RelaxedCell:
    began = time.process_time()
    reached = stretch.reach(known, size_mm)
    return replace(reached, seconds=time.process_time() - began)


def _abrupt(cells: list[RelaxedCell], along: Direction) -> set[int]:
    """Steps whose shape changes far more than around them, confirmed by force or work.

    Where two states cross in energy the work balances, but the force falls; where a stretch is
    coarse the work is missed, but the shape changes steadily.
    """
    changed = find_jumps(
        [c.centre_lines for c in cells], float(np.mean(cells[0].loop_lengths_mm)) if cells else 0.0
    )
    force = [c.force_n[along.axis] for c in cells]
    falls = {i for i in range(1, len(cells)) if force[i] < force[i - 1]}
    return set(changed) & (falls | _off_work(cells, along))


def _off_work(cells: list[RelaxedCell], along: Direction) -> set[int]:
    jumps = set()
    scale = max((c.energy_n_mm for c in cells), default=0.0)
    for i in range(1, len(cells)):
        before, after = cells[i - 1], cells[i]
        work = sum_in_order(
            0.5
            * (before.force_n[way.axis] + after.force_n[way.axis])
            * (after.cell_mm(way) - before.cell_mm(way))
            for way in (along, along.other)
        )
        missed = abs(after.energy_n_mm - before.energy_n_mm - work)
        if missed > _OFF_WORK * abs(work) and missed > SAME_ENERGY * scale:
            jumps.add(i)
    return jumps


def find_jumps(centre_lines: list[Array], loop_length_mm: float) -> tuple[int, ...]:
    """Steps i, from state i - 1 to i, at which the shape changes far more than at those around.

    The change is the root mean square displacement of the centre lines, less its mean and affine
    part. Fewer than four states have no jumps.

    Parameters
    ----------
    centre_lines : one state after the other, mm, each (courses, points, 3).
    loop_length_mm : mean length of yarn in a stitch.
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


def _change(before: Array, after: Array) -> float:
    a, b = before.reshape(-1, 3), after.reshape(-1, 3)
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    affine = np.linalg.lstsq(a, b, rcond=None)[0]
    return float(np.sqrt(np.mean(np.sum((b - a @ affine) ** 2, axis=1))))
