"""Numbers of the corners of a grid: row by row from the lower left."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Cells = TypeVar("Cells", int, NDArray[np.int64])


def corners_of(cell: Cells, columns: int) -> tuple[Cells, Cells, Cells, Cells]:
    """Corners of a cell of a grid (or of many), counter-clockwise from the lower left."""
    first = cell // columns * (columns + 1) + cell % columns
    above = first + columns + 1
    return first, first + 1, above + 1, above


def cell_corners(columns: int, rows: int) -> NDArray[np.int64]:
    """Corners of all cells of a grid, (cells, 4).

    Examples
    --------
    >>> cell_corners(2, 1).tolist()
    [[0, 1, 4, 3], [1, 2, 5, 4]]
    """
    corners = corners_of(np.arange(columns * rows, dtype=np.int64), columns)
    return np.column_stack(corners)
