"""Repeats up to symmetry."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from knitcore.chart import StitchChart
from knitcore.yarnlevel.catalogue import COMMON, canonical, distinct_repeats, place

charts = arrays(bool, st.tuples(st.integers(1, 3), st.integers(1, 4))).map(StitchChart)


def test_there_are_36_fabrics_with_repeats_up_to_three_by_three():
    """Count of the composite study."""
    small = [c for c in distinct_repeats(9) if c.rows <= 3 and c.columns <= 3]
    assert len(small) == 36


def test_common_repeats_are_primitive_and_different():
    found = [StitchChart.parse(text) for text in COMMON.values()]
    assert all(chart.repeat() == chart for chart in found)
    assert len({canonical(chart) for chart in found}) == len(found)


@settings(deadline=None, max_examples=40)
@given(charts, st.integers(0, 5), st.integers(0, 5), st.booleans(), st.booleans())
def test_symmetric_charts_have_one_representative(chart, up, right, mirror, swap):
    other = chart.mirror() if mirror else chart
    other = other.swap() if swap else other
    other = StitchChart(np.roll(other.purl, (up, right), axis=(0, 1)))
    assert canonical(other) == canonical(chart)
    assert place(other, canonical(chart)) is not None
