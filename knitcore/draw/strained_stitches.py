"""Values of a strip test at the stitches of its chart, which lie on the quarter grid's nodes.

Where a test has blocks of stitches for stitches, its values are those of the blocks.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Mask
from knitcore.chart.result import Result
from knitcore.cloth.flat.strip_results import LockUp, StripTest


@dataclass(frozen=True, eq=False, repr=False)
class StitchStates(Result):
    """The state of every stitch at every step of a test; row 0 is the bottom row.

    Attributes
    ----------
    positions_mm : (steps, rows, columns, 2) centres, float32; where there is no stitch they are
        extrapolated from the nearest one, because a loop at an edge is drawn from the distances to
        all its neighbours.
    strain : (steps, rows, columns, 2) course-wise and wale-wise, 0 where there is no stitch.
    utilisation : (steps, rows, columns) alpha times strain, 1 at the lock-up; 0 where there is no
        stitch.
    """

    positions_mm: NDArray[np.float32]
    strain: Array
    utilisation: Array


def stitch_states(test: StripTest) -> StitchStates:
    """Read positions, strains and utilisation at the centres of the stitches."""
    there = test.sheet.grid.used_corners.reshape(test.x_mm.shape)[1::2, 1::2]
    ux, uy, xx, yy, used = np.zeros((5, test.steps, *there.shape))
    for step in range(test.steps):
        at = test.fields(step)
        for values, nodes in (
            (ux, at.ux_mm),
            (uy, at.uy_mm),
            (xx, at.strain_xx),
            (yy, at.strain_yy),
            (used, at.utilisation),
        ):
            values[step] = nodes[1::2, 1::2]
    x = _carried(test.x_mm[1::2, 1::2], ux, xx, there)
    y = _carried(test.y_mm[1::2, 1::2], uy, yy, there)
    for values in (xx, yy, used):
        values[:, ~there] = 0.0
    positions = np.stack([x, y], axis=-1).astype(np.float32)
    return StitchStates(positions, np.stack([xx, yy], axis=-1), used)


def stitch_at(test: StripTest, spot: LockUp) -> tuple[int, int]:
    """Return row and column, from 0 at the bottom left, of the stitch that a place lies in."""
    grid = test.sheet.quarters
    rows, columns = grid.cloth[::2, ::2].shape
    column = int(np.searchsorted(grid.column_lines[::2], spot.x_mm))
    row = int(np.searchsorted(grid.row_lines[::2], spot.y_mm))
    return min(max(row, 1), rows) - 1, min(max(column, 1), columns) - 1


def spread(states: StitchStates, rows: int, columns: int) -> StitchStates:
    """The states of all stitches, from those of blocks of them."""
    row = np.arange(rows) * states.strain.shape[1] // rows
    column = np.arange(columns) * states.strain.shape[2] // columns
    here = slice(None), row[:, None], column
    positions = _between(_between(states.positions_mm, rows, 1), columns, 2)
    return StitchStates(positions, states.strain[here], states.utilisation[here])


def _between(blocks: NDArray[np.float32], count: int, axis: int) -> NDArray[np.float32]:
    """Values at ``count`` stitches along an axis, linear between the middles of its blocks."""
    last = blocks.shape[axis] - 1
    at = (np.arange(count, dtype=np.float32) + 0.5) * ((last + 1) / count) - 0.5
    below = np.clip(np.floor(at).astype(np.intp), 0, max(last - 1, 0))
    low, high = (blocks.take(np.minimum(below + k, last), axis) for k in (0, 1))
    share = np.expand_dims(at - below, tuple(range(1, blocks.ndim - axis)))
    return np.asarray(low + share * (high - low), dtype=np.float32)


def _carried(rest_mm: Array, moved_mm: Array, strain: Array, there: Mask) -> Array:
    """Positions at each step, extrapolated from the nearest stitch where there is none."""
    row, column = scipy.ndimage.distance_transform_edt(
        ~there, return_distances=False, return_indices=True
    )
    stretched = (rest_mm - rest_mm[row, column]) * (1 + strain[:, row, column])
    return np.asarray(rest_mm[row, column] + moved_mm[:, row, column] + stretched)
