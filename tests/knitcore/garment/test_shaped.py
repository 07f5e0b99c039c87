import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from knitcore import Fabric, InputError, StitchChart
from knitcore.chart.phases import LEFT, RIGHT, surroundings
from knitcore.garment.shaped import ShapedChart, largest_rectangle
from tests.knitcore.pieces import pieces

SHAPED = pieces(yarns=1).map(lambda piece: piece.shaped)


@given(shaped=SHAPED)
def test_text_keeps_chart_and_outline(shaped: ShapedChart) -> None:
    assert ShapedChart.parse(shaped.chart.text, shaped.outline) == shaped


@given(shaped=SHAPED)
def test_spans_are_the_stitches(shaped: ShapedChart) -> None:
    assert sum(stop - start for start, stop in shaped.spans) == shaped.stitches


@given(shaped=SHAPED)
def test_continued_charts_are_the_same_inside(shaped: ShapedChart) -> None:
    assert ShapedChart(shaped.continued(), shaped.stitch) == shaped


@given(shaped=SHAPED, fabric=st.sampled_from(Fabric))
def test_a_pure_fabric_is_pure_up_to_its_outline(shaped: ShapedChart, fabric: Fabric) -> None:
    """In rows and columns of several stitches; a lone one has no neighbour to go by."""
    pure = StitchChart.of_fabric(fabric, rows=shaped.chart.rows, columns=shaped.chart.columns)
    purl = np.where(shaped.stitch, pure.purl, shaped.chart.purl)
    codes = surroundings(ShapedChart(StitchChart(purl), shaped.stitch).continued())
    inside = shaped.stitch
    wide = inside.sum(axis=1) > 1
    odd_across = (codes & (LEFT | RIGHT))[inside & wide[:, None]]
    assert set(odd_across.tolist()) <= {(LEFT | RIGHT) * int(fabric.course_odd)}


def test_cells_outside_the_outline_have_no_effect() -> None:
    first = ShapedChart.parse("KP\nKP", "x.\nxx")
    assert first == ShapedChart.parse("KK\nKP", "x.\nxx")
    assert first != ShapedChart.parse("PK\nKP", "x.\nxx")


@pytest.mark.parametrize(
    ("outline", "says"),
    [
        ("xxx\n...\nxxx", "row 2 has no stitch"),
        ("xxx\nx.x\nxxx", "row 2 is in two parts"),
        ("..x\nx..\nxxx", "row 3 does not stand on row 2"),
        ("xx\nxx", "the chart 3x3"),
        ("xyz\nxxx\nxxx", "not a grid of x and dots"),
        ("xxx\nxx\nxxx", "not a grid"),
    ],
)
def test_outlines_that_cannot_be_knitted(outline: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        ShapedChart.parse("KKK\nKKK\nKKK", outline)


def test_a_rectangle_has_no_holes() -> None:
    chart = StitchChart.of_fabric("rib", rows=3, columns=4)
    assert ShapedChart.rectangle(chart).stitches == 12


@given(arrays(bool, array_shapes(min_dims=2, max_dims=2, max_side=7)))
def test_no_rectangle_inside_has_more_stitches(stitch: np.ndarray) -> None:
    rows, columns = stitch.shape
    most = max(
        (bottom - top) * (right - left)
        for top in range(rows)
        for bottom in range(top, rows + 1)
        for left in range(columns)
        for right in range(left, columns + 1)
        if stitch[top:bottom, left:right].all()
    )
    inside = stitch[largest_rectangle(stitch)]
    assert inside.all()
    assert inside.size == most


def test_a_glove_s_largest_part_is_its_palm() -> None:
    marks = ["x.x.x", "x.x.x", "xxxxx", "xxxxx", "xxxxx"][::-1]
    stitch = np.array([[mark == "x" for mark in line] for line in marks])
    assert largest_rectangle(stitch) == (slice(0, 3), slice(0, 5))
