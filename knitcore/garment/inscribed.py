"""The largest rectangle of stitches inside an outline, for which effective moduli can be given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def largest_rectangle(stitch: NDArray[np.bool_]) -> tuple[slice, slice]:
    """Rows and columns of the rectangle with the most stitches that lies wholly inside.

    Row by row, each column has a height: the stitches without a gap down from this row. The
    largest rectangle with its top in the row is the largest one under these heights, found with a
    stack of columns whose heights rise. If several are equal, the lowest is taken.

    Parameters
    ----------
    stitch : bool (rows, columns), where there is a stitch; empty slices if there is none.
    """
    most, best = 0, (slice(0, 0), slice(0, 0))
    heights = np.zeros(stitch.shape[1] + 1, dtype=int)  # the last one ends every rectangle
    for row, inside in enumerate(stitch, start=1):
        heights[:-1] = np.where(inside, heights[:-1] + 1, 0)
        rising: list[tuple[int, int]] = []  # first column and height
        for column, height in enumerate(heights.tolist()):
            first = column
            while rising and rising[-1][1] >= height:
                first, tall = rising.pop()
                if tall * (column - first) > most:
                    most = tall * (column - first)
                    best = slice(row - tall, row), slice(first, column)
            rising.append((first, height))
    return best
