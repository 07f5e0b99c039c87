"""The quarter grid: the mesh of a swatch, one cell per quarter of a stitch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Fabric
from knitcore.chart.phases import as_stitches, quarter_phases
from knitcore.chart.stitch_chart import StitchChart

Indices = NDArray[np.int64]
Cells = TypeVar("Cells", int, Indices)

MAX_CELLS = 1_500_000
"""Largest number of cells of a mesh; the factorised tangent of more would not fit in 8 GB."""


@dataclass(frozen=True, eq=False)
class QuarterGrid:
    """Rows x columns cells between straight grid lines, all or some of them cloth.

    Parameters
    ----------
    column_lines : float array (columns + 1,), mm
        x of the vertical lines, increasing.
    row_lines : float array (rows + 1,), mm
        y of the horizontal lines, increasing.
    law_of_cell : integer array (rows, columns)
        Which law a cell follows; for a chart, its phase code plus four times its place.
    cloth : bool array (rows, columns)
        Which cells hold fabric. The others carry no load, whatever their law.

    Raises
    ------
    InputError
        If sizes are not positive, the mesh would not fit in memory, or the cloth is not in one
        piece.
    """

    column_lines: Array
    row_lines: Array
    law_of_cell: NDArray[np.integer]
    cloth: NDArray[np.bool_]

    def __post_init__(self) -> None:
        rows, columns = self.law_of_cell.shape
        check_cells(rows, columns)
        for name, lines, count in (
            ("width_mm", self.column_lines, columns),
            ("length_mm", self.row_lines, rows),
        ):
            if lines.shape != (count + 1,) or not np.all(np.diff(lines) > 0):
                raise InputError(name, "leaves cells without size.", "Give sizes above 0 mm.")
        check_cloth(self.cloth, rows, columns)

    @classmethod
    def uniform(cls, columns: int, rows: int, width_mm: float, length_mm: float) -> QuarterGrid:
        """Make a grid of cells of one law and one size, centred on the origin."""
        check_cells(rows, columns)
        check_size_mm(width_mm, length_mm)
        return cls.between(
            np.linspace(-width_mm / 2, width_mm / 2, columns + 1),
            np.linspace(-length_mm / 2, length_mm / 2, rows + 1),
            np.zeros((rows, columns), dtype=np.uint8),
        )

    @classmethod
    def between(
        cls, column_lines: Array, row_lines: Array, law_of_cell: NDArray[np.integer]
    ) -> QuarterGrid:
        """Make a grid of cells that all hold fabric."""
        return cls(column_lines, row_lines, law_of_cell, np.ones(law_of_cell.shape, dtype=bool))

    @classmethod
    def of_chart(
        cls,
        chart: StitchChart,
        stitch_size_mm: Mapping[Fabric, tuple[float, float]],
        scale: Array | None = None,
        *,
        stitch: NDArray[np.bool_] | None = None,
        width_mm: float | None = None,
        length_mm: float | None = None,
    ) -> QuarterGrid:
        """The grid of a chart, each phase with its fabric's stitch size (width, height).

        Where fabrics of different gauge meet, a column is as wide and a row as high as its
        quarters are on average, and they are at rest there. ``scale`` (rows, columns, 2) multiplies
        the width and height of each stitch. ``stitch`` (rows, columns) is False where there is no
        stitch. With ``width_mm`` or ``length_mm`` all sizes are scaled so that the fabric measures
        that from edge to edge.
        """
        check_cells(2 * chart.rows, 2 * chart.columns)
        inside = np.ones_like(chart.purl) if stitch is None else as_stitches(stitch, chart)
        check_cloth(inside, chart.rows, chart.columns)
        cloth = inside.repeat(2, axis=0).repeat(2, axis=1)
        phases = quarter_phases(chart, stitch=inside)
        phases[~cloth] = phases[cloth][0]
        sizes = np.full((len(PHASES), 2), np.nan)
        for code in np.unique(phases):
            fabric = PHASES[code]
            if fabric not in stitch_size_mm:
                raise InputError(
                    "material",
                    f"it has no {fabric}, which this chart contains.",
                    "Use a material with this fabric or another chart.",
                )
            check_size_mm(*stitch_size_mm[fabric])
            sizes[code] = stitch_size_mm[fabric]
        factors = np.ones((*chart.purl.shape, 2)) if scale is None else scale
        factors = factors.repeat(2, axis=0).repeat(2, axis=1)
        widths, heights = (
            _means(sizes[phases, axis] / 2 * factors[..., axis], cloth, axis) for axis in (0, 1)
        )
        if width_mm is not None:
            check_size_mm(width_mm, 1.0)
            widths = widths * (width_mm / widths[cloth.any(axis=0)].sum())
        if length_mm is not None:
            check_size_mm(1.0, length_mm)
            heights = heights * (length_mm / heights[cloth.any(axis=1)].sum())
        return cls(_lines(widths), _lines(heights), phases, cloth)

    @property
    def rows(self) -> int:
        """Number of rows of cells."""
        return int(self.law_of_cell.shape[0])

    @property
    def columns(self) -> int:
        """Number of columns of cells."""
        return int(self.law_of_cell.shape[1])

    @property
    def width_mm(self) -> float:
        """Course-wise size."""
        return float(np.ptp(self.corners[self.used_corners, 0]))

    @property
    def length_mm(self) -> float:
        """Wale-wise size."""
        return float(np.ptp(self.corners[self.used_corners, 1]))

    @property
    def area_mm2(self) -> float:
        """Area of the cloth."""
        return float(self.cell_area.sum())

    @cached_property
    def cell_size(self) -> tuple[Array, Array]:
        """Width and height (mm) of each cell at rest, (rows, columns) each."""
        width, height = np.meshgrid(np.diff(self.column_lines), np.diff(self.row_lines))
        return width, height

    @property
    def dofs(self) -> int:
        """Displacement unknowns of corners and centres, constrained ones included."""
        return 2 * ((self.rows + 1) * (self.columns + 1) + self.rows * self.columns)

    @cached_property
    def corners(self) -> Array:
        """Positions (mm) of the cells' corners, row by row from the bottom, (n, 2)."""
        x, y = np.meshgrid(self.column_lines, self.row_lines)
        return np.column_stack([x.ravel(), y.ravel()])

    @cached_property
    def centres(self) -> Array:
        """Positions (mm) of the cells' centres, (rows * columns, 2)."""
        x, y = np.meshgrid(
            (self.column_lines[1:] + self.column_lines[:-1]) / 2,
            (self.row_lines[1:] + self.row_lines[:-1]) / 2,
        )
        return np.column_stack([x.ravel(), y.ravel()])

    @cached_property
    def cell_corners(self) -> Indices:
        """Corner numbers of each cell, counter-clockwise from the lower left, (cells, 4)."""
        cells = np.arange(self.rows * self.columns, dtype=np.int64)
        return np.column_stack(corners_of(cells, self.columns))

    @cached_property
    def used_corners(self) -> NDArray[np.bool_]:
        """Mask (corners,) of the corners that belong to cloth."""
        used = np.zeros(len(self.corners), dtype=bool)
        used[self.cell_corners[self.cloth.ravel()]] = True
        return used

    @cached_property
    def cell_area(self) -> Array:
        """Rest area (mm²) of each cell, (rows, columns); 0 without cloth."""
        width, height = self.cell_size
        return np.where(self.cloth, width * height, 0.0)

    @cached_property
    def corner_area(self) -> Array:
        """Rest area (mm²) of the cells that meet at each corner, (rows + 1, columns + 1)."""
        return sums_at_corners(self.cell_area)

    def edge(self, name: str) -> Indices:
        """Corner numbers of the outermost cloth at ``bottom``, ``top``, ``left`` or ``right``."""
        used = self.used_corners.reshape(self.rows + 1, self.columns + 1)
        numbers = np.arange(used.size).reshape(used.shape)
        axis = 1 if name in ("bottom", "top") else 0
        lines = np.flatnonzero(used.any(axis=axis))
        line = lines[0] if name in ("bottom", "left") else lines[-1]
        along: Indices = numbers.take(line, axis=1 - axis)
        chosen: Indices = along[used.take(line, axis=1 - axis)]
        return chosen


def corners_of(cell: Cells, columns: int) -> tuple[Cells, Cells, Cells, Cells]:
    """Corners of a cell of a grid (or of many), counter-clockwise from the lower left.

    Corners are numbered row by row from the lower left.

    Examples
    --------
    >>> corners_of(1, 2)
    (1, 2, 5, 4)
    """
    first = cell // columns * (columns + 1) + cell % columns
    above = first + columns + 1
    return first, first + 1, above + 1, above


def sums_at_corners(cells: Array) -> Array:
    """Sums (rows + 1, columns + 1) over the up to four cells that meet at each corner."""
    out = np.zeros((cells.shape[0] + 1, cells.shape[1] + 1))
    out[:-1, :-1] += cells
    out[:-1, 1:] += cells
    out[1:, :-1] += cells
    out[1:, 1:] += cells
    return out


def check_cells(rows: int, columns: int) -> None:
    """Refuse a mesh that is empty or would not fit in memory.

    Raises
    ------
    InputError
        Naming the number of cells that would be accepted.
    """
    if rows < 1 or columns < 1:
        raise InputError("size", f"{columns} x {rows} cells make no grid.", "Give at least 1 x 1.")
    if rows * columns > MAX_CELLS:
        raise InputError(
            "size",
            f"{rows * columns} cells would not fit in memory.",
            f"Use at most {MAX_CELLS} cells ({MAX_CELLS // 4} stitches), "
            f"such as {int((MAX_CELLS / 4) ** 0.5)} x {int((MAX_CELLS / 4) ** 0.5)} stitches.",
        )


def check_cloth(cloth: NDArray[np.bool_], rows: int, columns: int) -> None:
    """Refuse fabric that is not in one piece; pieces that touch at a corner are not joined.

    Raises
    ------
    InputError
        Naming the number of pieces.
    """
    if cloth.shape != (rows, columns):
        raise InputError(
            "outline",
            f"it has {'x'.join(map(str, cloth.shape[::-1]))} cells, the chart {columns}x{rows}.",
            "Give one mark for every stitch of the chart.",
        )
    if cloth.all():
        return
    _, pieces = scipy.ndimage.label(cloth)
    if pieces == 0:
        raise InputError("outline", "it holds no stitch.", "Mark at least one stitch.")
    if pieces > 1:
        raise InputError(
            "outline",
            f"the fabric is in {pieces} pieces that are not connected.",
            "Join them by a stitch, or stretch one piece at a time.",
        )


def check_size_mm(width_mm: float, length_mm: float) -> None:
    """Refuse sizes that are not positive numbers.

    Raises
    ------
    InputError
        Naming the side.
    """
    for name, value in (("width_mm", width_mm), ("length_mm", length_mm)):
        check_positive(name, value, "mm", "a size")


def _means(sizes: Array, cloth: NDArray[np.bool_], axis: int) -> Array:
    """Mean size of the cloth in each column or row; of all cloth where one has none."""
    count = cloth.sum(axis=axis)
    sums = np.where(cloth, sizes, 0.0).sum(axis=axis)
    means: Array = np.where(count > 0, sums / np.maximum(count, 1), sizes[cloth].mean())
    return means


def _lines(sizes: Array) -> Array:
    lines = np.concatenate([[0.0], np.cumsum(sizes)])
    return np.asarray(lines - lines[-1] / 2)
