"""Blocks of stitches in place of stitches: what a large chart's test leaves out."""

import numpy as np
import pytest

from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.flat.coarse import MAX_DIFFERENCE, block_side
from knitcore.cloth.flat.strip import chart_sheet, strip_test
from knitcore.materials import material

ACRYLIC = material("acrylic")


def test_blocks_are_no_larger_than_they_must_be() -> None:
    for rows, columns in ((101, 100), (400, 400), (1000, 7), (1, 1), (1000, 1000)):
        side = block_side(rows, columns)
        blocks, more = (-(-rows // k) * -(-columns // k) for k in (side, max(side - 1, 1)))
        assert blocks <= 10_000
        assert more > 10_000 or side == 1


@pytest.mark.parametrize("direction", Direction)
def test_a_pure_fabric_is_the_same_in_blocks(direction: Direction) -> None:
    chart = StitchChart.of_fabric("garter", rows=24, columns=24)
    exact, blurred = (strip_test(chart, ACRYLIC, direction, 0.3, steps=3, block=b) for b in (1, 4))
    assert blurred.dofs < exact.dofs / 12
    assert blurred.force_n == pytest.approx(exact.force_n, rel=5e-3)
    assert blurred.waist_strain == pytest.approx(exact.waist_strain, abs=5e-4)


@pytest.mark.slow
@pytest.mark.parametrize("direction", Direction)
def test_parts_of_a_chart_differ_no_more_than_the_intervals_allow_for(direction: Direction) -> None:
    row, column = np.mgrid[:120, :120]
    inside = ((row - 60) / 24) ** 2 + ((column - 60) / 42) ** 2 < 1
    chart = StitchChart(inside & ((row + column) % 2 == 1))
    exact, blurred = (strip_test(chart, ACRYLIC, direction, [0.1, 0.3], block=b) for b in (1, 3))
    assert blurred.force_n == pytest.approx(exact.force_n, rel=MAX_DIFFERENCE["force"])
    assert blurred.waist_strain == pytest.approx(exact.waist_strain, abs=MAX_DIFFERENCE["waist"])


def test_a_shape_keeps_its_area_and_stays_in_one_piece() -> None:
    shape = np.ones((30, 30), dtype=bool)
    shape[:13, :11] = shape[16:, 15:] = False
    thin = np.zeros_like(shape)
    thin[:, :9] = thin[:, 21:] = thin[14, :] = True
    chart = StitchChart.of_fabric("seed", rows=30, columns=30)
    for stitch, tolerance in ((shape, 0.05), (thin, 0.3)):
        exact, blurred = (chart_sheet(chart, ACRYLIC, stitch=stitch, block=b) for b in (1, 4))
        assert blurred.grid.area_mm2 == pytest.approx(exact.grid.area_mm2, rel=tolerance)
