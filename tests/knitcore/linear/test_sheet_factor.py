"""Factors of sheets, flat and folded, against the matrix."""

import numpy as np
import pytest

from knitcore import StitchChart, material
from knitcore.base.arrays import Array
from knitcore.cloth.space.stitch_sheet import StitchSheet, sheet_of
from knitcore.cloth.space.tangent import Tangent
from knitcore.linear.sheet_factor import SheetFactor


def _sheet(rows: int, columns: int) -> StitchSheet:
    return sheet_of(StitchChart.parse("K").tile(rows, columns), material("acrylic"))


def _folded(sheet: StitchSheet) -> Array:
    """The right half laid on the left one, nearer than the cloth is thick."""
    x = sheet.flat_mm.copy()
    over = x[:, 0] > 0.0
    x[over, 2] = 0.7 * sheet.thickness_mm
    x[over, 0] *= -1.0
    return x


@pytest.mark.parametrize("folded", [False, True], ids=["flat", "folded"])
@pytest.mark.parametrize(("rows", "columns"), [(13, 17), (1, 40), (40, 1), (2, 3)])
def test_solves_with_the_matrix(rows: int, columns: int, folded: bool) -> None:
    sheet = _sheet(rows, columns)
    x = _folded(sheet) if folded else sheet.flat_mm
    pairs = sheet.pairs(x)
    assert folded == (len(pairs) > 0) or columns == 1
    free = np.ones(x.shape, bool)
    free[: columns // 2] = False
    matrix = Tangent(sheet).matrix(x, pairs, free, convex=True, shift=0.01)
    right = np.random.default_rng(0).standard_normal(x.size)
    for again in (False, True, True):
        solution = SheetFactor(matrix, columns + 1, again=again).solve(right)
        assert np.abs(matrix @ solution - right).max() < 1e-3 * np.abs(right).max()


def test_refuses_a_matrix_that_is_not_positive_definite() -> None:
    sheet = _sheet(12, 12)
    free = np.ones(sheet.flat_mm.shape, bool)
    matrix = Tangent(sheet).matrix(
        sheet.flat_mm, np.zeros((0, 2), int), free, convex=True, shift=-0.01
    )
    with pytest.raises(np.linalg.LinAlgError):
        SheetFactor(matrix, 13)
