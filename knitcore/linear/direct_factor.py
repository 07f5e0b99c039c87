"""The interface of factorisations on the grid, and the reference one, with SuperLU."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from knitcore.base.arrays import Array
from knitcore.linear.corner_numbering import cell_corners


class IndefiniteTangentError(Exception):
    """The matrix is not positive definite; the caller decides what to do."""


class Factor(Protocol):
    """Factors of symmetric matrices on one grid, two unknowns a corner, some of them prescribed."""

    def factorise(self, cell_matrices: Array) -> None:
        """Factorise the sum of symmetric cell matrices, (cells, 36) lower triangles by rows.

        Raises
        ------
        IndefiniteTangentError
            If the sum is not positive definite.
        """
        ...

    def solve(self, right_hand_side: Array) -> Array:
        """Solution (2 * corners,); 0 at the prescribed unknowns."""
        ...


def lower_triangle(cell_matrices: Array) -> Array:
    """Lower triangles, by rows, of (..., 8, 8) matrices: (..., 36)."""
    i, j = np.tril_indices(8)
    return cell_matrices[..., i, j]


def positive_definite_factor(matrix: Any) -> Callable[[Array], Array]:
    """SuperLU of a sparse symmetric matrix, in double precision: a function that solves with it.

    Raises
    ------
    IndefiniteTangentError
        If the matrix is not positive definite.
    """
    # pivots stay on the diagonal, so that their signs are those of the eigenvalues
    options = {"SymmetricMode": True}
    try:
        factor = splu(csc_matrix(matrix), "MMD_AT_PLUS_A", 0.0, options=options)
    except RuntimeError as error:  # exactly singular
        raise IndefiniteTangentError from error
    if not np.all(factor.U.diagonal() > 0.0):
        raise IndefiniteTangentError
    return factor.solve


class SciPyFactor:
    """SuperLU on the assembled matrix, in double precision.

    Parameters
    ----------
    columns, rows : cells.
    fixed : bool array (2 * corners,)
        Unknowns that are prescribed; their rows and columns are replaced by the identity.
    """

    def __init__(self, columns: int, rows: int, fixed: NDArray[np.bool_]) -> None:
        self._free = ~fixed
        unknowns = 2 * cell_corners(columns, rows)[:, :, None] + np.arange(2)
        self._places = unknowns.reshape(-1, 8)

    def factorise(self, cell_matrices: Array) -> None:
        """See :class:`Factor`."""
        full = np.empty((len(cell_matrices), 8, 8))
        i, j = np.tril_indices(8)
        full[:, i, j] = full[:, j, i] = cell_matrices
        row, column = np.repeat(self._places, 8, axis=1), np.tile(self._places, (1, 8))
        n = len(self._free)
        whole = csc_matrix((full.ravel(), (row.ravel(), column.ravel())), shape=(n, n))
        self._solve = positive_definite_factor(whole[self._free][:, self._free])

    def solve(self, right_hand_side: Array) -> Array:
        """See :class:`Factor`."""
        x = np.zeros(len(self._free))
        x[self._free] = self._solve(right_hand_side.ravel()[self._free])
        return x
