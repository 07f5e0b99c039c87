"""The yarn of lace, cables, slipped and tucked stitches, as it is knitted: the first shape.

Loops pass through, over and before each other as the chart asks (:mod:`knitcore.yarn.loops`). The
cloth is as wide and high as predicted. Within a repeat, stitches move to where springs are at rest:
those along the course keep rows evenly spread, those along the wale keep a stitch above those that
it takes. So lace waves and ropes draw in, but no force of the yarn is solved for. A stitch moves in
steps of :data:`STEP_MM`, so that equal surroundings have equal shapes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy

from knitcore.base.arrays import Array, Indices
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.draw.lattice import Lattice
from knitcore.draw.stitches import StitchShapes, stitch_shapes, yarn_radius_mm
from knitcore.materials import Material
from knitcore.prediction.predict import predict
from knitcore.yarn.loops.held_loops import HeldLoops
from knitcore.yarn.loops.loop_paths import PARTS, LoopPaths

SOURCE = "loops as the chart knits them, at the predicted size; the yarn is not relaxed"
TOO_LARGE = "knits and purls alone: its repeat has more than {:,} stitches"
LOOP_POINTS = 81
"""Points along the yarn of a stitch, both ends included."""
MAX_LOOPED = 6_400
"""Stitches of the largest repeat whose yarn is drawn so."""
LAYER = 1.2
"""Distance of a layer of yarn from the next, over the yarn's radius."""
YARN_OVER = 0.4
"""Half the width of a yarn over's foot, in wales: nothing draws it together."""
STEP_MM = 0.05
"""Steps in which stitches move from the middles of their cells."""
SMOOTH = 0.28
"""Distance of the control points of the yarn, over the smaller side of a stitch."""
_WALE, _COURSE, _PLACE = 0.5, 0.2, 0.02
"""Springs along the wale, for places across it, along the course, for heights, and to a stitch's
own place, over the others."""
_FARTHEST = 1.0
"""Lean of a loop from which on its pull no longer grows, in wales: stitches keep their order."""
_FLATTEST = 0.4
"""Least rise of a loop that leans, over the height of a row."""


def shapes_of(
    chart: StitchChart | SymbolChart, material: Material, *, folded: bool = True
) -> StitchShapes:
    """The shapes of any chart's stitches: of its knits and purls if its repeat is too large.

    Parameters
    ----------
    folded : as for :func:`~knitcore.draw.stitches.stitch_shapes`, of knits and purls.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    if isinstance(chart, StitchChart):
        return stitch_shapes(chart, material, folded=folded)
    if chart.repeat_cut().cells.size <= MAX_LOOPED:
        return looped_shapes(chart, material)
    shapes = stitch_shapes(chart.plain, material, folded=folded)
    return replace(shapes, source=f"{TOO_LARGE.format(MAX_LOOPED)}; {shapes.source}")


def looped_shapes(chart: SymbolChart, material: Material) -> StitchShapes:
    """The shapes of the stitches of a chart as they are knitted.

    Loops that are knitted together are drawn without their twist.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    repeat = chart.repeat_cut()
    graph = repeat.graph
    together = np.diff(graph.first, axis=1) > 1
    graph = replace(graph, turn=np.where(together, 0, graph.turn).astype(np.int8))
    size = predict(chart, material)
    stitch_mm = np.array([size.relaxed_course_mm, size.relaxed_wale_mm])
    radius = yarn_radius_mm(chart.plain, material)
    lines = loop_lines_mm(graph, stitch_mm, LAYER * radius) / (*stitch_mm, 1.0)
    distinct, number = np.unique(lines.round(4), axis=0, return_inverse=True)
    rows, columns = np.indices((chart.rows, chart.columns))
    index = number.reshape(graph.act.shape)[rows % graph.rows, columns % graph.columns]
    centres = (np.stack([columns, rows], axis=-1) + 0.5) * stitch_mm
    return StitchShapes(
        lines=distinct,
        index=index,
        lattice=Lattice(centres, np.broadcast_to(stitch_mm, centres.shape).copy()),
        yarn_radius_mm=radius,
        source=SOURCE,
    )


def loop_lines_mm(graph: StitchGraph, stitch_mm: Array, layer_mm: float) -> Array:
    """Centre lines (sites, LOOP_POINTS, 3) of a repeat, from the middle of each site's cell."""
    paths = LoopPaths(HeldLoops(graph), YARN_OVER)
    moves = np.round(stitch_moves_mm(graph, stitch_mm) / STEP_MM) * STEP_MM
    reach = int(graph.rows_held().max()) + 3
    lines = []
    for row in range(graph.rows):
        knots, part = paths.knots(row)
        near = list(range(row - 1, row + reach))
        knots[:, 1] = np.interp(knots[:, 1], [paths.height(other) for other in near], near)
        moved = [
            scipy.ndimage.map_coordinates(move, knots[:, 1::-1].T, order=1, mode="grid-wrap")
            for move in np.moveaxis(moves, -1, 0)
        ]
        knots[:, 1] -= row
        points = np.column_stack(
            [knots[:, :2] * stitch_mm + np.transpose(moved), layer_mm * knots[:, 2]]
        )
        sites = _split(
            points,
            part // PARTS,
            float(graph.columns * stitch_mm[0]),
            SMOOTH * float(stitch_mm.min()),
        )
        sites[..., 0] -= stitch_mm[0] * np.arange(graph.columns)[:, None]
        lines.append(sites)
    return np.concatenate(lines)


def _split(points: Array, site: Indices, period_mm: float, spacing_mm: float) -> Array:
    """The smooth line along some points, (sites, LOOP_POINTS, 3).

    It is a uniform cubic B-spline whose control points divide the way of each site evenly: it
    rounds corners, and depends on near points alone.
    """
    period = np.array([period_mm, 0.0, 0.0])
    points = np.concatenate([points, points[:1] + period])
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    first = np.append(np.flatnonzero(np.diff(site, prepend=-1)), -1)
    count = np.ceil(np.diff(along[first]) / spacing_mm)
    begin = np.append(0.0, np.cumsum(count))
    places = np.interp(np.arange(begin[-1]), begin, along[first])
    controls = np.stack([np.interp(places, along, of) for of in points.T], axis=-1)
    around = np.concatenate([controls[-1:] - period, controls, controls[:3] + period])
    at = begin[:-1, None] + count[:, None] * np.linspace(0.0, 1.0, LOOP_POINTS)
    before = np.minimum(at.astype(int), len(controls) - 1)
    t = at - before
    basis = (1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, 1 + 3 * t + 3 * t**2 - 3 * t**3, t**3
    return np.asarray(sum(b[..., None] * around[before + k] for k, b in enumerate(basis)) / 6.0)


def stitch_moves_mm(graph: StitchGraph, stitch_mm: Array) -> Array:
    """How far each stitch lies to the right of its cell's middle and above it, (rows, columns, 2).

    A loop that leans is no longer than an upright one, so that it draws its taker down.
    """
    sites = np.arange(graph.act.size).reshape(graph.act.shape)
    taker = np.repeat(np.arange(graph.act.size), np.diff(graph.first, axis=1).ravel())
    row, column = np.divmod(taker, graph.columns)
    lean = (column - graph.source) * stitch_mm[0]
    taken = sites[row - 1, graph.source % graph.columns]
    beside = np.stack([np.roll(sites, -1, axis=1).ravel(), sites.ravel()])
    wales = np.stack([taker, taken])
    level = np.zeros(sites.size)
    farthest = _FARTHEST * stitch_mm[0]
    pull = np.clip(-lean, -farthest, farthest)
    across = _at_rest(beside, level, 1.0, wales, pull, _WALE)
    leans = across[taker] - across[taken] + lean
    steepest = np.maximum(stitch_mm[1] ** 2 - leans**2, (_FLATTEST * stitch_mm[1]) ** 2)
    up = _at_rest(beside, level, _COURSE, wales, np.sqrt(steepest) - stitch_mm[1], 1.0)
    return np.stack([across, up], axis=-1).reshape(*sites.shape, 2)


def _at_rest(
    beside: Indices, steps: Array, stiffness: float, wales: Indices, rises: Array, other: float
) -> Array:
    """Places (n,) at which springs between pairs of sites, and to 0, are at rest together."""
    count = beside.shape[1]
    first, last = np.concatenate([beside, wales], axis=1)
    weight = np.repeat([stiffness, other], [count, wales.shape[1]])
    goal = weight * np.concatenate([steps, rises])
    pull = np.bincount(first, goal, count) - np.bincount(last, goal, count)
    links = scipy.sparse.csc_matrix((weight, (first, last)), shape=(count, count))
    links = links + links.T
    stays = scipy.sparse.diags(np.asarray(links.sum(axis=1)).ravel() + _PLACE)
    return np.asarray(scipy.sparse.linalg.spsolve(scipy.sparse.csc_matrix(stays - links), pull))
