"""Stretch one stitch in the published description, step by step and back."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.jumps import find_jumps
from knitcore.yarnlevel.published.minimise import Minimum
from knitcore.yarnlevel.published.relax import (
    STARTS,
    check_cancelled,
    relax_published,
    relaxed_cell,
)
from knitcore.yarnlevel.published.slide import SlideQuenching
from knitcore.yarnlevel.published.stitch import Stitch
from knitcore.yarnlevel.published.walk import Walk
from knitcore.yarnlevel.results import (
    MAX_POINTS,
    FloatArray,
    RelaxedCell,
    Sweep,
    check_stress_limit,
)
from knitcore.yarnlevel.yarn import YarnModel

_LOWER = 1e-6
"""How much lower, relatively, the way back must be to replace the way out."""


def sweep_published(
    fabric: Fabric | str,
    yarn: YarnModel,
    loop_length_mm: float,
    direction: Direction | str,
    max_strain: float,
    points: int = 25,
    convention: Convention | str = Convention.PUBLISHED,
    *,
    slide_quenching: SlideQuenching | None = None,
    max_stress_n_per_mm: float | None = None,
    starts: int = STARTS,
    zero: RelaxedCell | None = None,
    cancel: Callable[[], bool] | None = None,
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
    max_stress_n_per_mm : the stretch ends with the first point beyond this stress, if given.
    zero : the force-free state, if it is known.
    cancel : asked before every point; True stops with CancelledError.

    Returns
    -------
    A sweep; it is shorter than asked, and says so in its notes, when the yarn locks before
    ``max_strain``.

    Raises
    ------
    InputError, ConvergenceError, UnravelledError
        As :func:`relax_published`.
    CancelledError
        If ``cancel`` says so.
    """
    kind, along = Fabric.parse(fabric), Direction.parse(direction)
    if not (math.isfinite(max_strain) and max_strain > 0):
        raise InputError("max_strain", f"{max_strain} is no stretch.", "Give a positive strain.")
    if not 2 <= points <= MAX_POINTS:
        raise InputError("points", f"{points} make no sweep.", f"Give 2 to {MAX_POINTS}.")
    check_stress_limit(max_stress_n_per_mm)
    if zero is None:
        zero = relax_published(
            kind, yarn, loop_length_mm, convention=convention, starts=starts, cancel=cancel
        )
    stitch = Stitch(kind, yarn, Convention.parse(convention))
    if slide_quenching is None:
        slide_quenching = SlideQuenching.default(kind, along)
    held = slide_quenching.weights
    walk = Walk(stitch, loop_length_mm, held, held @ stitch.evaluate(zero.state).lengths_mm)
    sizes = zero.cell_mm(along) * (1.0 + np.linspace(0.0, max_strain, points))
    notes = (
        [] if slide_quenching is SlideQuenching.NONE else [f"Slide quenching: {slide_quenching}."]
    )

    out = [_Point(walk.minimise_at(*_held(along, float(sizes[0])), zero.state), 0.0, 0)]
    width = zero.cell_mm(along.other)
    limit = math.inf if max_stress_n_per_mm is None else max_stress_n_per_mm
    for i, size in enumerate(sizes[1:], start=1):
        check_cancelled(cancel)
        point = _go(walk, along, out, float(size))
        if point is None:
            strain = max_strain * (i - 1) / (points - 1)
            notes.append(f"The yarn locks: no equilibrium found beyond a strain of {strain:.3g}.")
            break
        out.append(point)
        if point.minimum.force_n[along.axis] / width > limit:
            break
    replaced = 0
    for i in range(len(out) - 2, 0, -1):
        check_cancelled(cancel)
        back = _go(walk, along, out[i + 1 : i + 2], float(sizes[i]))
        if back is not None and back.minimum.energy_n_mm < out[i].minimum.energy_n_mm * (
            1 - _LOWER
        ):
            out[i] = replace(out[i], minimum=back.minimum, seconds=out[i].seconds + back.seconds)
            replaced += 1
    if replaced:
        notes.append(f"At {replaced} of {len(out)} points the way back was lower.")
    cells = [relaxed_cell(stitch, p.minimum, p.seconds, p.evaluations) for p in out]
    stress = np.array([p.minimum.force_n[along.axis] for p in out]) / width
    jumps = find_jumps([stitch.centre_line(cell.state)[None] for cell in cells], loop_length_mm)
    return Sweep(along, zero, tuple(cells), stress, jumps, tuple(notes))


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


def _held(direction: Direction, size_mm: float) -> tuple[float | None, float | None]:
    return (size_mm, None) if direction is Direction.COURSE else (None, size_mm)


def _go(walk: Walk, direction: Direction, path: list[_Point], size_mm: float) -> _Point | None:
    began = time.process_time()
    found = walk.go([p.minimum for p in path[-2:]], *_held(direction, size_mm))
    if found is None:
        return None
    return _Point(found[0], time.process_time() - began, found[1])
