"""The first shape of any repeat on splines, with every crossing that its graph asks for."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

from knitcore.base.arrays import Array, Indices
from knitcore.base.errors import ConvergenceError
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.yarn.loops.held_loops import HeldLoops
from knitcore.yarn.loops.loop_crossings import Crossing, Crossings, drawn_crossings
from knitcore.yarn.loops.loop_paths import LoopPaths, YarnPath
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.tiling import centre_lines

_GRIDS = tuple(SplineGrid(controls, 3) for controls in (16, 24, 32, 48, 64))
"""Resolutions on which a shape is drawn: the coarsest that has all crossings."""


@dataclass(frozen=True, eq=False)
class DrawnYarn:
    """A first shape.

    Attributes
    ----------
    cell : the repeat on splines, without symmetry.
    state : its unknowns.
    crossings : how often each part of a loop passes over each other one.
    exact : how many crossings the graph asks for; the others are of loops that only lie one behind
        the other, in that order.
    """

    cell: YarnCell
    state: Array
    crossings: Counter[Crossing]
    exact: int

    @property
    def loop_lengths_mm(self) -> Array:
        """(rows,) length of yarn of each row, mm per site."""
        lines = centre_lines(self.cell, self.state, self.cell.rows, self.cell.wales)
        ahead = lines[:, :1] + (self.cell.wales * self.state[-2], 0.0, 0.0)
        steps = np.diff(np.concatenate([lines, ahead], axis=1), axis=1)
        return np.asarray(np.linalg.norm(steps, axis=2).sum(axis=1) / self.cell.wales)


def drawn_yarn(graph: StitchGraph, wale_mm: float, row_mm: float, layer_mm: float) -> DrawnYarn:
    """Draw the yarn of a repeat with the crossings of its graph (see :class:`DrawableYarn`)."""
    return DrawableYarn(graph)(wale_mm, row_mm, layer_mm)


@dataclass(frozen=True, eq=False)
class DrawableYarn:
    """The yarn of a repeat, to be drawn at any size."""

    graph: StitchGraph

    @cached_property
    def paths(self) -> LoopPaths:
        """The paths of its yarn."""
        return LoopPaths(HeldLoops(self.graph))

    @cached_property
    def _rows(self) -> list[YarnPath]:
        return [self.paths.of_row(row) for row in range(self.graph.rows)]

    @cached_property
    def _needed(self) -> Crossings:
        return Crossings.of(self.graph)

    def __call__(self, wale_mm: float, row_mm: float, layer_mm: float) -> DrawnYarn:
        """Draw it with the crossings of its graph.

        Parameters
        ----------
        wale_mm, row_mm : width of a wale and height of a plain row.
        layer_mm : distance of strands that cross.

        Raises
        ------
        ConvergenceError
            If no resolution shows all crossings.
        """
        graph, needed = self.graph, self._needed
        rows, height = graph.rows, float(self.paths.heights[-1]) * row_mm
        lines = [_Line.of(path, np.array([wale_mm, row_mm, layer_mm])) for path in self._rows]
        for grid, smooth in product(_GRIDS, (False, True)):
            cell = YarnCell(np.zeros(graph.act.shape, bool), False, False, None, grid)
            points = np.stack([line.controls(grid, smooth) for line in lines])
            points[..., 1] -= height / rows * np.arange(rows)[:, None]
            state = cell.state(points, wale_mm, height / rows)
            curves = centre_lines(cell, state, rows, graph.columns)
            parts = np.stack([line.parts(cell.place / graph.columns) for line in lines])
            drawn = drawn_crossings(curves, parts, graph.columns * wale_mm, height)
            wrong = needed.wrong(drawn)
            if not wrong:
                return DrawnYarn(cell, state, drawn, sum(needed.exact.values()))
        row, column, _ = wrong[0].lower
        raise ConvergenceError(
            f"The yarn at row {row + 1}, stitch {column + 1} cannot be drawn as the chart says. "
            "Make its loops lean less far, or put a plain row between."
        )


@dataclass(frozen=True, eq=False)
class _Line:
    """The yarn of a row in mm; the end is repeated a period on.

    ``along`` is the part of the length up to each point, ``part`` which part of a loop each begins.
    """

    points: Array
    along: Array
    part: Indices
    columns: int

    @classmethod
    def of(cls, path: YarnPath, unit_mm: Array) -> _Line:
        ahead = path.points[:1] + np.array([path.columns, 0.0, 0.0])
        points = np.concatenate([path.points, ahead]) * unit_mm
        along = np.cumsum(np.append(0.0, np.linalg.norm(np.diff(points, axis=0), axis=1)))
        return cls(points, along / along[-1], path.part, path.columns)

    def controls(self, grid: SplineGrid, smooth: bool) -> Array:
        """(controls, 3): control points, without the drift along the course.

        The curve passes through evenly spread points, or keeps inside them where it is smooth.
        """
        width = self.points[-1, 0] - self.points[0, 0]
        even = np.arange(self.columns * grid.controls) / (self.columns * grid.controls)
        points = np.stack([np.interp(even, self.along, of) for of in self.points.T], axis=1)
        points[:, 0] -= width * even
        return points if smooth else np.stack([grid.interpolate(of) for of in points.T], axis=1)

    def parts(self, along: Array) -> Indices:
        """The part that begins at, or goes on after, each place along the yarn."""
        return self.part[np.searchsorted(self.along, along, side="right") - 1]
