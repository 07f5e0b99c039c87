"""Holes and folds of a cloth."""

import numpy as np
import pytest

from knitcore.yarn.loops.holes import holes, is_folded

SPREAD = np.linspace(0.0, 12.0, 240, endpoint=False)


def lines(spacing: float, rows: int) -> np.ndarray:
    return np.stack(
        [np.stack([SPREAD, 0 * SPREAD + spacing * row, 0 * SPREAD], axis=1) for row in range(rows)]
    )


def test_straight_yarn_leaves_a_slit_between_two_rows() -> None:
    slits = holes(lines(3.0, 4), 12.0, 12.0, 0.5)
    assert len(slits.areas_mm2) == 4
    assert np.allclose(slits.areas_mm2, 24.0, rtol=0.05)
    assert np.isclose(slits.share, 2.0 / 3.0, rtol=0.05)
    assert slits.eyelet_mm2(0) is None
    assert slits.eyelet_mm2(2) == pytest.approx(24.0, rel=0.05)


def test_a_hole_over_the_edge_of_the_repeat_is_one_hole() -> None:
    moved = lines(3.0, 4) - (0.0, 1.5, 0.0)
    assert len(holes(moved, 12.0, 12.0, 0.5).areas_mm2) == 4


def test_yarn_side_by_side_leaves_no_hole() -> None:
    closed = holes(lines(0.5, 4), 12.0, 2.0, 0.5)
    assert closed.share == 0.0
    assert closed.eyelet_mm2(1) is None


def test_steep_rows_and_columns_are_folds() -> None:
    flat = lines(3.0, 2)
    assert not is_folded(flat, 4, 3.0, 3.0)
    for heights in (4.0 * (SPREAD > 6.0) * np.ones((2, 1)), 4.0 * np.ones(240) * [[0], [1]]):
        assert is_folded(flat + heights[..., None] * (0.0, 0.0, 1.0), 4, 3.0, 3.0)
