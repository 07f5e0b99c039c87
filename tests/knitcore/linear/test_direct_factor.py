"""Factorisations on a grid: nested dissection against SciPy."""

import gc
import weakref

import numpy as np
import pytest

from knitcore.linear.corner_numbering import cell_corners
from knitcore.linear.direct_factor import IndefiniteTangentError, SciPyFactor, lower_triangle
from knitcore.linear.grid_factor import GridFactor


@pytest.mark.parametrize(("columns", "rows"), [(1, 1), (2, 1), (3, 17), (20, 19), (140, 128)])
def test_nested_dissection_solves_like_scipy(columns, rows):
    rng = np.random.default_rng(columns)
    half = rng.normal(size=(columns * rows, 8, 8))
    cells = half @ half.transpose(0, 2, 1) + 8 * np.eye(8)
    n = 2 * (columns + 1) * (rows + 1)
    fixed = np.zeros(n, dtype=bool)
    fixed[:3] = True
    right = rng.normal(size=n)
    found = []
    for kind in (GridFactor, SciPyFactor):
        factor = kind(columns, rows, fixed)
        factor.factorise(lower_triangle(cells))
        found.append(factor.solve(right))
    assert found[0] == pytest.approx(found[1], abs=2e-5 * np.abs(found[1]).max())


def test_scipy_s_factor_solves_the_sum_of_the_cells():
    cells = np.random.default_rng(0).normal(size=(6, 8, 8))
    cells = cells @ cells.transpose(0, 2, 1) + 8 * np.eye(8)
    whole = np.zeros((24, 24))
    for cell, corners in zip(cells, cell_corners(3, 2), strict=True):
        places = (2 * corners[:, None] + np.arange(2)).ravel()
        whole[np.ix_(places, places)] += cell
    factor = SciPyFactor(3, 2, np.zeros(24, dtype=bool))
    factor.factorise(lower_triangle(cells))
    assert whole @ factor.solve(np.arange(24.0)) == pytest.approx(np.arange(24.0))


@pytest.mark.parametrize("kind", [GridFactor, SciPyFactor])
def test_indefinite_matrices_are_refused(kind):
    cells = lower_triangle(np.tile(np.diag([1.0] * 7 + [-1.0]), (4, 1, 1)))
    with pytest.raises(IndefiniteTangentError):
        kind(2, 2, np.zeros(18, dtype=bool)).factorise(cells)


@pytest.mark.parametrize("cell", [0, -1])
def test_an_indefinite_cell_is_found_in_either_branch(cell):
    """130 x 130 cells are many enough for two threads; a definite matrix works afterwards."""
    cells = np.tile(lower_triangle(np.eye(8)), (130 * 130, 1))
    good = cells.copy()
    cells[cell] *= -8.0
    factor = GridFactor(130, 130, np.zeros(2 * 131**2, dtype=bool))
    with pytest.raises(IndefiniteTangentError):
        factor.factorise(cells)
    factor.factorise(good)
    assert factor.solve(np.ones(2 * 131**2))[[0, 2]] == pytest.approx([1.0, 0.5])


def test_a_factor_dropped_gives_its_memory_back_at_once():
    """Those of large charts take a gigabyte, too much to wait for the garbage collector."""
    gc.disable()
    try:
        factor = GridFactor(3, 2, np.zeros(24, dtype=bool))
        left = weakref.ref(factor)
        del factor
        assert left() is None
    finally:
        gc.enable()
