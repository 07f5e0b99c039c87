"""Images of a fabric: their number, and the shape to which they relax."""

from functools import cache
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.chart.repeats import primitive_repeats
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.solve.images import placement, placements, turned
from knitcore.yarn.study.relax import relax
from scripts.stored_stitches import COMMON
from tests.knitcore.charts import stitch_charts
from tests.knitcore.yarn.relaxed import relaxed

IMAGES = {
    "shifted": lambda purl: np.roll(purl, (1, 1), axis=(0, 1)),
    "mirrored": lambda purl: purl[:, ::-1],
    "from the back": lambda purl: ~purl,
}


HELD = {"free": {}, "mirrored": {"branch": "mirrored"}, "held": {"cell_course_mm": 4.0}}


@cache
def rested(text, way):
    """A repeat of cotton, relaxed in a way."""
    entry = sample("cotton", "rib")
    return relax(StitchChart.parse(text), entry.yarn, entry.loop_length_mm, **HELD[way])


@pytest.mark.parametrize(
    ("text", "way", "image"),
    [
        *product(["KPP"], ["mirrored", "held"], IMAGES),
        *product(["KP/PP/KK"], ["free"], IMAGES),
        ("KP/PP/KK", "mirrored", "shifted"),
        ("KP/PP/KK", "held", "from the back"),
    ],
)
@pytest.mark.slow
def test_an_image_has_the_shape_of_the_chart(text, way, image):
    original = rested(text, way)
    other = StitchChart(IMAGES[image](StitchChart.parse(text).purl))
    turned_over = rested(other.text, way)
    assert turned_over.chart.repeat() == other.repeat()
    assert turned_over.energy_n_mm == pytest.approx(original.energy_n_mm, rel=1e-6)
    assert turned_over.cell_course_mm == pytest.approx(original.cell_course_mm, rel=1e-4)
    assert turned_over.cell_wale_mm == pytest.approx(original.cell_wale_mm, rel=1e-4)
    assert turned_over.force_n == pytest.approx(original.force_n, abs=1e-4)
    assert turned_over.minimum == original.minimum
    assert (turned_over.mirrored is None) == (original.mirrored is None)


@pytest.mark.slow
def test_the_yarn_of_a_mirrored_image_runs_the_other_way():
    chart = StitchChart.parse("KKP/KPP")
    grid = SplineGrid(12, 4)
    original = relaxed(chart, sample("acrylic", "rib"), branch="free", grid=grid)
    mirrored = turned(original, StitchChart(chart.purl[:, ::-1]))
    wide = 3 * original.cell_course_mm
    here, there = original.centre_lines[0], mirrored.centre_lines[0, ::-1] * (-1.0, 1.0, 1.0)
    np.testing.assert_allclose(there + np.array([wide, 0.0, 0.0]), here, atol=1e-2)


def test_another_fabric_is_no_image():
    rib = relaxed("KP", sample("acrylic", "rib"), branch="mirrored")
    with pytest.raises(ValueError, match="no image"):
        turned(rib, StitchChart.parse("K\nP"))


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


def test_common_repeats_are_primitive_and_different():
    charts = [StitchChart.parse(text) for text in COMMON.values()]
    assert all(chart.repeat() == chart for chart in charts)
    assert len({chart.canonical() for chart in charts}) == len(charts)


@given(stitch_charts(4), st.integers(0, 5), st.integers(0, 5), st.booleans(), st.booleans())
def test_symmetric_charts_have_one_representative(chart, up, right, mirror, swap):
    other = chart.mirror() if mirror else chart
    other = other.swap() if swap else other
    other = StitchChart(np.roll(other.purl, (up, right), axis=(0, 1)))
    assert other.canonical() == other.tile(2, 3).canonical() == chart.canonical()
    assert placement(other, chart.canonical()) is not None
