"""Repeats up to symmetry."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from knitcore.chart.repeats import primitive_repeats, repeats_up_to
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.library.catalogue import placement, placements
from scripts.stored_stitches import COMMON

charts = arrays(bool, st.tuples(st.integers(1, 3), st.integers(1, 4))).map(StitchChart)


@pytest.mark.parametrize("shape", [(1, 8), (8, 1), (2, 4), (4, 2), (2, 3), (3, 3)])
def test_no_fabric_is_missing_or_counted_twice(shape):
    """Burnside: the number of fabrics is the mean number of grids that a symmetry leaves alone."""
    rows, columns = shape
    grids = ((np.arange(2 ** (rows * columns))[:, None] >> np.arange(rows * columns)) & 1) == 1
    charts = [StitchChart(grid) for grid in grids.reshape(-1, rows, columns)]
    alone = sum(
        np.array_equal(chart.purl, turned)
        for chart in charts
        if chart.repeat() == chart
        for _, turned in placements(chart.purl)
    )
    assert len(primitive_repeats(rows, columns)) == alone / (4 * rows * columns)


def test_the_counts_are_those_of_the_composite_study():
    """36 repeats up to 3x3, 53 of at most 8 stitches and four a side."""
    repeats = repeats_up_to(9, 9, stitches=9)
    assert sum(c.rows <= 3 and c.columns <= 3 for c in repeats) == 36
    assert sum(max(c.rows, c.columns) <= 4 and c.purl.size <= 8 for c in repeats) == 53


def test_common_repeats_are_primitive_and_different():
    found = [StitchChart.parse(text) for text in COMMON.values()]
    assert all(chart.repeat() == chart for chart in found)
    assert len({chart.canonical() for chart in found}) == len(found)


@settings(deadline=None, max_examples=40)
@given(charts, st.integers(0, 5), st.integers(0, 5), st.booleans(), st.booleans())
def test_symmetric_charts_have_one_representative(chart, up, right, mirror, swap):
    other = chart.mirror() if mirror else chart
    other = other.swap() if swap else other
    other = StitchChart(np.roll(other.purl, (up, right), axis=(0, 1)))
    assert other.canonical() == chart.canonical()
    assert placement(other, chart.canonical()) is not None
