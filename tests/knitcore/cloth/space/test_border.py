"""Borders on a table."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.border import RULE_STITCHES, advice, on_table
from knitcore.cloth.space.even_cloth import EvenCloth, cloth_of
from knitcore.materials import material


def _cloth(chart: str) -> EvenCloth:
    return cloth_of(StitchChart.parse(chart), material("acrylic"), linear_density_g_per_m=0.5)


PIECE, GARTER = _cloth("K"), _cloth("K/P")


def test_the_weight_of_the_border_balances_the_moment_of_the_piece() -> None:
    found = advice(PIECE, GARTER, 0, time_limit_s=0.0)
    assert 0.5 * GARTER.weight_n_per_mm2 * found.width_mm**2 == pytest.approx(PIECE.moment_n[0])
    assert (found.stitches - 1) * GARTER.stitch_mm[0] < found.width_mm
    ruled = max(RULE_STITCHES) * GARTER.stitch_mm[0]
    assert found.rule_share == pytest.approx((ruled / found.width_mm) ** 2)


def test_a_board_holds_from_that_width_on() -> None:
    """A border that does not bend: just wide enough it stays on the table, narrower it tips."""
    board = replace(GARTER, rigidity_n_mm=(20.0, 20.0))
    width = advice(PIECE, board, 0, time_limit_s=0.0).width_mm
    edges = []
    for share in (0.8, 1.2):
        sheet, found = on_table(PIECE, board, 0, share * width)
        line = found.x.reshape(2, sheet.columns + 1, 3)[0]
        edges.append(line[[0, -1], 2].max())
    assert edges[0] > 3.0
    assert edges[1] < 0.1


@pytest.mark.slow
def test_a_border_that_bends_rises_in_a_ridge_and_rolls_up() -> None:
    found = advice(PIECE, GARTER, 0)
    assert not found.holds
    assert found.ridge_mm > 3.0 * PIECE.thickness_mm
    assert found.line_mm[0, 1] == pytest.approx(0.0, abs=0.1)  # its own edge stays on the table


def test_what_does_not_curl_needs_no_border() -> None:
    found = advice(GARTER, GARTER, 1)
    assert (found.stitches, found.width_mm, found.holds) == (0, 0.0, True)


def test_a_strip_on_a_table_rests_on_it_with_its_weight() -> None:
    sheet, found = on_table(GARTER, GARTER, 0, 20.0)
    depth = -np.minimum(found.x[:, 2], 0.0)
    width = np.ptp(sheet.flat_mm, axis=0)
    weight = GARTER.weight_n_per_mm2 * width[0] * width[1]
    assert sheet.touch_n_per_mm * depth.sum() == pytest.approx(weight, rel=0.01)
