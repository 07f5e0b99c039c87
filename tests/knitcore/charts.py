"""Charts changed by a stitch, and random ones for property tests."""

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from knitcore import StitchChart
from knitcore.chart.row_sides import Construction, Side

WAYS_TO_WORK = st.tuples(st.sampled_from(Construction), st.sampled_from(Side))
"""Flat or in the round, and the side of the first row."""


def flipped(chart: StitchChart, row: int | slice, column: int | slice) -> StitchChart:
    """A chart with some stitches worked from the other side."""
    purl = chart.purl.copy()
    purl[row, column] ^= True
    return StitchChart(purl)


def stitch_charts(most: int = 12) -> st.SearchStrategy[StitchChart]:
    """Charts of any pattern up to ``most`` rows and columns."""
    shapes = hnp.array_shapes(min_dims=2, max_dims=2, min_side=1, max_side=most)
    return hnp.arrays(np.bool_, shapes).map(StitchChart)
