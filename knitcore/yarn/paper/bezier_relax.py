"""Relax one stitch in the published description.

``data/published_starts.csv`` holds one shape of least energy for each of the paper's eight samples,
divided by its loop length; this solver found them and a test shows that they are stationary.
"""

import csv
import math
import time
from dataclasses import replace
from functools import cache
from importlib.resources import files

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import (
    Cancelled,
    ConvergenceError,
    InputError,
    UnravelledError,
    check_cancelled,
)
from knitcore.chart.fabric import Fabric
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.input_checks import check_loop, check_stitch_size
from knitcore.yarn.model.relaxed_cell import Branch, RelaxedCell, StartReport
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.paper.bezier_shape import unknown_names
from knitcore.yarn.paper.bezier_stitch import Stitch, shown_chart
from knitcore.yarn.paper.certificate import is_clasped
from knitcore.yarn.paper.continuation import Continuation, free_constraints, has_room, is_admissible
from knitcore.yarn.paper.minimise import BezierMinimum, HeldLengths, length_powers, minimise_bezier

STARTS = 4
"""Number of starts; the authors used four."""
_SPREAD = 0.03
"""Relative spread of the random starts."""
_CLEAR = 1.02
"""A start with cores nearer than this (in 2 r_core) is first relaxed with thinner cores."""


def relax_published(
    fabric: Fabric | str,
    yarn: YarnModel,
    loop_length_mm: float,
    cell_course_mm: float | None = None,
    cell_wale_mm: float | None = None,
    convention: Convention | str = Convention.PUBLISHED,
    *,
    starts: int = STARTS,
    cancelled: Cancelled | None = None,
) -> RelaxedCell:
    """Shape of least energy of one stitch of a pure fabric.

    Parameters
    ----------
    fabric : stockinette, garter, rib or seed.
    yarn : its yarn.
    loop_length_mm : length of yarn in the stitch, mm.
    cell_course_mm, cell_wale_mm : sizes of the stitch to hold, mm; None leaves one free of force.
    convention : factors of the energy.
    starts : number of starts; the lowest result is kept.
    cancelled : called before every start; True stops with CancelledError.

    Raises
    ------
    InputError
        If the yarn does not fit into the loop, or a size is out of reach.
    ConvergenceError
        If no start converged, or the yarn locks before it gets to a size asked for.
    UnravelledError
        If the strands of the lowest shape are no longer clasped.
    CancelledError
        If ``cancelled`` says so.
    """
    stitch = Stitch(Fabric.parse(fabric), yarn, Convention.parse(convention))
    check_loop(yarn, loop_length_mm)
    for name, size in (("cell_course_mm", cell_course_mm), ("cell_wale_mm", cell_wale_mm)):
        check_stitch_size(name, size, loop_length_mm)
    if starts < 1:
        raise InputError("starts", f"{starts} is too few.", "Give 1 or more.")
    constraints = free_constraints(loop_length_mm)
    shapes = first_shapes(stitch, loop_length_mm, starts)
    stitch.evaluate(shapes[0])  # compiles; not part of the time
    began = time.process_time()
    minima = []
    for shape in shapes:
        check_cancelled(cancelled)
        minima.append(_settle(stitch, shape, loop_length_mm, constraints))
    best = lowest(stitch, minima)
    evaluations = sum(m.evaluations for m in minima)
    if cell_course_mm is not None or cell_wale_mm is not None:
        path = Continuation(stitch, loop_length_mm)
        held = path.go([best.unknowns], cell_course_mm, cell_wale_mm)
        if held is None:
            raise ConvergenceError(
                "No equilibrium at this size of the stitch: its yarn locks, or its loops jam, on "
                "the way there. Give a size nearer to its natural "
                f"{best.unknowns[-2]:.2f} x {best.unknowns[-1]:.2f} mm."
            )
        best, more = held
        evaluations += more
    seconds = time.process_time() - began
    least = min(m.energy_n_mm for m in minima if m.converged and is_admissible(stitch, m))
    others = sum(
        m.converged and m.energy_n_mm > least * 1.001 and is_admissible(stitch, m) for m in minima
    )
    notes = (f"{others} of {starts} starts ended in a higher minimum.",) if others else ()
    cell = relaxed_cell(stitch, loop_length_mm, best, evaluations, seconds, notes)
    return replace(cell, starts=tuple(_report(stitch, n, m) for n, m in enumerate(minima, start=1)))


@cache
def _packaged() -> dict[Fabric, tuple[Array, ...]]:
    shapes: dict[tuple[Fabric, str], dict[str, float]] = {}
    path = files("knitcore.yarn.model") / "data" / "published_starts.csv"
    with path.open(encoding="utf-8") as stream:
        for row in csv.DictReader(stream):
            key = Fabric(row["fabric"]), row["yarn"]
            shapes.setdefault(key, {})[row["unknown"]] = float(row["value_per_loop_length"])
    return {
        fabric: tuple(
            np.array([values[name] for name in unknown_names(fabric)])
            for (owner, _), values in shapes.items()
            if owner is fabric
        )
        for fabric in Fabric
    }


def first_shapes(stitch: Stitch, loop_length_mm: float, count: int) -> list[Array]:
    """Starts for a minimisation: the packaged shape, then random ones near it.

    Parameters
    ----------
    stitch : whose unknowns are meant.
    loop_length_mm : length of yarn the shapes are scaled to, mm.
    count : how many; the same count gives the same shapes.
    """
    scale = loop_length_mm ** length_powers(stitch)
    packaged = _packaged()[stitch.fabric]
    shapes = [shape * scale for shape in packaged[:count]]
    generator = np.random.default_rng(20240226)
    while len(shapes) < count:
        base = packaged[len(shapes) % len(packaged)]
        noise = 1.0 + _SPREAD * generator.standard_normal(base.size)
        shapes.append(base * noise * scale)
    return shapes


def lowest(stitch: Stitch, minima: list[BezierMinimum]) -> BezierMinimum:
    """The lowest converged and knitted minimum.

    Raises
    ------
    ConvergenceError, UnravelledError
        If there is none.
    """
    converged = [m for m in minima if m.converged]
    if not converged:
        raise ConvergenceError(
            f"None of {len(minima)} starts of {stitch.fabric} converged; give the stitch more yarn "
            "or a size nearer to its natural one."
        )
    clasped = [m for m in converged if m.certified and is_clasped(stitch, m.unknowns)]
    if not clasped:
        raise UnravelledError(f"Every minimum found of {stitch.fabric} has lost its clasps.")
    roomy = [m for m in clasped if has_room(stitch, m)]
    if not roomy:
        raise ConvergenceError(
            f"The {stitch.fabric} is jammed: its yarn is pressed to the core. Give it more yarn, a "
            "smaller core, or a stiffer shell."
        )
    return min(roomy, key=lambda m: m.energy_n_mm)


def relaxed_cell(
    stitch: Stitch,
    loop_length_mm: float,
    minimum: BezierMinimum,
    evaluations: int,
    seconds: float = 0.0,
    notes: tuple[str, ...] = (),
) -> RelaxedCell:
    """A minimum as the result that all branches share."""
    evaluation, unknowns = minimum.evaluation, minimum.unknowns
    energy = evaluation.energy_n_mm
    return RelaxedCell(
        branch=Branch.PUBLISHED,
        convention=stitch.convention,
        chart=shown_chart(stitch.fabric),
        yarn=stitch.yarn,
        loop_lengths_mm=np.array([loop_length_mm]),
        cell_course_mm=float(unknowns[-2]),
        cell_wale_mm=float(unknowns[-1]),
        energy_n_mm=energy,
        bending_share=evaluation.bending_n_mm / energy,
        contact_share=evaluation.contact_n_mm / energy,
        yarn_length_mm=float(evaluation.lengths_mm.sum()),
        seconds=seconds,
        evaluations=evaluations,
        converged=minimum.converged,
        force_n=(float(minimum.force_n[0]), float(minimum.force_n[1])),
        min_distance_mm=evaluation.closest_mm,
        centre_lines=stitch.centre_lines(unknowns),
        state=unknowns.copy(),
        notes=notes,
    )


def _report(stitch: Stitch, number: int, minimum: BezierMinimum) -> StartReport:
    """Outcome of a start."""
    if not minimum.converged:
        outcome = "not converged"
    elif not (minimum.certified and is_clasped(stitch, minimum.unknowns)):
        outcome = "unravelled"
    else:
        outcome = "relaxed" if has_room(stitch, minimum) else "jammed"
    sizes = float(minimum.unknowns[-2]), float(minimum.unknowns[-1])
    energy = minimum.energy_n_mm if math.isfinite(minimum.energy_n_mm) else math.nan
    return StartReport(f"start {number}", outcome, energy, *sizes)


def _settle(
    stitch: Stitch, start: Array, loop_length_mm: float, constraints: HeldLengths
) -> BezierMinimum:
    """Minimise from a start whose yarns may overlap: grow the core, then the rest."""
    certified = is_clasped(stitch, start)
    closest = stitch.evaluate(start).closest_mm
    core = stitch.yarn.core_radius_mm
    if closest < 2.0 * _CLEAR * core:
        room = 0.45 * closest
        for share in (0.0, 0.5, 0.8):
            thinner = replace(stitch.yarn, core_radius_mm=room + share * max(core - room, 0.0))
            grown = minimise_bezier(
                replace(stitch, yarn=thinner),
                start,
                loop_length_mm,
                constraints,
                tolerance=1e-6,
                max_iterations=60,
            )
            certified = certified and grown.certified
            start = grown.unknowns
    settled = minimise_bezier(stitch, start, loop_length_mm, constraints)
    return replace(settled, certified=certified and settled.certified)
