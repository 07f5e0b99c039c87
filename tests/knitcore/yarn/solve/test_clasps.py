"""The code of the clasps: the same for all shapes of a fabric, another where yarn passed yarn."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.drawn_yarn import drawn_yarn
from knitcore.yarn.model.cell import mirrored_cell, plain_cell
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.tiling import centre_lines
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.clasps import cell_is_knitted, clasp_code, knitted_code, same_clasps
from tests.knitcore.charts import flipped, stitch_charts

YARN = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.30)
WIDTH, HEIGHT = 6.0, 4.0


@settings(max_examples=25)
@given(stitch_charts(3), st.integers(0, 10**6))
def test_the_code_does_not_depend_on_the_shape_or_the_view(chart, seed):
    cell = plain_cell(chart, SplineGrid(16, 3))
    state = start_state(cell, 12.0, 0.6)
    lines = centre_lines(cell, state, chart.rows, chart.columns)
    width, height = chart.columns * state[-2], chart.rows * state[-1]
    code = clasp_code(lines, width, height)
    rng = np.random.default_rng(seed)
    slope = rng.uniform(-0.4, 0.4, 2)
    seen = lines.copy()
    seen[..., :2] += lines[..., 2:] * slope  # from another side
    seen += (*rng.uniform(-1.0, 1.0, 2), 0.3)  # elsewhere
    seen += 0.02 * rng.standard_normal(lines.shape)  # moved a little
    assert same_clasps(clasp_code(seen, width, height), code)
    again = np.roll(lines, 7, axis=1)  # begun elsewhere on the yarn
    again[:, :7, 0] -= width
    assert same_clasps(clasp_code(again, width, height), code)


@settings(max_examples=25)
@given(stitch_charts(3), st.data())
def test_a_stitch_on_the_other_side_changes_the_code(chart, data):
    row = data.draw(st.integers(0, chart.rows - 1))
    column = data.draw(st.integers(0, chart.columns - 1))
    code, changed = (np.array(knitted_code(c)) for c in (chart, flipped(chart, row, column)))
    assert not same_clasps(code, changed)


def test_loose_courses_are_not_fabric():
    lines = np.zeros((2, 40, 3))
    lines[..., 0] = np.arange(40) / 40 * WIDTH
    lines[1, :, 1] = HEIGHT / 2
    loose = clasp_code(lines, WIDTH, HEIGHT)
    parallel = 2 * np.log(np.abs(1 - np.exp(1j * np.array([1.9, 0.9, 2.9]))))
    np.testing.assert_allclose(loose, parallel, rtol=1e-12)
    for text in ("KK\nKK", "KP\nPK", "KP\nKP"):
        assert not same_clasps(loose, np.array(knitted_code(StitchChart.parse(text))))


@pytest.mark.parametrize("text", ["K", "KP", "PK\nKP"])
def test_a_strand_pushed_through_another_is_noticed(text):
    cell = mirrored_cell(StitchChart.parse(text), SplineGrid(16, 4))
    state = start_state(cell, 12.0, 0.6)
    assert cell_is_knitted(cell, state)
    controls = cell.controls(state)
    near_head = np.abs(np.arange(16) - 8) <= 1
    controls[0, :16][near_head, 2] *= -3.0
    through = cell.state(controls, state[-2], state[-1])
    assert not cell_is_knitted(cell, through)


@pytest.mark.slow
def test_rounding_does_not_spoil_the_code_of_a_large_chart() -> None:
    rng, rows = np.random.default_rng(2), []
    for _ in range(12):
        row = ""
        while len(row) < 24:
            holds = len(row) <= 21 and rng.random() < 0.25
            row += ("O/K", "\\OK")[int(rng.integers(2))] if holds else "K"
        rows += ["K" * 24, row]
    drawn = drawn_yarn(SymbolChart.parse(";".join(rows)).graph, 7.3224, 7.3224, 1.332)
    size = 24.0 * drawn.state[-2:]
    codes = [
        clasp_code(centre_lines(replace(drawn.cell, grid=grid), drawn.state, 24, 24), *size)
        for grid in (SplineGrid(drawn.cell.grid.controls, samples) for samples in (3, 4))
    ]
    assert same_clasps(*codes)
