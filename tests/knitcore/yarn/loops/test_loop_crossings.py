"""The crossings that a graph asks for, and those of curves."""

import pytest

from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.drawn_yarn import drawn_yarn
from knitcore.yarn.loops.loop_crossings import Crossings
from tests.knitcore.yarn.random_charts import EXAMPLES

COUNTS = {
    "stockinette": 16,
    "cable 1/1": 20,
    "cable 1/1, both ways": 40,
    "cable 2/2 between purls": 112,
    "cable 2/2": 80,
    "rib 4x2": 24,
    "twisted": 5,
    "twisted rib": 9,
}
"""Four of a loop that is pulled through, four of two that cross, two of a twist or a float's."""


@pytest.mark.parametrize("name", COUNTS)
def test_the_crossings_of_a_repeat_are_counted(name: str) -> None:
    needed = Crossings.of(SymbolChart.parse(EXAMPLES[name]).graph)
    assert sum(needed.exact.values()) == COUNTS[name]


@pytest.mark.parametrize(
    ("text", "other"),
    [("O/;KK", "\\O;KK"), ("[1/1R];KK", "[1/1L];KK"), ("KK;VK", "KK;vK"), ("KK;TK", "KK;tK"),
     ("KK;TK", "KK;VK"), ("B", "[B']"), ("K", "P")],
)  # fmt: skip
def test_a_shape_of_another_chart_is_noticed(text: str, other: str) -> None:
    drawn = drawn_yarn(SymbolChart.parse(text).graph, 4.5, 4.5, 1.2)
    assert Crossings.of(SymbolChart.parse(other).graph).wrong(drawn.crossings)
