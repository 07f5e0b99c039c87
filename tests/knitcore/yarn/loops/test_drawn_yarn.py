"""The first shape of any stitches has the crossings of its graph."""

import pytest
from hypothesis import given, settings

from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.drawn_yarn import drawn_yarn
from tests.knitcore.symbol_charts import symbol_charts
from tests.knitcore.yarn.random_charts import EXAMPLES


@pytest.mark.parametrize("text", EXAMPLES.values(), ids=EXAMPLES)
def test_examples_are_drawn_as_their_charts_say(text: str) -> None:
    drawn_yarn(SymbolChart.parse(text).graph, 4.5, 4.5, 1.2)


@settings(max_examples=15)
@given(symbol_charts(most_rows=2, most_columns=6, drawn=True))
def test_any_balanced_chart_is_drawn_as_it_says(chart: SymbolChart) -> None:
    drawn_yarn(chart.graph, 4.5, 4.5, 1.2)
