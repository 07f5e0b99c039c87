"""Direct solution on a plain grid: multifrontal Cholesky by nested dissection.

The tangent of a swatch couples the two unknowns of a corner with those of its eight neighbours on
a rectangular grid. Halving the grid again and again (nested dissection) gives the elimination
order with the least fill, and because the grid is known beforehand no ordering has to be searched.
Each box of the tree owns a dense front: the unknowns that only it holds (eliminated here) and
those on its border with other boxes (handed on to the parent as a Schur complement). The dense
work is LAPACK's. General sparse solvers were measured beside it; see ``docs/swatch.md``.

The factor serves as a preconditioner of conjugate gradients in double precision, so single
precision is enough for it: half the memory and half the time. Only where single precision cannot
tell whether the matrix is positive definite is it factorised again in double precision.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.linalg import blas, lapack

Array = NDArray[np.float64]
Block = NDArray[np.floating]
Indices = NDArray[np.int64]

LEAF_CELLS = 8
"""Boxes are not halved below this many cells a side (measured optimum, flat from 6 to 10)."""


class IndefiniteTangentError(Exception):
    """The matrix is not positive definite; the caller decides what to do."""


@dataclass(frozen=True)
class _Half:
    """A child's border in its parent's front: positions there, and where they go, ascending."""

    inner: Indices
    inner_places: Indices  # among the parent's eliminated unknowns
    outer: Indices
    outer_places: Indices  # among the parent's border


@dataclass(frozen=True)
class _Shape:
    """What boxes of one shape have in common. Index arrays count unknowns (2 per corner) from the
    lower left corner of the box.
    """

    halves: tuple[_Half, ...]  # empty for a leaf
    cells: Indices  # of a leaf, else empty
    places: Indices  # (cells, 36) where the lower triangle of each cell goes, see _places
    eliminated: Indices
    border: Indices


@dataclass(frozen=True)
class _Box:
    """One node of the tree; the children come before it."""

    shape: _Shape
    children: tuple[int, ...]
    cells: Indices
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
        self._factor: Block = np.empty(0)
        self._single = True
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
        if self._single:
            try:
                self._eliminate(cell_matrices, np.dtype(np.float32))
            except IndefiniteTangentError:
                pass
            else:
                return
        self._eliminate(cell_matrices, np.dtype(np.float64))
        self._single = False  # single precision could not tell here, nor will it further on

    def solve(self, right_hand_side: Array) -> Array:
        """Solution (2 * corners,) to the factor's precision; 0 at the fixed unknowns."""
        x = right_hand_side.ravel().astype(self._factor.dtype)
        x[self._fixed_numbers] = 0.0
        v = np.empty(int(self._tree[:, 1:].sum(axis=1).max()), x.dtype)
        _forward(self._factor, self._tree, self._eliminated, self._border, v, x)
        _backward(self._factor, self._tree, self._eliminated, self._border, v, x)
        return x.astype(np.float64)

    def _eliminate(self, cell_matrices: Array, dtype: np.dtype[np.floating]) -> None:
        if self._factor.dtype != dtype or self._factor.size == 0:
            self._factor = np.empty(self._size, dtype)
        single = dtype == np.float32
        potrf = lapack.spotrf if single else lapack.dpotrf
        trsm = blas.strsm if single else blas.dtrsm
        syrk = blas.ssyrk if single else blas.dsyrk
        pending: dict[int, Block] = {}
        for number, box in enumerate(self._boxes):
            s, b = len(box.eliminated), len(box.border)
            pivot, below = self._columns_of(box)
            pivot[:] = 0.0
            below[:] = 0.0
            schur = np.zeros((b, b), dtype, order="F")
            if box.children:
                for child, half in zip(box.children, box.shape.halves, strict=True):
                    _extend_add(
                        pending.pop(child),
                        half.inner,
                        half.inner_places,
                        half.outer,
                        half.outer_places,
                        pivot,
                        below,
                        schur,
                    )
            else:
                front = self._factor[box.offset : box.offset + s * (s + b)]
                _add_cells(cell_matrices, box.cells, box.shape.places, front, schur)
                _fix(self.fixed, box.eliminated, box.border, pivot, below, schur)
            if s:
                _, info = potrf(pivot, lower=1, clean=0, overwrite_a=1)
                if info != 0:
                    raise IndefiniteTangentError
                if b:
                    trsm(1.0, pivot, below, side=1, lower=1, trans_a=1, overwrite_b=1)
                    schur = syrk(-1.0, below, beta=1.0, c=schur, lower=1, overwrite_c=1)
            pending[number] = schur

    def _columns_of(self, box: _Box) -> tuple[Block, Block]:
        s, b = len(box.eliminated), len(box.border)
        middle = box.offset + s * s
        return (
            self._factor[box.offset : middle].reshape((s, s), order="F"),
            self._factor[middle : middle + b * s].reshape((b, s), order="F"),
        )

    def _build(self, columns: int, rows: int) -> None:
        """Append the boxes of the tree in the order of their elimination."""

        def visit(x0: int, x1: int, y0: int, y1: int) -> int:
            sides = (x0 > 0, x1 < columns, y0 > 0, y1 < rows)
            shape = _shape(x1 - x0, y1 - y0, sides, columns)
            children = []
            if shape.halves:
                if x1 - x0 >= y1 - y0:
                    middle = (x0 + x1) // 2
                    children = [visit(x0, middle, y0, y1), visit(middle, x1, y0, y1)]
                else:
                    middle = (y0 + y1) // 2
                    children = [visit(x0, x1, y0, middle), visit(x0, x1, middle, y1)]
            first = 2 * (y0 * (columns + 1) + x0)
            box = _Box(
                shape,
                tuple(children),
                shape.cells + y0 * columns + x0,
                shape.eliminated + first,
                shape.border + first,
                self._size,
            )
            self._size += len(box.eliminated) * (len(box.eliminated) + len(box.border))
            self._boxes.append(box)
            return len(self._boxes) - 1

        visit(0, columns, 0, rows)


@cache
def _shape(width: int, height: int, sides: tuple[bool, bool, bool, bool], columns: int) -> _Shape:
    """The front of a box of a size, by which of its sides (left, right, below, above) are shared
    with other boxes. Boxes alike in this differ by an offset only.
    """
    y, x = np.mgrid[0 : height + 1, 0 : width + 1]
    shared = (
        (sides[0] & (x == 0))
        | (sides[1] & (x == width))
        | (sides[2] & (y == 0))
        | (sides[3] & (y == height))
    )
    corner = y * (columns + 1) + x
    border = _unknowns(corner[shared])
    none = np.empty(0, dtype=np.int64)
    if max(width, height) <= LEAF_CELLS:
        own = _unknowns(corner[~shared])
        cy, cx = np.mgrid[0:height, 0:width]
        first = (cy * (columns + 1) + cx).ravel()
        above = first + columns + 1
        corners = np.column_stack([first, first + 1, above + 1, above])
        local = _positions(np.concatenate([own, border]), _unknowns(corners.ravel()))
        cells = (cy * columns + cx).ravel()
        places = _places(local.reshape(-1, 8), len(own), len(border))
        return _Shape((), cells, places, own, border)
    left, right, below, above_ = sides
    if width >= height:
        half = width // 2
        parts = [
            _shape(half, height, (left, True, below, above_), columns).border,
            _shape(width - half, height, (True, right, below, above_), columns).border + 2 * half,
        ]
    else:
        half = height // 2
        parts = [
            _shape(width, half, (left, right, below, True), columns).border,
            _shape(width, height - half, (left, right, True, above_), columns).border
            + 2 * half * (columns + 1),
        ]
    eliminated = np.setdiff1d(np.concatenate(parts), border)
    halves = tuple(_half(part, eliminated, border) for part in parts)
    return _Shape(halves, none, none.reshape(0, 36), eliminated, border)


def _unknowns(corners: Indices) -> Indices:
    return (2 * corners[:, None] + np.arange(2)).ravel().astype(np.int64)


def _positions(front: Indices, numbers: Indices) -> Indices:
    order = np.argsort(front)
    return order[np.searchsorted(front, numbers, sorter=order)].astype(np.int64)


def _half(theirs: Indices, eliminated: Indices, border: Indices) -> _Half:
    """How a child's border spreads over its parent's front (all arrays ascending)."""
    is_inner = np.isin(theirs, eliminated, assume_unique=True)
    inner, outer = np.flatnonzero(is_inner), np.flatnonzero(~is_inner)
    return _Half(
        inner,
        np.searchsorted(eliminated, theirs[inner]),
        outer,
        np.searchsorted(border, theirs[outer]),
    )


def _places(local: Indices, s: int, b: int) -> Indices:
    """For each entry (i, j <= i) of each cell, by rows: its place in the columns of the leaf that
    are eliminated (pivot (s, s), then below (b, s), column-major); of the border, -1 - its place.
    """
    i, j = np.tril_indices(8)
    one, other = local[:, i], local[:, j]
    row, column = np.maximum(one, other), np.minimum(one, other)
    in_pivot, in_border = row < s, column >= s
    below = s * s + column * b + row - s
    border = -1 - ((column - s) * b + row - s)
    return np.where(in_pivot, column * s + row, np.where(in_border, border, below))


def _concatenate(arrays: list[Indices]) -> Indices:
    return np.concatenate(arrays).astype(np.int64)


@njit(cache=True)
def _extend_add(
    child: Block,
    inner: Indices,
    inner_places: Indices,
    outer: Indices,
    outer_places: Indices,
    pivot: Block,
    below: Block,
    schur: Block,
) -> None:
    """Add the lower triangle of a child's Schur complement to its parent's front."""
    for c in range(inner.size):
        column, place = inner[c], inner_places[c]
        for r in range(c, inner.size):
            pivot[inner_places[r], place] += child[inner[r], column]
        for r in range(outer.size):
            row = outer[r]
            below[outer_places[r], place] += child[max(row, column), min(row, column)]
    for c in range(outer.size):
        column, place = outer[c], outer_places[c]
        for r in range(c, outer.size):
            schur[outer_places[r], place] += child[outer[r], column]


@njit(cache=True)
def _add_cells(
    matrices: Array, cells: Indices, places: Indices, front: Block, schur: Block
) -> None:
    """Add the lower triangles of cell matrices to a leaf: its columns in the factor, its border."""
    border = schur.shape[0]
    for n in range(cells.size):
        k = 0
        for i in range(8):
            for j in range(i + 1):
                place = places[n, k]
                value = matrices[cells[n], i, j]
                if place >= 0:
                    front[place] += value
                else:
                    schur[(-place - 1) % border, (-place - 1) // border] += value
                k += 1


@njit(cache=True)
def _fix(
    fixed: NDArray[np.bool_],
    eliminated: Indices,
    border: Indices,
    pivot: Block,
    below: Block,
    schur: Block,
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


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def _forward(
    factor: Block, tree: Indices, eliminated: Indices, border: Indices, v: Block, x: Block
) -> None:
    """Forward substitution in place; ``v`` has room for the unknowns of one front."""
    e0 = b0 = 0
    for box in range(tree.shape[0]):
        offset, s, b = tree[box]
        below = offset + s * s
        for i in range(s):
            v[i] = x[eliminated[e0 + i]]
        v[s : s + b] = 0.0
        for i in range(s):
            column = factor[offset + i * s : offset + i * s + s]
            y = v[i] / column[i]
            v[i] = y
            for r in range(i + 1, s):
                v[r] -= column[r] * y
            column = factor[below + i * b : below + i * b + b]
            for r in range(b):
                v[s + r] -= column[r] * y
        for i in range(s):
            x[eliminated[e0 + i]] = v[i]
        for r in range(b):
            x[border[b0 + r]] += v[s + r]
        e0 += s
        b0 += b


@njit(cache=True, fastmath={"reassoc", "contract", "nsz"})
def _backward(
    factor: Block, tree: Indices, eliminated: Indices, border: Indices, v: Block, x: Block
) -> None:
    """Backward substitution in place."""
    zero = x.dtype.type(0.0)
    e0, b0 = eliminated.size, border.size
    for box in range(tree.shape[0] - 1, -1, -1):
        offset, s, b = tree[box]
        below = offset + s * s
        e0 -= s
        b0 -= b
        for i in range(s):
            v[i] = x[eliminated[e0 + i]]
        for r in range(b):
            v[s + r] = x[border[b0 + r]]
        for i in range(s - 1, -1, -1):
            known = v[s : s + b]
            column = factor[below + i * b : below + i * b + b]
            y = zero
            for r in range(b):
                y += column[r] * known[r]
            known = v[i + 1 : s]
            column = factor[offset + i * s + i + 1 : offset + i * s + s]
            for r in range(s - i - 1):
                y += column[r] * known[r]
            v[i] = (v[i] - y) / factor[offset + i * s + i]
        for i in range(s):
            x[eliminated[e0 + i]] = v[i]
