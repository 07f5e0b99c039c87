"""Densities of charts: invariances, pure fabrics, and how little one stitch changes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import StitchChart
from knitcore.chart.fabric import PHASES
from knitcore.prediction.densities import densities
from tests.knitcore.charts import flipped, stitch_charts


@settings(max_examples=40)
@given(stitch_charts(), st.integers(0, 11), st.integers(0, 11))
def test_the_same_cloth_has_the_same_densities(chart: StitchChart, up: int, right: int) -> None:
    own = densities(chart)
    shifted = StitchChart(np.roll(chart.purl, (up, right), axis=(0, 1)))
    for other in (shifted, chart.mirror(), chart.swap(), chart.turn_over(), chart.tile(2, 3)):
        same = densities(other)
        assert np.allclose(same.features, own.features, atol=1e-9)
        assert np.allclose(same.straight, own.straight, atol=1e-9)
        assert np.allclose(same.even, own.even, atol=1e-9)


@pytest.mark.parametrize("fabric", PHASES)
def test_a_pure_fabric_has_no_excess(fabric: str) -> None:
    pure = densities(StitchChart.of_fabric(fabric, 4, 6))
    assert np.abs(pure.excess).max() < 1e-12
    assert pure.shares.max() == 1.0


@settings(max_examples=20)
@given(stitch_charts(8), st.integers(0, 31), st.integers(0, 31))
def test_one_stitch_of_1024_changes_little(chart: StitchChart, row: int, column: int) -> None:
    whole = chart.resized(32, 32)
    before, after = densities(whole), densities(flipped(whole, row, column))
    assert np.abs(after.shares - before.shares).max() < 6 / 1024
    assert np.abs(after.excess - before.excess).max() < 80 / 1024  # fields reach about 10 stitches


def test_columns_of_a_rib_are_straight_and_rows_of_a_welt() -> None:
    assert densities(StitchChart.parse("KKPP")).straight == pytest.approx([1, 0], abs=0.01)
    assert densities(StitchChart.parse("K\nK\nP\nP")).straight == pytest.approx([0, 1], abs=0.01)


def test_the_shorter_run_hides_behind_the_longer() -> None:
    for longer in range(1, 6):
        rib = densities(StitchChart.parse("K" * longer + "P"))
        assert rib.even[0] == pytest.approx(np.log2((longer + 1) / longer), abs=0.02)
    uneven = np.hstack([StitchChart.parse("KKPP").resized(1, 48).purl, np.zeros((1, 48), bool)])
    assert densities(StitchChart(uneven)).even[0] > 0.9  # plain cloth beside a rib takes nothing


@pytest.mark.parametrize("side", [4, 8, 32])
def test_single_purls_are_two_dimensional_however_few_they_are(side: int) -> None:
    grid = np.zeros((side, side), dtype=bool)
    grid[0, 0] = True
    assert densities(StitchChart(grid)).ways[2:].sum() > 0.6
    assert densities(StitchChart.parse("KKPP")).ways == pytest.approx([1, 0, 0, 0], abs=1e-9)
