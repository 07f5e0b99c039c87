"""Stretch a relaxed repeat course-wise or wale-wise, there and back.

At every size of the stretched direction the other one is free of force. The force is the partial
derivative of the energy with respect to the size at the minimum, so no energies are differenced.
Each point is met twice, on the way out and on the way back; the lower one is kept. Where
that changes from one way to the other, or where the shape changes abruptly while the force falls or
the energy changes by other than the work done, the sweep has jumped.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from knitcore.errors import ConvergenceError, InputError, UnravelledError
from knitcore.fabric import Direction
from knitcore.yarnlevel.grip import grips_at
from knitcore.yarnlevel.jumps import find_jumps
from knitcore.yarnlevel.relax import (
    Branch,
    RelaxedRepeat,
    relaxed_repeat,
)
from knitcore.yarnlevel.results import MAX_POINTS, Sweep, check_stress_limit
from knitcore.yarnlevel.search import RELAXED, SAME_ENERGY, UNSETTLED, outcome
from knitcore.yarnlevel.solver import COURSE, WALE, Minimum, Options, minimise
from knitcore.yarnlevel.topology import Guard

Cancel = Callable[[], bool]

DEFAULT_POINTS = 25
STRAIGHT = 0.97
"""A stitch is pulled straight when its size nears this part of its loop length."""
_OFF_WORK = 0.1
"""A change of energy that misses the work done by this part of it may be a jump."""
_AT_REST = 1e-2
"""Force times size, as a part of the energy, up to which a state counts as free of force."""


def sweep(
    zero: RelaxedRepeat,
    direction: Direction | str,
    max_strain: float,
    *,
    points: int = DEFAULT_POINTS,
    max_stress_n_per_mm: float | None = None,
    back: bool = True,
    slide_quenching: bool = False,
    cancel: Cancel | None = None,
) -> Sweep:
    """Stretch in one direction, the other free of force.

    Parameters
    ----------
    zero : the relaxed repeat.
    direction : course or wale.
    max_strain : largest strain, above 0.
    points : number of strains, the first of them 0.
    max_stress_n_per_mm : stop the way out beyond this nominal stress.
    back : also go back from the end and keep the lower state of each strain.
    slide_quenching : keep the yarn from sliding where it touches at rest (the paper does so for
        seed along the course); see :mod:`knitcore.yarnlevel.grip`.

    Raises
    ------
    InputError
        If the strain or the number of points cannot be used.
    CancelledError
        If ``cancel`` says so.
    """
    along = Direction.parse(direction)
    if not (np.isfinite(max_strain) and max_strain > 0.0):
        raise InputError("max_strain", f"{max_strain} is no stretch.", "Give a strain above 0.")
    if not 2 <= points <= MAX_POINTS:
        raise InputError("points", f"{points} cannot be used.", f"Give 2 to {MAX_POINTS}.")
    check_stress_limit(max_stress_n_per_mm)
    _check_rest(zero)
    rest, width = zero.cell_mm(along), zero.cell_mm(along.other)
    strain = np.linspace(0.0, max_strain, points)
    notes = list(zero.notes)
    if slide_quenching:
        zero = gripped(zero)
        notes.append(f"Slide quenching: {len(zero.grips)} slides are held.")
    outward: list[RelaxedRepeat] = []
    last = _held(zero, along, rest, cancel)
    for target in rest * (1.0 + strain):
        try:
            last = _walked(last, along, float(target), cancel)
        except (ConvergenceError, UnravelledError) as error:
            reached = last.cell_mm(along) / rest - 1.0
            notes.append(
                f"Stopped between strain {reached:.3g} and {target / rest - 1.0:.3g}: {error} "
                "Ask for less, or for more points."
            )
            break
        outward.append(last)
        stress = last.force_n[along.axis] / width
        if max_stress_n_per_mm is not None and stress > max_stress_n_per_mm:
            break
    best = list(outward)
    lower: set[int] = set()
    if back and len(outward) > 1:
        last = outward[-1]
        for i in range(len(outward) - 2, -1, -1):
            try:
                last = _held(last, along, outward[i].cell_mm(along), cancel)
            except (ConvergenceError, UnravelledError) as error:
                notes.append(f"The way back stopped at point {i}: {error}")
                break
            if last.energy_n_mm < outward[i].energy_n_mm * (1.0 - SAME_ENERGY):
                best[i] = last
                lower.add(i)
    if 0 in lower:
        notes.append("The way back ends in a state lower than that at rest.")
    # the way back leaves the lower states before the first of them
    jumps = {i for i in lower if i > 0 and i - 1 not in lower} | _abrupt(best, along)
    if jumps:
        notes.append(f"{len(jumps)} jump(s): the shape changes abruptly, there or on the way back.")
    stress_n_per_mm = np.array([cell.force_n[along.axis] / width for cell in best])
    return Sweep(along, zero, tuple(best), stress_n_per_mm, tuple(sorted(jumps)), tuple(notes))


def _walked(
    cell: RelaxedRepeat, along: Direction, size_mm: float, cancel: Cancel | None, halvings: int = 3
) -> RelaxedRepeat:
    """As :func:`_held`, in smaller steps where one is too long."""
    try:
        return _held(cell, along, size_mm, cancel)
    except (ConvergenceError, UnravelledError):
        if halvings == 0:
            raise
        middle = (cell.cell_mm(along) + size_mm) / 2.0
        half = _walked(cell, along, middle, cancel, halvings - 1)
        return _walked(half, along, size_mm, cancel, halvings - 1)


def _held(
    cell: RelaxedRepeat, along: Direction, size_mm: float, cancel: Cancel | None
) -> RelaxedRepeat:
    """The relaxed state with one size prescribed, continued from another state."""
    if size_mm > STRAIGHT * float(cell.loop_lengths_mm.max()):
        raise ConvergenceError("the yarn is pulled straight.")
    began = time.process_time()
    target = np.array([size_mm, size_mm])
    options = Options(tolerance=1e-8 if cell.cell.stitches <= 4 else 1e-6, iterations=80)
    found: Minimum = minimise(
        cell.energy, cell.state, tension=cell.tension_n,
        fixed=(COURSE if along is Direction.COURSE else WALE,), target=target,
        options=options, cancel=cancel,
    )  # fmt: skip
    became = outcome(cell.energy, found)
    if became == "unravelled":
        raise UnravelledError("the stitches come undone.")
    if became not in (RELAXED, UNSETTLED, "pulled straight"):
        raise ConvergenceError(f"the yarn locks before it gets there ({became}).")
    if abs(found.state[along.axis - 2] - size_mm) > 1e-9:
        raise ConvergenceError("the yarn locks before it gets there.")
    return relaxed_repeat(
        cell.chart, cell.energy, Branch(cell.branch), found,
        seconds=time.process_time() - began, evaluations=found.evaluations,
    )  # fmt: skip


def _check_rest(zero: RelaxedRepeat) -> None:
    """Refuse a state that is held: strain and stress would not start from rest."""
    sizes = zero.cell_course_mm, zero.cell_wale_mm
    work = max(abs(f) * size for f, size in zip(zero.force_n, sizes, strict=True))
    if work > _AT_REST * zero.energy_n_mm:
        raise InputError(
            "zero",
            f"its size is held by {zero.force_n[0]:.3g} and {zero.force_n[1]:.3g} N.",
            "Relax it without a prescribed size.",
        )


def _abrupt(cells: list[RelaxedRepeat], along: Direction) -> set[int]:
    """Steps whose shape changes far more than around them, and whose force says so too.

    Where two states cross in energy the work balances, but the force falls; where a stretch is
    coarse the work is missed, but the shape changes steadily.
    """
    changed = find_jumps([c.centre_lines for c in cells], float(np.mean(cells[0].loop_lengths_mm)))
    force = [c.force_n[along.axis] for c in cells]
    falls = {i for i in range(1, len(cells)) if force[i] < force[i - 1]}
    return set(changed) & (falls | _off_work(cells, along))


def _off_work(cells: list[RelaxedRepeat], along: Direction) -> set[int]:
    jumps = set()
    scale = max((c.energy_n_mm for c in cells), default=0.0)
    for i in range(1, len(cells)):
        before, after = cells[i - 1], cells[i]
        work = (
            0.5
            * (before.force_n[along.axis] + after.force_n[along.axis])
            * (after.cell_mm(along) - before.cell_mm(along))
        )
        missed = abs(after.energy_n_mm - before.energy_n_mm - work)
        if missed > _OFF_WORK * abs(work) and missed > SAME_ENERGY * scale:
            jumps.add(i)
    return jumps


def gripped(cell: RelaxedRepeat) -> RelaxedRepeat:
    """The same state with its yarn kept from sliding where it touches."""
    energy = replace(cell.energy, grips=())
    curve = energy.curve(cell.state)
    touch = 2.0 * cell.yarn.radius_mm
    pairs, _ = energy.pairs(curve, cell.state, touch)
    guard = Guard(cell.cell, cell.state, curve, pairs, touch, touch)
    distances, _ = guard.changes(cell.state, curve)
    grips = grips_at(cell.cell, cell.state, pairs, distances, touch, energy.mean_loop_mm)
    tension = np.concatenate([cell.tension_n[: energy.constraints], np.zeros(len(grips))])
    return replace(cell, grips=grips, tension_n=tension)


def without_jumps(curve: Sweep) -> Sweep:
    """The sweep up to its first jump."""
    if not curve.jumps:
        return curve
    end = curve.jumps[0]
    return replace(
        curve, cells=curve.cells[:end], stress_n_per_mm=curve.stress_n_per_mm[:end], jumps=()
    )
