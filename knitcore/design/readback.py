"""Read a chart back from its own local moduli, exact or roughly painted.

The local moduli of a stitch depend on how many of its course-wise and of its wale-wise segments
are odd: 0, 1 or 2 of each, nine kinds. At the left edge both course-wise segments are alike, so
the first count determines the first segment, and each further count the next one. So a map that
is exactly some chart's has one chart, up to swapping all knits and purls.

A map may also be only near a chart's own: the segments of every row are those of least deviation
together (dynamic programming along the row), likewise those of every column, in turns. Of the
segments around four stitches an even number must be odd; where it is not, the least certain are
given up: a spanning tree of the most certain segments decides knit or purl.
"""

import numpy as np
import scipy

from knitcore.base.arrays import Array, Mask
from knitcore.chart.phases import ABOVE, BELOW, LEFT, RIGHT, surroundings
from knitcore.chart.stitch_chart import StitchChart
from knitcore.mechanics.local_moduli import StitchTable

EXACT = 0.01
"""Largest deviation (in logarithms) of a map that counts as a chart's own."""
_TURNS = 3


def nearest_chart(target: Array, table: StitchTable) -> StitchChart:
    """A chart whose local moduli are near a map, stitch by stitch.

    Parameters
    ----------
    target : (2, rows, columns) logarithms; NaN where there is no target.
    table : of the material.
    """
    have = table.log_moduli
    cost = np.nansum((target[..., None] - have[:, None, None]) ** 2, axis=0)  # (rows, columns, 16)
    rows, columns = cost.shape[:2]
    by_bit = cost.reshape(rows, columns, 2, 2, 2, 2)  # above, below, right, left
    rowwise = by_bit.transpose(0, 1, 5, 4, 3, 2)  # left, right, below, above
    columnwise = rowwise.transpose(1, 0, 4, 5, 2, 3)  # below, above, left, right
    course = _least(rowwise.min(axis=(4, 5)))
    wale = _least(_given(columnwise, course)).T
    for _ in range(_TURNS):
        course = _least(_given(rowwise, wale.T))
        wale = _least(_given(columnwise, course)).T
    return _integrated(course, wale, cost)


def _given(costs: Array, across: Mask) -> Array:
    """Costs (lines, stitches, before, after), given the segments across the lines.

    ``costs`` is (lines, stitches, before, after, below, above); ``across`` (stitches, lines - 1)
    holds the segments from line to line.
    """
    lines, stitches = costs.shape[:2]
    below, above = (ends.T.astype(int) for ends in _ends(across, lines))  # (lines, stitches)
    line, stitch = np.indices((lines, stitches))
    return costs[line, stitch, :, :, below, above]


def _ends(segments: Mask, stitches: int) -> tuple[Mask, Mask]:
    """Segments before and after each stitch along axis 1; an edge borrows the other side's."""
    if stitches == 1:
        none = np.zeros((len(segments), 1), dtype=bool)
        return none, none
    first, last = segments[:, :1], segments[:, -1:]
    return np.concatenate([first, segments], axis=1), np.concatenate([segments, last], axis=1)


def _least(costs: Array) -> Mask:
    """Segments (lines, stitches - 1) of least total cost, each line for itself.

    ``costs`` is (lines, stitches, before, after).
    """
    lines, stitches = costs.shape[:2]
    if stitches == 1:
        return np.zeros((lines, 0), dtype=bool)
    both = np.arange(2)
    total = costs[:, 0, both, both]  # (lines, segment)
    came = np.zeros((stitches - 1, lines, 2), dtype=np.intp)
    for stitch in range(1, stitches - 1):
        options = total[:, :, None] + costs[:, stitch]
        came[stitch] = options.argmin(axis=1)
        total = options.min(axis=1)
    total = total + costs[:, -1, both, both]
    segments = np.zeros((lines, stitches - 1), dtype=np.intp)
    segments[:, -1] = total.argmin(axis=1)
    for stitch in range(stitches - 2, 0, -1):
        segments[:, stitch - 1] = came[stitch, np.arange(lines), segments[:, stitch]]
    return segments.astype(bool)


def _integrated(course: Mask, wale: Mask, cost: Array) -> StitchChart:
    """The chart that has the most certain of the segments."""
    rows, columns = cost.shape[:2]
    left, right = _ends(course, columns)
    below, above = (ends.T for ends in _ends(wale.T, rows))
    code = left * LEFT | right * RIGHT | below * BELOW | above * ABOVE
    here = np.take_along_axis(cost, code[..., None], axis=2)[..., 0]

    def dearer(bit: int) -> Array:
        there = np.take_along_axis(cost, (code ^ bit)[..., None], axis=2)[..., 0]
        return there - here

    node = np.arange(rows * columns).reshape(rows, columns)
    edges = [
        (node[:, :-1], node[:, 1:], course, dearer(RIGHT)[:, :-1] + dearer(LEFT)[:, 1:]),
        (node[:-1], node[1:], wale, dearer(ABOVE)[:-1] + dearer(BELOW)[1:]),
    ]
    start, end, odd, certain = (np.concatenate([e[k].ravel() for e in edges]) for k in range(4))
    weight = 1 / (1e-3 + np.maximum(certain, 0))
    tree = scipy.sparse.csgraph.minimum_spanning_tree(
        scipy.sparse.coo_array((weight, (start, end)), shape=(node.size,) * 2)
    )
    order, before = scipy.sparse.csgraph.breadth_first_order(tree, 0, directed=False)
    parity = {(int(a), int(b)): bool(o) for a, b, o in zip(start, end, odd, strict=True)}
    purl = np.zeros(node.size, dtype=bool)
    for stitch in order[1:].tolist():
        last = int(before[stitch])
        purl[stitch] = purl[last] ^ parity[min(last, stitch), max(last, stitch)]
    return StitchChart(purl.reshape(rows, columns))


def deviation(chart: StitchChart, target: Array, table: StitchTable) -> Array:
    """(2, rows, columns) logarithms of a chart's local moduli over the targets."""
    return table.log_moduli[:, surroundings(chart)] - target
