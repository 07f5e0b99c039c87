"""The paths of the yarn of any stitches."""

import numpy as np
import pytest
from hypothesis import given, settings

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.held_loops import HeldLoops
from knitcore.yarn.loops.loop_paths import LoopPaths
from tests.knitcore.symbol_charts import symbol_charts


def paths(chart: SymbolChart) -> list[Array]:
    yarn = LoopPaths(HeldLoops(chart.graph))
    return [yarn.of_row(row).points[1:] for row in range(chart.rows)]


@settings(max_examples=15)
@given(symbol_charts(most_rows=2, most_columns=6, drawn=True))
def test_mirror_image_and_back_have_the_mirrored_shape(chart: SymbolChart) -> None:
    for image, depth in ((chart.mirror(), 1.0), (chart.turn_over(), -1.0)):
        for path, mirrored in zip(paths(chart), paths(image), strict=True):
            turned = (chart.columns - 1.0, 0.0, 0.0) + mirrored[::-1] * (-1.0, 1.0, depth)
            assert np.allclose(path, turned, atol=1e-9)


def test_layers_of_decreases_tucks_and_cables() -> None:
    """k2tog has its left loop in front, a right cross those that move right, a tuck its strand
    behind."""

    def layers(text: str, column: int) -> dict[tuple[int, int], int]:
        held = HeldLoops(SymbolChart.parse(text).graph)
        return {(on.loop.row, on.loop.column): on.layer for on in held.on_needle(1, column)}

    assert layers("O/;KK", 1) == {(0, 0): 1, (0, 1): -1}
    assert layers("\\O;KK", 0) == {(0, 0): -1, (0, 1): 1}
    assert layers("KK;KT", 1) == {(-1, 1): 1, (0, 1): -1}
    held = HeldLoops(SymbolChart.parse("[1/1R];KK").graph)
    assert [held.passing(1, column) for column in (0, 1)] == [-1, 1]


def test_loops_that_are_twisted_and_knitted_together_are_refused() -> None:
    with pytest.raises(InputError, match="row 1, stitch 1 twists loops"):
        HeldLoops(SymbolChart.parse("KK;[K10']O").graph)
