"""Charts of any stitches: text, balance, symmetries and the stitch graph."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import STITCHES, YarnAct
from knitcore.chart.symbol_chart import SymbolChart

EXAMPLES = [
    "KKKK;O/\\O",
    "P[2/2R]P;PKKKKP;PKKKKP",
    "VK;KK;KV;KK",
    "TK;KK",
    "O^O;KKK",
    "KKTK;KKTK;KKKK",
    "BPbP",
    "vK;KK",
    "OO//;KKKK",
    "P[2/1RP]KK;KKKKKK",
]
charts = st.sampled_from(EXAMPLES).map(SymbolChart.parse)


@given(charts)
def test_text_key_mirror_and_back_are_read_again(chart: SymbolChart) -> None:
    assert SymbolChart.parse(chart.text) == SymbolChart.parse(chart.key) == chart
    assert chart.mirror().mirror() == chart.turn_over().turn_over() == chart
    assert chart.turn_over().mirror() == chart.mirror().turn_over()


@given(charts, st.integers(1, 3), st.integers(1, 3))
def test_every_loop_has_one_taker(chart: SymbolChart, down: int, across: int) -> None:
    graph = chart.tile(down, across).graph
    for row in range(graph.rows):
        taken = [s for c in range(graph.columns) for s in graph.sources(row, c)]
        assert sorted(np.mod(taken, graph.columns)) == list(range(graph.columns))
        for column in range(graph.columns):
            for source in graph.sources(row, column):
                copy, below = divmod(int(source), graph.columns)
                assert graph.taker()[row - 1, below] == column - copy * graph.columns


@given(charts)
def test_the_mirror_image_takes_mirrored_loops_in_the_same_order(chart: SymbolChart) -> None:
    graph, image = chart.graph, chart.mirror().graph
    last = graph.columns - 1
    for row in range(graph.rows):
        for column in range(graph.columns):
            mirrored = [last - source for source in graph.sources(row, column)]
            assert list(image.sources(row, last - column)) == mirrored
    assert (image.turn == -graph.turn[:, ::-1]).all()


@given(charts)
def test_the_back_takes_them_in_the_opposite_order(chart: SymbolChart) -> None:
    graph, back = chart.graph, chart.turn_over().graph
    last = graph.columns - 1
    for row in range(graph.rows):
        for column in range(graph.columns):
            mirrored = [last - source for source in graph.sources(row, column)][::-1]
            assert list(back.sources(row, last - column)) == mirrored
    through = graph.act == YarnAct.THROUGH
    assert (back.purl[:, ::-1] != graph.purl)[through].all()


def test_every_stitch_has_its_images_and_a_code_of_its_own() -> None:
    for stitch in STITCHES:
        assert stitch.mirrored.mirrored == stitch.turned_over.turned_over == stitch
        assert stitch.width == len(stitch.sites)
    assert len({stitch.words for stitch in STITCHES}) == len(STITCHES)


@pytest.mark.parametrize("text", ["KP/PK", "KP\nPK", "K-\n•K", "k p\np k"])
def test_knits_and_purls_are_read_as_before(text: str) -> None:
    chart = SymbolChart.parse(text)
    assert chart.is_plain
    assert chart.plain == StitchChart.parse(text)
    assert chart.key == StitchChart.parse(text).key


def test_a_held_stitch_is_as_the_stitch_below_in_the_purl_map() -> None:
    assert SymbolChart.parse("PVTK;PPPK").plain == StitchChart.parse("PPPK/PPPK")


@pytest.mark.parametrize(
    ("text", "held"), [("VK;KK", [[1, 0], [0, 0]]), ("KT;KV;KK", [[0, 2], [0, 1], [0, 0]])]
)
def test_rows_held(text: str, held: list[list[int]]) -> None:
    assert SymbolChart.parse(text).graph.rows_held().tolist() == held


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("KKK;O/K;KOK", "row 1 takes 2 stitches of the row below, which has 3. Add 1 decrease"),
        ("K/;KK", "row 2 takes 3 stitches"),
        ("VK;VK", "row 1, stitch 1 is held for ever"),
        ("VV;KK", "row 2 slips every stitch"),
        ("KK;K", "row 1 is 1 wide, row 2 is 2 wide"),
        ("KZ", "row 1, stitch 2 is 'Z'"),
    ],
)
def test_a_refusal_names_row_and_remedy(text: str, message: str) -> None:
    with pytest.raises(InputError, match="chart: ") as refusal:
        SymbolChart.parse(text)
    assert message in str(refusal.value)


def test_a_cable_does_not_reach_over_the_edge() -> None:
    cells = SymbolChart.parse("P[2/2R]P").cells
    with pytest.raises(InputError, match="row 1, stitch 2: 2/2 right cross needs 4 columns"):
        SymbolChart(cells[:, :4])
    with pytest.raises(InputError, match="row 1 begins within a stitch"):
        SymbolChart(cells[:, 2:])
