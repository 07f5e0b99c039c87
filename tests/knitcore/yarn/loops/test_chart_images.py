"""Images of a repeat, of which one is relaxed for all."""

import numpy as np
import pytest
from hypothesis import given, settings

from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.chart_images import ChartImage
from knitcore.yarn.loops.relaxed_stitches import relax_stitches
from knitcore.yarn.loops.take_down import room_for_yarn
from knitcore.yarn.model.tiling import centre_lines
from knitcore.yarn.solve.clasps import clasp_code, same_clasps
from tests.knitcore.symbol_charts import symbol_charts
from tests.knitcore.yarn.random_charts import ACRYLIC, EXAMPLES, LOOP_MM


def begun_higher(chart: SymbolChart) -> SymbolChart:
    return SymbolChart(np.roll(chart.cells, 1, axis=0))


@settings(max_examples=20)
@given(symbol_charts())
def test_every_image_has_the_same_least_one(chart: SymbolChart) -> None:
    least = ChartImage.least(chart).chart
    for image in (
        chart.mirror(),
        chart.turn_over(),
        begun_higher(chart),
        chart.mirror().turn_over(),
    ):
        assert ChartImage.least(image).chart == least


def code_as_knitted(chart: SymbolChart) -> np.ndarray:
    drawn = room_for_yarn(chart.graph, ACRYLIC, LOOP_MM)
    lines = centre_lines(drawn.cell, drawn.state, chart.rows, chart.columns)
    wale, row = drawn.state[-2:]
    return clasp_code(lines, chart.columns * float(wale), chart.rows * float(row))


@pytest.mark.parametrize(
    "text",
    ["VK;KK", "O/;KK", pytest.param(EXAMPLES["cable 1/1, both ways"], marks=pytest.mark.slow)],
)
def test_images_rest_alike_each_knotted_as_its_own_chart(text: str) -> None:
    chart, rests = SymbolChart.parse(text), []
    for image in (chart, chart.mirror(), chart.turn_over(), begun_higher(chart)):
        rest = relax_stitches(image, ACRYLIC, LOOP_MM, history="agitated")
        whole = image.columns * rest.cell_course_mm, image.rows * rest.cell_wale_mm
        assert same_clasps(clasp_code(rest.centre_lines, *whole), code_as_knitted(image))
        assert np.all(np.diff(rest.centre_lines[:, [0, -1], 0], axis=1) > 0.0)  # left to right
        rests.append((rest.cell_course_mm, rest.cell_wale_mm, rest.hole_share, rest.crossings))
    assert len(set(rests)) == 1
