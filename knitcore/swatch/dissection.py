"""Direct solution on a plain grid: multifrontal Cholesky by nested dissection.

The tangent of a swatch couples the two unknowns of a corner with those of its eight neighbours on
a rectangular grid. Halving the grid again and again (nested dissection) gives the elimination
order with the least fill, and because the grid is known beforehand no ordering has to be searched.
Each box of the tree owns a dense front: the unknowns that only it holds (eliminated here) and
those on its border with other boxes (handed on to the parent as a Schur complement). The dense
work is LAPACK's. General sparse solvers were measured beside it; see ``docs/swatch.md``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg.blas import dsyrk, dtrsm
from scipy.linalg.lapack import dpotrf

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LEAF_CELLS = 8
"""Boxes are not halved below this many cells a side (measured optimum, flat from 6 to 10)."""


class IndefiniteTangentError(Exception):
    """The matrix is not positive definite; the caller decides what to do."""


@dataclass(frozen=True)
class _Box:
    """One node of the tree, children first. All index arrays count unknowns (2 per corner)."""

    cells: Indices  # of a leaf, else empty
    local: Indices  # (cells, 8) position of each cell unknown in the front of a leaf
    children: tuple[int, ...]
    child_places: tuple[Indices, ...]  # where the borders of the children go in this front
    eliminated: Indices
    border: Indices
    offset: int  # of its columns in the factor


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
    >>> solver.factorise(np.tile(np.eye(8), (2, 1, 1)))
    >>> solver.solve(np.ones(12)).round(2).tolist()[:4]
    [1.0, 1.0, 0.5, 0.5]
    """

    def __init__(self, columns: int, rows: int, fixed: NDArray[np.bool_]) -> None:
        self.unknowns = 2 * (columns + 1) * (rows + 1)
        self.fixed = fixed.copy()
        self._fixed_numbers = np.flatnonzero(fixed)
        self._boxes: list[_Box] = []
        self._size = 0
        self._build(columns, rows)
        self._factor: Array = np.empty(0)
        # The tree flattened for the compiled substitution.
        self._eliminated = _concatenate([box.eliminated for box in self._boxes])
        self._border = _concatenate([box.border for box in self._boxes])
        self._tree = np.array(
            [(box.offset, len(box.eliminated), len(box.border)) for box in self._boxes],
            dtype=np.int64,
        )

    @property
    def entries(self) -> int:
        """Stored numbers of the factor."""
        return self._size

    def factorise(self, cell_matrices: Array) -> None:
        """Factorise the sum of (cells, 8, 8) symmetric cell matrices.

        Raises
        ------
        IndefiniteTangentError
            If the sum is not positive definite.
        """
        if self._factor.size == 0:
            self._factor = np.empty(self._size)
        pending: dict[int, Array] = {}
        for number, box in enumerate(self._boxes):
            s, b = len(box.eliminated), len(box.border)
            pivot, below = self._columns_of(box)
            pivot[:] = 0.0
            below[:] = 0.0
            schur = np.zeros((b, b), order="F")
            if box.children:
                for child, places in zip(box.children, box.child_places, strict=True):
                    _extend_add(pending.pop(child), places, pivot, below, schur)
            else:
                _add_cells(cell_matrices, box.cells, box.local, pivot, below, schur)
                _fix(self.fixed, box.eliminated, box.border, pivot, below, schur)
            if s:
                _, info = dpotrf(pivot, lower=1, clean=0, overwrite_a=1)
                if info != 0:
                    raise IndefiniteTangentError
                if b:
                    dtrsm(1.0, pivot, below, side=1, lower=1, trans_a=1, overwrite_b=1)
                    schur = dsyrk(-1.0, below, beta=1.0, c=schur, lower=1, overwrite_c=1)
            pending[number] = schur

    def solve(self, right_hand_side: Array) -> Array:
        """Solution (2 * corners,); 0 at the fixed unknowns."""
        x = right_hand_side.ravel().copy()
        x[self._fixed_numbers] = 0.0
        _substitute(self._factor, self._tree, self._eliminated, self._border, x)
        return x

    def _columns_of(self, box: _Box) -> tuple[Array, Array]:
        s, b = len(box.eliminated), len(box.border)
        middle = box.offset + s * s
        return (
            self._factor[box.offset : middle].reshape((s, s), order="F"),
            self._factor[middle : middle + b * s].reshape((b, s), order="F"),
        )

    def _build(self, columns: int, rows: int) -> None:
        """Append the boxes of the tree in the order of their elimination."""

        def border_of(x0: int, x1: int, y0: int, y1: int) -> tuple[Indices, Indices]:
            """Corners of a box: (those only it holds or its children do, those on the border)."""
            y, x = np.mgrid[y0 : y1 + 1, x0 : x1 + 1]
            shared = (
                ((x == x0) & (x0 > 0))
                | ((x == x1) & (x1 < columns))
                | ((y == y0) & (y0 > 0))
                | ((y == y1) & (y1 < rows))
            )
            corner = y * (columns + 1) + x
            return corner[~shared], corner[shared]

        def visit(x0: int, x1: int, y0: int, y1: int) -> int:
            width, height = x1 - x0, y1 - y0
            own, border = border_of(x0, x1, y0, y1)
            if max(width, height) <= LEAF_CELLS:
                cy, cx = np.mgrid[y0:y1, x0:x1]
                cells = (cy * columns + cx).ravel()
                first = (cy * (columns + 1) + cx).ravel()
                above = first + columns + 1
                corners = np.column_stack([first, first + 1, above + 1, above])
                front = _unknowns(np.concatenate([own, border]))
                local = _positions(front, _unknowns(corners.ravel())).reshape(-1, 8)
                return self._append(own, border, cells, local, (), ())
            if width >= height:
                middle = x0 + width // 2
                children = (visit(x0, middle, y0, y1), visit(middle, x1, y0, y1))
            else:
                middle = y0 + height // 2
                children = (visit(x0, x1, y0, middle), visit(x0, x1, middle, y1))
            borders = [self._boxes[child].border for child in children]
            mine = _unknowns(border)
            eliminated = np.setdiff1d(np.concatenate(borders), mine)
            front = np.concatenate([eliminated, mine])
            places = tuple(_positions(front, b) for b in borders)
            none = np.empty(0, dtype=np.int64)
            return self._append(
                eliminated[::2] // 2, border, none, none.reshape(0, 8), children, places
            )

        visit(0, columns, 0, rows)

    def _append(
        self,
        own: Indices,
        border: Indices,
        cells: Indices,
        local: Indices,
        children: tuple[int, ...],
        places: tuple[Indices, ...],
    ) -> int:
        box = _Box(cells, local, children, places, _unknowns(own), _unknowns(border), self._size)
        self._size += len(box.eliminated) * (len(box.eliminated) + len(box.border))
        self._boxes.append(box)
        return len(self._boxes) - 1


def _unknowns(corners: Indices) -> Indices:
    return (2 * corners[:, None] + np.arange(2)).ravel().astype(np.int64)


def _positions(front: Indices, numbers: Indices) -> Indices:
    order = np.argsort(front)
    return order[np.searchsorted(front, numbers, sorter=order)].astype(np.int64)


def _concatenate(arrays: list[Indices]) -> Indices:
    return np.concatenate(arrays).astype(np.int64)


@njit(cache=True)
def _place(r: int, c: int, value: float, s: int, pivot: Array, below: Array, schur: Array) -> None:
    """Add to the lower triangle of the front made of pivot, below and schur."""
    if r < c:
        r, c = c, r
    if r < s:
        pivot[r, c] += value
    elif c < s:
        below[r - s, c] += value
    else:
        schur[r - s, c - s] += value


@njit(cache=True)
def _extend_add(child: Array, places: Indices, pivot: Array, below: Array, schur: Array) -> None:
    """Add the lower triangle of a child's Schur complement to its parent's front."""
    s = pivot.shape[0]
    for c in range(child.shape[1]):
        for r in range(c, child.shape[0]):
            _place(places[r], places[c], child[r, c], s, pivot, below, schur)


@njit(cache=True)
def _add_cells(
    matrices: Array, cells: Indices, local: Indices, pivot: Array, below: Array, schur: Array
) -> None:
    """Add the lower triangles of cell matrices to the front of a leaf."""
    s = pivot.shape[0]
    for n in range(cells.size):
        for i in range(8):
            for j in range(i + 1):
                value = matrices[cells[n], i, j]
                _place(local[n, i], local[n, j], value, s, pivot, below, schur)


@njit(cache=True)
def _fix(
    fixed: NDArray[np.bool_],
    eliminated: Indices,
    border: Indices,
    pivot: Array,
    below: Array,
    schur: Array,
) -> None:
    """Replace the rows and columns of fixed unknowns by those of the identity."""
    s, b = eliminated.size, border.size
    for i in range(s):
        if fixed[eliminated[i]]:
            pivot[i, :] = 0.0
            pivot[:, i] = 0.0
            below[:, i] = 0.0
            pivot[i, i] = 1.0
    for i in range(b):
        if fixed[border[i]]:
            below[i, :] = 0.0
            schur[i, :] = 0.0
            schur[:, i] = 0.0
            schur[i, i] = 1.0


@njit(cache=True)
def _substitute(
    factor: Array, tree: Indices, eliminated: Indices, border: Indices, x: Array
) -> None:
    """Forward and backward substitution in place."""
    boxes = tree.shape[0]
    e0 = b0 = 0
    for box in range(boxes):
        offset, s, b = tree[box]
        below = offset + s * s
        for i in range(s):
            y = x[eliminated[e0 + i]] / factor[offset + i * s + i]
            x[eliminated[e0 + i]] = y
            for r in range(i + 1, s):
                x[eliminated[e0 + r]] -= factor[offset + i * s + r] * y
            for r in range(b):
                x[border[b0 + r]] -= factor[below + i * b + r] * y
        e0 += s
        b0 += b
    for box in range(boxes - 1, -1, -1):
        offset, s, b = tree[box]
        below = offset + s * s
        e0 -= s
        b0 -= b
        for i in range(s - 1, -1, -1):
            y = x[eliminated[e0 + i]]
            for r in range(b):
                y -= factor[below + i * b + r] * x[border[b0 + r]]
            for r in range(i + 1, s):
                y -= factor[offset + i * s + r] * x[eliminated[e0 + r]]
            x[eliminated[e0 + i]] = y / factor[offset + i * s + i]
