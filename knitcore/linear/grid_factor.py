"""Direct solution on a plain grid: multifrontal Cholesky by nested dissection.

The tangent of a swatch couples the two unknowns of a corner with those of its eight neighbours on
a rectangular grid. Halving the grid again and again (nested dissection) gives the elimination
order with the least fill, and because the grid is known beforehand no ordering has to be searched.
For a comparison with general sparse solvers see ``docs/swatch.md``.

The factor serves as a preconditioner of conjugate gradients in double precision, so single
precision is enough for it: half the memory and half the time. Only where single precision cannot
decide whether the matrix is positive definite is it factorised again in double precision.
Matrices of other meshes have a factor of SuperLU.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.linear.front_tree import Block, BlockRows, CornerFront, FrontTree, Indices

LEAF_CELLS = 8
"""Boxes are not halved below this many cells a side (a flat optimum from 6 to 10)."""
SIDE_BY_SIDE = 500
"""Fewest boxes for which two threads pay off, one for each branch of the tree."""


class IndefiniteTangentError(Exception):
    """The matrix is not positive definite; the caller decides what to do."""


class GridFactor:
    """Cholesky factors of matrices on one grid of ``columns x rows`` cells.

    Parameters
    ----------
    columns, rows : cells.
    fixed : bool array (2 * corners,)
        Unknowns that are prescribed; their rows and columns are replaced by the identity.

    Examples
    --------
    >>> solver = GridFactor(2, 1, np.zeros(12, dtype=bool))
    >>> solver.factorise(np.tile(np.eye(8)[np.tril_indices(8)], (2, 1)))
    >>> solver.solve(np.ones(12)).round(2).tolist()[:4]
    [1.0, 1.0, 0.5, 0.5]
    """

    def __init__(self, columns: int, rows: int, fixed: NDArray[np.bool_]) -> None:
        self._columns = columns
        self._fixed = fixed.copy()
        fronts = _fronts(columns, rows)
        self._tree = FrontTree(fronts, 2, two_threads=len(fronts) >= SIDE_BY_SIDE)
        self._matrix = _nine_point(columns, rows)
        self._places = _places(columns)
        self._precision: type[np.floating] = np.float32
        self._factor: Block = np.empty(0)
        self._work: Block = np.empty(0)

    def factorise(self, cell_matrices: Array) -> None:
        """Factorise the sum of symmetric cell matrices, (cells, 36) lower triangles by rows.

        Raises
        ------
        IndefiniteTangentError
            If the sum is not positive definite.
        """
        near, blocks = self._matrix.columns, self._matrix.blocks
        _add_cells(cell_matrices, self._columns, self._places, self._fixed, near, blocks)
        if self._is_definite(self._precision):
            return
        if self._precision == np.float64 or not self._is_definite(np.float64):
            raise IndefiniteTangentError
        self._precision = np.float64  # single precision fails here, and would fail again

    def solve(self, right_hand_side: Array) -> Array:
        """Solution (2 * corners,) to the factor's precision; 0 at the fixed unknowns."""
        return self._tree.solve(self._factor, np.where(self._fixed, 0.0, right_hand_side.ravel()))

    def _is_definite(self, precision: type[np.floating]) -> bool:
        if self._factor.dtype != precision or self._factor.size == 0:
            self._factor = np.empty(self._tree.entries, precision)
            self._work = np.empty(self._tree.work, precision)
        return self._tree.eliminate(self._matrix, self._factor, self._work)


def _places(columns: int) -> NDArray[np.int64]:
    """Where the entries of a cell's matrix go, see :func:`_add_cells`."""
    x, y = np.array([0, 1, 1, 0]), np.array([0, 0, 1, 1])
    i, j = np.tril_indices(8)
    p, q, m, n = i // 2, j // 2, i % 2, j % 2
    first = 9 * (y * (columns + 1) + x) + 4
    step = 3 * (y[q] - y[p]) + x[q] - x[p]
    return np.stack([4 * (first[p] + step) + 2 * m + n, 4 * (first[q] - step) + 2 * n + m])


@compiled
def _add_cells(
    cells: Array,
    columns: int,
    places: Indices,
    fixed: NDArray[np.bool_],
    near: NDArray[np.int32],
    blocks: Array,
) -> None:
    """Sum cell matrices into blocks (9 a corner, from that below and left of it to that above and
    right), with rows and columns of the identity for fixed unknowns.

    Parameters
    ----------
    cells : (cells, 36) lower triangles by rows.
    columns : cells in a row.
    places : (2, 36) where each entry and its mirror image go, from the blocks of the first corner.
    fixed : by unknown.
    near : (9 * corners,) the corner of each block's column; beyond the grid the row's own.
    blocks : (9 * corners, 2, 2)
    """
    blocks[:] = 0.0
    flat = blocks.reshape(-1)
    for cell in range(cells.shape[0]):
        first = 36 * (cell // columns * (columns + 1) + cell % columns)
        for k in range(36):
            value, own, mirrored = cells[cell, k], places[0, k], places[1, k]
            flat[first + own] += value
            if own != mirrored:
                flat[first + mirrored] += value
    for unknown in range(fixed.size):
        if fixed[unknown]:
            corner, m = divmod(unknown, 2)
            for side in range(9):
                other = near[9 * corner + side]
                if other != corner or side == 4:
                    blocks[9 * corner + side, m, :] = 0.0
                    blocks[9 * other + 8 - side, :, m] = 0.0
            blocks[9 * corner + 4, m, m] = 1.0


def _nine_point(columns: int, rows: int) -> BlockRows:
    """A matrix that couples each corner with its neighbours; beyond the grid with itself, by 0."""
    y, x = np.mgrid[0 : rows + 1, 0 : columns + 1]
    up, right = (part.ravel() for part in np.mgrid[-1:2, -1:2])
    above, beside = y.reshape(-1, 1) + up, x.reshape(-1, 1) + right
    inside = (above >= 0) & (above <= rows) & (beside >= 0) & (beside <= columns)
    own = np.arange(x.size)[:, None]
    near = np.where(inside, above * (columns + 1) + beside, own)
    starts = np.arange(0, near.size + 1, 9, dtype=np.int32)
    return BlockRows(starts, near.ravel().astype(np.int32), np.zeros((near.size, 2, 2)))


def _fronts(columns: int, rows: int) -> list[CornerFront]:
    """Boxes of cells, halved across their longer side; a box owns the corners on its cut."""
    corner = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
    fronts: list[CornerFront] = []

    def add(x0: int, x1: int, y0: int, y1: int) -> int:
        box = corner[y0 : y1 + 1, x0 : x1 + 1]
        shared = np.zeros(box.shape, bool)
        for side, is_shared in (
            (np.s_[:, 0], x0 > 0), (np.s_[:, -1], x1 < columns),
            (np.s_[0], y0 > 0), (np.s_[-1], y1 < rows),
        ):  # fmt: skip
            shared[side] |= is_shared
        own = ~shared
        children: tuple[int, ...] = ()
        if max(x1 - x0, y1 - y0) > LEAF_CELLS:
            cut = np.zeros(box.shape, bool)
            if x1 - x0 >= y1 - y0:
                middle = (x0 + x1) // 2
                cut[:, middle - x0] = True
                children = (add(x0, middle, y0, y1), add(middle, x1, y0, y1))
            else:
                middle = (y0 + y1) // 2
                cut[middle - y0] = True
                children = (add(x0, x1, y0, middle), add(x0, x1, middle, y1))
            own &= cut
        fronts.append(CornerFront(box[own], box[shared], children))
        return len(fronts) - 1

    add(0, columns, 0, rows)
    return fronts


def positive_definite_factor(matrix: Any) -> Callable[[Array], Array]:
    """SuperLU of a sparse symmetric matrix, in double precision: a function that solves with it.

    Raises
    ------
    IndefiniteTangentError
        If the matrix is not positive definite.
    """
    from scipy.sparse.linalg import splu  # slow to import

    # pivots stay on the diagonal, so that their signs are those of the eigenvalues
    options = {"SymmetricMode": True}
    try:
        factor = splu(scipy.sparse.csc_matrix(matrix), "MMD_AT_PLUS_A", 0.0, options=options)
    except RuntimeError as error:  # exactly singular
        raise IndefiniteTangentError from error
    if not np.all(factor.U.diagonal() > 0.0):
        raise IndefiniteTangentError
    return factor.solve
