"""Yarn that is drawn in to its length."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.take_down import GRID, TakeDown, room_for_yarn
from knitcore.yarn.model.conventions import Convention
from tests.knitcore.yarn.random_charts import ACRYLIC, EXAMPLES, LOOP_MM


def test_a_cable_is_drawn_finely_and_drawn_in_on_the_usual_grid() -> None:
    drawn = room_for_yarn(SymbolChart.parse(EXAMPLES["cable 1/1"]).graph, ACRYLIC, LOOP_MM)
    assert drawn.cell.grid.controls > GRID.controls
    goal = np.full(drawn.cell.rows, LOOP_MM)
    energy, minimum = TakeDown(ACRYLIC, Convention.PUBLISHED, goal)(drawn)
    assert energy.cell.grid == GRID
    assert np.abs(minimum.terms.excess_mm).max() < 0.02 * LOOP_MM * drawn.cell.wales
    assert minimum.min_distance_mm > 2.0 * ACRYLIC.core_radius_mm


@pytest.mark.parametrize("side", ["L", "R"])
def test_every_cable_of_up_to_six_wales_has_room_for_its_yarn(side: str) -> None:
    for front, back in [(n, m) for n in range(1, 6) for m in range(1, 7 - n)]:
        chart = SymbolChart.parse(f"[{front}/{back}{side}];{'K' * (front + back)}")
        drawn = room_for_yarn(chart.graph, ACRYLIC, LOOP_MM)
        assert drawn.exact, chart


def test_the_last_bits_of_places_do_not_change_where_the_yarn_ends() -> None:
    drawn = room_for_yarn(SymbolChart.parse("KKKK;KO/K").graph, ACRYLIC, LOOP_MM)
    take_down = TakeDown(ACRYLIC, Convention.PUBLISHED, np.full(drawn.cell.rows, LOOP_MM))
    noise = 1e-14 * np.random.default_rng(3).standard_normal(drawn.state.shape)
    other = replace(drawn, state=drawn.state * (1.0 + noise))
    (_, here), (_, there) = take_down(drawn), take_down(other)
    assert np.array_equal(here.state, there.state)
