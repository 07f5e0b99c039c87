"""Charts of loops with their parents, as KnitDB decodes them."""

import json
from typing import Any

import pytest

from knitcore.base.errors import InputError
from knitcore.chart.stitch_kinds import YarnAct
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.parent_loops import CROSSINGS, read_parent_loops


def as_text(chart: SymbolChart) -> str:
    """The file of a chart that is knitted back and forth from the right."""
    graph, columns = chart.graph, chart.columns
    rows: list[list[list[Any]]] = [[["K"]] * columns]
    for row in range(chart.rows):
        to_left = row % 2 == 0
        line: list[list[Any]] = []
        for column in range(columns):
            parents = graph.sources(row, column).tolist()
            purl = bool(graph.purl[row, column])
            symbol = "PK"[not purl] + "t" * int(graph.turn[row, column] > 0)
            if graph.act[row, column] != YarnAct.THROUGH:
                symbol = "K"
            if not purl:
                parents.reverse()
            line.append([symbol, *(columns - 1 - p if not to_left else p for p in parents)])
        rows.append(line[::-1] if to_left else line)
    return json.dumps({"rows": rows})


@pytest.mark.parametrize(
    "text",
    [
        "KP;PK",
        "KKKK;O/\\O",
        "O^O;KPK",
        "ORO;OLO;KKK",
        "OJO;O)K",
        "P[2/2R]P;PKKKKP;P[2/1RP]KP;BbBbBb",
        "O[P10']K;KKK",
    ],
)
def test_a_chart_is_read_back(text: str) -> None:
    chart = SymbolChart.parse(text)
    again, notes = read_parent_loops(as_text(chart))
    assert again == chart
    assert notes == ((CROSSINGS,) if "[2/" in text else ())


def test_rows_that_all_go_one_way_are_read_as_rounds() -> None:
    rows = [[["K"]] * 3, [["P", 0], ["K", 1], ["K", 2]], [["K", 0], ["K", 1], ["P", 2]]]
    assert read_parent_loops(json.dumps({"rows": rows}))[0].text == "PKK\nKKP"


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ([[["K"]] * 2, [["K", 1], ["K", 1]]], "row 1 names parent 1 twice"),
        ([[["K"]] * 2, [["K", 1], ["K", 2]]], "row 1 names parent 2, and the last"),
        ([[["K"]] * 2, [["K", 1]]], "row 1 does not name parent 0"),
        ([[["K"]] * 2], "at least 2 items"),
        ([[["X"]], [["K", 0]]], "rows[0][0][0]"),
        ([[["K"]] * 2, [["K", 1, 0]]], "row 1 takes 2 stitches of the row below, which has 1"),
    ],
)
def test_a_refusal_names_the_row(rows: list[Any], message: str) -> None:
    with pytest.raises(InputError) as refusal:
        read_parent_loops(json.dumps({"rows": rows}))
    assert message in str(refusal.value)
