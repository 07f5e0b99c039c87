"""The yarn of lace, cables, slips and tucks as it is drawn."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings

from knitcore.chart.stitch_kinds import BY_CODE
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.draw.looped import (
    MAX_LOOPED,
    SOURCE,
    STEP_MM,
    loop_lines_mm,
    looped_shapes,
    shapes_of,
)
from knitcore.draw.placing import placed_lines, unstretched
from knitcore.draw.stitches import stitch_shapes
from knitcore.materials import material
from knitcore.prediction.predict import predict
from knitcore.yarn.loops.loop_crossings import Crossing, Crossings, drawn_crossings
from knitcore.yarn.loops.loop_paths import PARTS
from tests.knitcore.symbol_charts import symbol_charts
from tests.knitcore.yarn.random_charts import EXAMPLES

ACRYLIC = material("acrylic")
STITCH_MM, LAYER_MM = np.array([3.3, 2.3]), 0.55
Loops = tuple[tuple[int, int], tuple[int, int]]


def _of_loops(crossing: Crossing) -> Loops:
    upper, lower = crossing
    return (upper.row, upper.column), (lower.row, lower.column)


def _between_loops(crossings: Counter[Crossing]) -> Counter[Loops]:
    """How often each loop passes over each other one."""
    loops: Counter[Loops] = Counter()
    for crossing, number in crossings.items():
        loops[_of_loops(crossing)] += number
    return loops


@pytest.mark.parametrize(
    "text", [*EXAMPLES.values(), "[6/6L];" + ";".join(["K" * 12] * 4)], ids=[*EXAMPLES, "cable 6/6"]
)
def test_every_loop_passes_over_and_under_others_as_the_chart_asks(text: str) -> None:
    graph = SymbolChart.parse(text).graph
    lines = loop_lines_mm(graph, STITCH_MM, LAYER_MM).reshape(*graph.act.shape, -1, 3)[:, :, :-1]
    rows, columns = np.indices(graph.act.shape)
    lines = (
        lines + np.stack([columns * STITCH_MM[0], rows * STITCH_MM[1], 0 * rows], -1)[:, :, None]
    )
    part = np.repeat(PARTS * np.arange(graph.columns), lines.shape[2])
    width, height = STITCH_MM * (graph.columns, graph.rows)
    drawn = _between_loops(
        drawn_crossings(
            lines.reshape(graph.rows, -1, 3), np.tile(part, (graph.rows, 1)), width, height
        )
    )
    needed = Crossings.of(graph)
    exact, layered = _between_loops(needed.exact), {_of_loops(pair) for pair in needed.layered}
    for upper, lower in drawn.keys() | exact.keys():
        pair = upper, lower
        if upper != lower:
            assert drawn[pair] == exact[pair] or (drawn[pair] > exact[pair] and pair in layered)


@given(symbol_charts(most_rows=2, most_columns=6, drawn=True))
@settings(max_examples=15)
def test_the_mirror_image_is_drawn_as_the_mirror_image(chart: SymbolChart) -> None:
    shape = chart.rows, chart.columns, -1, 3
    lines, mirrored = (
        loop_lines_mm(c.graph, STITCH_MM, LAYER_MM).reshape(shape) for c in (chart, chart.mirror())
    )
    turned = mirrored[:, ::-1, ::-1] * (-1.0, 1.0, 1.0)
    assert np.abs(lines - turned).max() <= 2 * STEP_MM  # steps are rounded


def test_the_cloth_is_as_large_as_predicted_and_its_yarn_goes_on() -> None:
    mesh = SymbolChart.parse("KKKKKK;KO/\\OK").tile(3, 2)
    shapes, size = looped_shapes(mesh, ACRYLIC), predict(mesh, ACRYLIC)
    assert shapes.source == SOURCE
    assert len(shapes.lines) == 12  # of the repeat
    np.testing.assert_allclose(
        np.ptp(shapes.lattice.corners_mm, axis=(0, 1)),
        (12 * size.relaxed_course_mm, 6 * size.relaxed_wale_mm),
    )
    lines = placed_lines(shapes, unstretched(shapes))
    np.testing.assert_allclose(lines[:, :-1, -1], lines[:, 1:, 0], atol=1e-3)


def test_yarn_overs_leave_holes() -> None:
    """The yarn keeps away from the middle of an eyelet by more than from any gap of the cloth."""

    def widest_gap(row: str) -> float:
        chart = SymbolChart.parse(f"KKKKKKK;KKKKKKK;{row};KKKKKKK").tile(2, 1)
        shapes = looped_shapes(chart, ACRYLIC)
        lines = placed_lines(shapes, unstretched(shapes))[..., :2].reshape(-1, 2)
        (x, y), (width, height) = (
            of[1, 3] for of in (shapes.lattice.centres_mm, shapes.lattice.sizes_mm)
        )
        across, up = np.linspace(-0.5, 0.5, 11) * width, np.linspace(-0.8, 0.4, 13) * height
        places = np.stack(np.meshgrid(x + across, y + up), axis=-1).reshape(-1, 1, 2)
        away = np.linalg.norm(places - lines, axis=-1).min(axis=1).max()
        return float(away / shapes.yarn_radius_mm)

    assert widest_gap("KK/OKKK") > 1.2 * widest_gap("KKKKKTK")


def test_far_from_a_hole_all_stitches_have_one_shape() -> None:
    cells = np.zeros((40, 40), dtype=np.int16)
    cells[20, 20:22] = BY_CODE["O"], BY_CODE["/"]
    shapes = looped_shapes(SymbolChart(cells), ACRYLIC)
    assert len(shapes.lines) < 500
    assert (shapes.index[:5] == shapes.index[0, 0]).all()


def test_plain_charts_and_very_large_repeats_are_drawn_of_knits_and_purls() -> None:
    rng = np.random.default_rng(1)
    side = int(MAX_LOOPED**0.5) + 1
    cells = rng.integers(0, 2, (side, side)).astype(np.int16)
    cells[20, 20:22] = BY_CODE["O"], BY_CODE["/"]
    large = SymbolChart(cells)
    drawn, plain = shapes_of(large, ACRYLIC), stitch_shapes(large.plain, ACRYLIC)
    assert drawn.source.startswith("knits and purls alone")
    same = shapes_of(large.plain, ACRYLIC)
    for shapes in (drawn, same):
        np.testing.assert_array_equal(shapes.lines, plain.lines)
        np.testing.assert_array_equal(shapes.lattice.centres_mm, plain.lattice.centres_mm)
    assert same.source == plain.source


def test_loops_that_are_twisted_and_knitted_together_are_drawn_without_the_twist() -> None:
    twisted, plain = (
        looped_shapes(SymbolChart.parse(f"KKK;{code}OK"), ACRYLIC) for code in ("[K10']", "\\")
    )
    np.testing.assert_allclose(twisted.lines, plain.lines, atol=0.1)
