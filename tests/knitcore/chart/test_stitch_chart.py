import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import Fabric, InputError, StitchChart
from knitcore.chart.stitch_chart import (
    MAX_STITCHES_PER_SIDE,
    as_chart,
    check_stitches,
    size_in_words,
)
from tests.knitcore.charts import stitch_charts
from tests.knitcore.refusals import refuses


@given(stitch_charts())
def test_text_is_read_back(chart: StitchChart) -> None:
    assert StitchChart.parse(chart.text) == StitchChart.parse(chart.key) == chart


@given(stitch_charts())
def test_turning_over_is_mirror_and_swap_and_each_undoes_itself(chart: StitchChart) -> None:
    for act in (StitchChart.mirror, StitchChart.swap, StitchChart.turn_over):
        assert act(act(chart)) == chart
    assert chart.turn_over() == chart.mirror().swap() == chart.swap().mirror()


@given(stitch_charts(6), st.integers(1, 3), st.integers(1, 3))
def test_the_repeat_of_a_tiling_tiles_it(chart: StitchChart, down: int, across: int) -> None:
    tiled = chart.tile(down, across)
    repeat = tiled.repeat()
    assert repeat.rows <= chart.rows
    assert repeat.columns <= chart.columns
    assert repeat.tile(tiled.rows // repeat.rows, tiled.columns // repeat.columns) == tiled


@given(stitch_charts(8))
def test_a_cut_repeat_continues_to_the_chart(chart: StitchChart) -> None:
    assert chart.repeat_cut().resized(chart.rows, chart.columns) == chart


@pytest.mark.parametrize(("fabric", "size"), [("stockinette", (1, 1)), ("garter", (2, 1))])
def test_pure_fabrics_have_their_repeat(fabric: str, size: tuple[int, int]) -> None:
    repeat = StitchChart.of_fabric(fabric, rows=31, columns=31).repeat_cut()
    assert (repeat.rows, repeat.columns) == size


def test_the_top_row_is_written_first() -> None:
    chart = StitchChart.parse("PP\nKK")
    assert not chart.purl[0].any()
    assert chart.purl[1].all()


def test_symbols_blanks_and_comments() -> None:
    assert StitchChart.parse("# a comment\n | • \n\n–,k\n") == StitchChart.parse("KP\nPK")


def test_charts_cannot_be_changed() -> None:
    grid = np.zeros((2, 2), dtype=bool)
    chart = StitchChart(grid)
    with pytest.raises(ValueError, match="read-only"):
        chart.purl[0, 0] = True
    grid[0, 0] = True
    assert not chart.purl.any()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no stitches"),
        ("KX", "line 1, stitch 2 is 'X'"),
        ("KP\nK", "line 2 has 1 stitches, line 1 has 2"),
        ("K" * (MAX_STITCHES_PER_SIDE + 1), "too large"),
        ("\n".join("K" * (MAX_STITCHES_PER_SIDE + 1)), "too large"),
    ],
)
def test_bad_text_is_refused_with_place_and_remedy(text: str, says: str) -> None:
    with refuses("chart", says) as caught:
        StitchChart.parse(text)
    assert caught.value.remedy


def test_an_empty_or_flat_grid_is_refused() -> None:
    for grid in (np.zeros((0, 3)), np.zeros((3, 0)), np.zeros(3)):
        with pytest.raises(InputError):
            StitchChart(grid.astype(bool))


def test_unknown_fabrics_are_refused() -> None:
    with pytest.raises(InputError, match="stockinette, garter, rib, seed"):
        StitchChart.of_fabric("velvet", rows=2, columns=2)


def test_too_many_stitches_are_refused_with_the_most_that_are_taken() -> None:
    rib = StitchChart.of_fabric("rib", rows=3, columns=4)
    check_stitches(rib.stitches, 12)
    with pytest.raises(InputError, match=r"chart: its cell has 12 stitches. Use at most 11.") as no:
        check_stitches(rib.stitches, 11, "its cell")
    assert no.value.most == 11


def test_one_column_is_not_several() -> None:
    assert size_in_words(1, 12) == "1 column x 12 rows"
    assert size_in_words(20, 1) == "20 columns x 1 row"


def test_a_chart_has_a_shape_and_a_length() -> None:
    chart = StitchChart.parse("KKP/PPK")
    assert chart.shape == chart.purl.shape == (2, 3)
    assert len(chart) == 2


@pytest.mark.parametrize("fabric", Fabric)
def test_a_chart_is_read_from_its_text_or_a_fabric_name(fabric: Fabric) -> None:
    chart = StitchChart.of_fabric(fabric)
    assert as_chart(chart) is chart
    assert as_chart(chart.text) == as_chart(fabric.value.upper()) == chart
