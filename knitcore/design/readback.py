"""Read a chart back from its own local moduli.

The local moduli of a stitch depend on how many of its course-wise and of its wale-wise segments
are odd: 0, 1 or 2 of each, nine kinds. At the left edge both course-wise segments are alike, so
the first count tells the first segment, and each further count tells the next one: along a row
h_c = n_c - h_(c-1), along a column likewise. So a map that is exactly some chart's has one chart,
up to swapping all knits and purls.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.mechanics.local import StitchTable
from knitcore.phases import ABOVE, BELOW, LEFT, RIGHT, surroundings

Array = NDArray[np.float64]

EXACT = 0.01
"""Largest deviation (in logarithms) of a map that counts as a chart's own."""


def chart_of_local_moduli(wanted: Array, table: StitchTable) -> StitchChart | None:
    """The chart whose local moduli these are; None if there is none.

    Parameters
    ----------
    wanted : (2, rows, columns) logarithms of the moduli, course-wise and wale-wise.
    table : of the material.
    """
    if np.isnan(wanted).any():
        return None
    have = np.log(np.stack([table.modulus_n_per_mm(d) for d in Direction]))  # (2, 16)
    code = ((wanted[..., None] - have[:, None, None]) ** 2).sum(axis=0).argmin(axis=-1)
    across = _segments(((code & LEFT) > 0).astype(int) + ((code & RIGHT) > 0))
    up = _segments((((code & BELOW) > 0).astype(int) + ((code & ABOVE) > 0)).T)
    if across is None or up is None:
        return None
    first = np.concatenate([[False], np.logical_xor.accumulate(up[0])])[:, None]
    steps = np.logical_xor.accumulate(across, axis=1)
    chart = StitchChart(first ^ np.concatenate([np.zeros_like(first), steps], axis=1))
    off = np.abs(have[:, surroundings(chart)] - wanted).max()
    return chart if off <= EXACT else None


def _segments(odd: NDArray[np.int_]) -> NDArray[np.bool_] | None:
    """Segments between neighbours along axis 1 from each stitch's number of odd ones."""
    count = odd.shape[1]
    segments = np.zeros((odd.shape[0], max(count - 1, 0)), dtype=int)
    if count > 1:
        segments[:, 0] = odd[:, 0] // 2
    for column in range(1, count - 1):
        segments[:, column] = odd[:, column] - segments[:, column - 1]
    return segments.astype(bool) if np.isin(segments, (0, 1)).all() else None
