"""Images of a fabric: their number, and the shape to which they relax."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from knitcore.chart.repeats import primitive_repeats, repeats_up_to
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.solve.images import placement, placements, turned
from knitcore.yarn.study.relax import relax
from scripts.stored_stitches import COMMON
from tests.knitcore.yarn.relaxed import relaxed

IMAGES = {
    "shifted": lambda purl: np.roll(purl, (1, 1), axis=(0, 1)),
    "mirrored": lambda purl: purl[:, ::-1],
    "from the back": lambda purl: ~purl,
}


@pytest.mark.parametrize("options", [{}, {"branch": "mirrored"}, {"cell_course_mm": 4.0}])
@pytest.mark.parametrize("text", ["KPP", "KP/PP/KK"])
@pytest.mark.parametrize("image", IMAGES)
def test_an_image_has_the_shape_of_the_chart(text, image, options):
    entry = sample("cotton", "rib")
    chart = StitchChart.parse(text)
    other = StitchChart(IMAGES[image](chart.purl))
    one = relax(chart, entry.yarn, entry.loop_length_mm, **options)
    two = relax(other, entry.yarn, entry.loop_length_mm, **options)
    assert two.chart.repeat() == other.repeat()
    assert two.energy_n_mm == pytest.approx(one.energy_n_mm, rel=1e-6)
    assert two.cell_course_mm == pytest.approx(one.cell_course_mm, rel=1e-4)
    assert two.cell_wale_mm == pytest.approx(one.cell_wale_mm, rel=1e-4)
    assert two.force_n == pytest.approx(one.force_n, abs=1e-4)
    assert two.minimum == one.minimum
    assert (two.mirrored is None) == (one.mirrored is None)


def test_the_yarn_of_a_mirrored_image_runs_the_other_way():
    chart = StitchChart.parse("KKP/KPP")
    one = relaxed(chart, sample("acrylic", "rib"), branch="free")
    two = turned(one, StitchChart(chart.purl[:, ::-1]))
    wide = 3 * one.cell_course_mm
    here, there = one.centre_lines[0], two.centre_lines[0, ::-1] * (-1.0, 1.0, 1.0)
    np.testing.assert_allclose(there + np.array([wide, 0.0, 0.0]), here, atol=1e-2)


def test_another_fabric_is_no_image():
    rib = relaxed("KP", sample("acrylic", "rib"), branch="mirrored")
    with pytest.raises(ValueError, match="no image"):
        turned(rib, StitchChart.parse("K\nP"))


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
