"""Factorisations on a grid: nested dissection against SuperLU on the assembled matrix."""

import gc
import weakref

import numpy as np
import pytest
from scipy.sparse import coo_array

from knitcore.cloth.flat.grid import corners_of
from knitcore.linear.direct_factor import IndefiniteTangentError, positive_definite_factor
from knitcore.linear.grid_factor import GridFactor

LOWER = (..., *np.tril_indices(8))


def _assembled(cells, columns, rows):
    """The sum of cell matrices (cells, 8, 8)."""
    corners = np.column_stack(corners_of(np.arange(columns * rows), columns))
    places = (2 * corners[:, :, None] + np.arange(2)).reshape(-1, 8)
    row, column = np.repeat(places, 8, axis=1), np.tile(places, (1, 8))
    return coo_array((cells.ravel(), (row.ravel(), column.ravel()))).tocsc()


@pytest.mark.parametrize(("columns", "rows"), [(1, 1), (2, 1), (3, 17), (20, 19), (140, 128)])
def test_nested_dissection_solves_like_superlu(columns, rows):
    rng = np.random.default_rng(columns)
    half = rng.normal(size=(columns * rows, 8, 8))
    cells = half @ half.transpose(0, 2, 1) + 8 * np.eye(8)
    fixed = np.arange(2 * (columns + 1) * (rows + 1)) < 3
    right = rng.normal(size=fixed.size)
    expected = np.zeros(fixed.size)
    matrix = _assembled(cells, columns, rows)[~fixed][:, ~fixed]
    expected[~fixed] = positive_definite_factor(matrix)(right[~fixed])
    assert matrix @ expected[~fixed] == pytest.approx(right[~fixed])
    factor = GridFactor(columns, rows, fixed)
    factor.factorise(cells[LOWER])
    assert factor.solve(right) == pytest.approx(expected, abs=2e-5 * np.abs(expected).max())


def test_indefinite_matrices_are_refused():
    cells = np.tile(np.diag([1.0] * 7 + [-1.0]), (4, 1, 1))
    with pytest.raises(IndefiniteTangentError):
        GridFactor(2, 2, np.zeros(18, dtype=bool)).factorise(cells[LOWER])
    with pytest.raises(IndefiniteTangentError):
        positive_definite_factor(_assembled(cells, 2, 2))


@pytest.mark.parametrize("cell", [0, -1])
def test_an_indefinite_cell_is_found_in_either_branch(cell):
    """130 x 130 cells are many enough for two threads; a definite matrix works afterwards."""
    cells = np.tile(np.eye(8)[LOWER], (130 * 130, 1))
    good = cells.copy()
    cells[cell] *= -8.0
    factor = GridFactor(130, 130, np.zeros(2 * 131**2, dtype=bool))
    with pytest.raises(IndefiniteTangentError):
        factor.factorise(cells)
    factor.factorise(good)
    assert factor.solve(np.ones(2 * 131**2))[[0, 2]] == pytest.approx([1.0, 0.5])


def test_a_factor_dropped_gives_its_memory_back_at_once():
    """A large chart's takes a gigabyte, too much to wait for the garbage collector."""
    gc.disable()
    try:
        factor = GridFactor(3, 2, np.zeros(24, dtype=bool))
        left = weakref.ref(factor)
        del factor
        assert left() is None
    finally:
        gc.enable()
