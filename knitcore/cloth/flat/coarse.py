"""The mesh of a chart that is too large for one of quarter stitches.

It has two cells a side for each block of k x k stitches. A cell has the mean of the laws at its
place, which are even there (:mod:`knitcore.prediction.quarter_laws`): the parts of a chart are told
apart, the stitches of a texture are not.

Nine charts of 120 x 120 stitches, of one texture or with parts, were pulled to 10, 20 and 30 %
along rows and along columns, as they are and in blocks of 2 x 2 and 3 x 3. Forces differed by up to
9 % (an ellipse of seed in stockinette, along columns; 18 % at 80 x 80, where it has few patches),
the waist by up to 2.5 % of the width (2 x 2 rib, along columns), and those of pure fabrics not at
all. The size of the blocks mattered little: 0.1 %.
"""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.chart.fabric import PHASES
from knitcore.cloth.flat.grid import QuarterGrid
from knitcore.materials.law_uncertainty import Z_SCORE

MAX_DIFFERENCE = {"force": 0.09, "waist": 0.025}
"""Largest difference that blocks made: of a force its share, of the waist in strain. It is taken
for a 90 % interval."""
LOG_FORCE_SD = math.log1p(MAX_DIFFERENCE["force"]) / Z_SCORE
WAIST_SD = MAX_DIFFERENCE["waist"] / Z_SCORE
MAX_BLOCKS = 10_000
"""Blocks of a chart by default: more are slower, and not surer."""


def block_side(rows: int, columns: int, most: int = MAX_BLOCKS) -> int:
    """The smallest k with which a chart has at most so many blocks of k x k stitches.

    Examples
    --------
    >>> block_side(100, 100), block_side(400, 400)
    (1, 4)
    """
    side = max(math.isqrt(rows * columns // most), 1)
    while math.ceil(rows / side) * math.ceil(columns / side) > most:
        side += 1
    return side


def coarse_grid(
    quarters: QuarterGrid, mixing: scipy.sparse.csr_array, side: int
) -> tuple[QuarterGrid, scipy.sparse.csr_array]:
    """A grid with cells of ``side`` x ``side`` quarters, and the shares of the laws in its codes.

    Cloth is where at least half of a cell's quarters are, or any if it would fall apart. A cell's
    code is four times its number, plus the phase of most of its quarters.
    """
    rows, columns = (_cuts(count, side) for count in quarters.law_of_cell.shape)
    shape = len(rows) - 1, len(columns) - 1
    row, column = (np.repeat(np.arange(len(cuts) - 1), np.diff(cuts)) for cuts in (rows, columns))
    cell_of_quarter = row[:, None] * shape[1] + column
    size = math.prod(shape)
    cell, codes = cell_of_quarter[quarters.cloth], quarters.law_of_cell[quarters.cloth]
    held = np.bincount(cell, minlength=size)
    cloth = (2 * held >= np.bincount(cell_of_quarter.ravel(), minlength=size)).reshape(shape)
    if scipy.ndimage.label(cloth)[1] != 1:
        cloth = (held > 0).reshape(shape)
    part = scipy.sparse.csr_array((1 / held[cell], (cell, codes)), (size, mixing.shape[0]))
    counts = np.bincount(len(PHASES) * cell + codes % len(PHASES), minlength=len(PHASES) * size)
    phase = counts.reshape(size, -1).argmax(axis=1)
    grid = QuarterGrid(
        quarters.column_lines[columns],
        quarters.row_lines[rows],
        (len(PHASES) * np.arange(size) + phase).reshape(shape),
        cloth,
    )
    alike = np.ones((len(PHASES), 1))  # a code for each phase
    return grid, scipy.sparse.csr_array(scipy.sparse.kron(part @ mixing, alike))


def _cuts(quarters: int, side: int) -> NDArray[np.intp]:
    """Lines of the quarters at which cells begin and end, two cells for every block."""
    cells = 2 * math.ceil(quarters / (2 * side))
    return np.linspace(0, quarters, cells + 1).round().astype(np.intp)
