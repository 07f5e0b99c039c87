import numpy as np
import pytest
from hypothesis import given

from knitcore import Direction, Fabric, StitchChart, segment_map
from tests.knitcore.charts import stitch_charts


@given(stitch_charts())
def test_turning_over_mirrors_the_maps_and_a_swap_changes_nothing(chart: StitchChart) -> None:
    face = segment_map(chart)
    for other, order in ((chart.turn_over(), slice(None, None, -1)), (chart.swap(), slice(None))):
        segments = segment_map(other)
        np.testing.assert_array_equal(segments.course_odd, face.course_odd[:, order])
        np.testing.assert_array_equal(segments.wale_odd, face.wale_odd[:, order])


@given(stitch_charts())
def test_around_a_repeat_the_number_of_odd_segments_is_even(chart: StitchChart) -> None:
    segments = segment_map(chart, periodic=True)
    assert not (segments.course_odd.sum(axis=1) % 2).any()
    assert not (segments.wale_odd.sum(axis=0) % 2).any()


@given(stitch_charts())
def test_the_maps_determine_the_chart_up_to_one_stitch(chart: StitchChart) -> None:
    segments = segment_map(chart)
    row = np.logical_xor.accumulate(np.concatenate([chart.purl[0, :1], segments.course_odd[0]]))
    grid = np.logical_xor.accumulate(np.concatenate([row[None], segments.wale_odd]), axis=0)
    assert StitchChart(grid) == chart


@pytest.mark.parametrize("fabric", list(Fabric))
def test_pure_fabrics_have_segments_of_one_kind(fabric: Fabric) -> None:
    segments = segment_map(StitchChart.of_fabric(fabric, rows=7, columns=5))
    course, wale = segments.counts(Direction.COURSE), segments.counts(Direction.WALE)
    assert (course.odd, course.even) == ((28, 0) if fabric.course_odd else (0, 28))
    assert (wale.odd, wale.even) == ((30, 0) if fabric.wale_odd else (0, 30))


def test_a_repeat_has_a_segment_for_every_stitch_and_a_piece_one_less() -> None:
    chart = StitchChart.parse("KPP/KKP")
    piece, repeat = segment_map(chart), segment_map(chart, periodic=True)
    assert (piece.periodic, repeat.periodic) == (False, True)
    assert piece.course_odd.tolist() == [[False, True], [True, False]]
    assert piece.wale_odd.tolist() == [[False, True, False]]
    assert repeat.course_odd.tolist() == [[False, True, True], [True, False, True]]
    assert repeat.wale_odd.tolist() == [[False, True, False]] * 2


@given(stitch_charts())
def test_a_tube_is_a_repeat_around_and_a_piece_up_and_down(chart: StitchChart) -> None:
    tube = segment_map(chart, tube=True)
    np.testing.assert_array_equal(tube.course_odd, segment_map(chart, periodic=True).course_odd)
    np.testing.assert_array_equal(tube.wale_odd, segment_map(chart).wale_odd)
