"""How a chart follows from a stored repeat that is the same fabric."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from knitcore.chart.stitch_chart import StitchChart

Grid = NDArray[np.bool_]


@dataclass(frozen=True)
class Symmetry:
    """How a chart follows from a repeat that is the same up to symmetry.

    ``chart = shift(swap(mirror(repeat)))``: mirrored left to right, K and P swapped (the back of
    the fabric seen through it), then moved up and to the right by whole stitches.
    """

    up: int
    right: int
    mirror: bool
    swap: bool


def placements(grid: Grid) -> Iterator[tuple[Symmetry, Grid]]:
    """All charts of the same size that are the same fabric, with their placements."""
    rows, columns = grid.shape
    for mirror, swap in product((False, True), repeat=2):
        turned = grid[:, ::-1] if mirror else grid
        turned = ~turned if swap else turned
        for up, right in product(range(rows), range(columns)):
            yield Symmetry(up, right, mirror, swap), np.roll(turned, (up, right), axis=(0, 1))


def placement(chart: StitchChart, representative: StitchChart) -> Symmetry | None:
    """How a repeat follows from its representative; None if it does not."""
    wanted = chart.repeat().purl
    if wanted.shape != representative.purl.shape:
        return None
    return next(
        (p for p, grid in placements(representative.purl) if np.array_equal(grid, wanted)), None
    )
