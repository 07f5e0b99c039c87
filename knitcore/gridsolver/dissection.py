"""Direct solution on a plain grid: multifrontal Cholesky by nested dissection.

The tangent of a swatch couples the two unknowns of a corner with those of its eight neighbours on
a rectangular grid. Halving the grid again and again (nested dissection) gives the elimination
order with the least fill, and because the grid is known beforehand no ordering has to be searched.
Each box of the tree owns a dense front: the unknowns that only it holds (eliminated here) and
those on its border with other boxes (passed to the parent as a Schur complement). Dense work is
done by LAPACK. For a comparison with general sparse solvers see ``docs/swatch.md``.

The factor serves as a preconditioner of conjugate gradients in double precision, so single
precision is enough for it: half the memory and half the time. Only where single precision cannot
decide whether the matrix is positive definite is it factorised again in double precision.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from knitcore.arrays import Array
from knitcore.gridsolver import elimination
from knitcore.gridsolver.factor import IndefiniteTangentError
from knitcore.gridsolver.numbering import corners_of
from knitcore.threads import side_by_side

Block = NDArray[np.floating]
Indices = NDArray[np.int64]

LEAF_CELLS = 8
"""Boxes are not halved below this many cells a side (a flat optimum from 6 to 10)."""


SIDE_BY_SIDE = 500
"""Fewest boxes for which two threads pay off, one for each branch of the tree."""


@dataclass(frozen=True)
class _Half:
    """A child's border in its parent's front: positions there, and where they go, ascending."""

    inner: Indices
    inner_places: Indices  # among the parent's eliminated unknowns
    outer: Indices
    outer_places: Indices  # among the parent's border


@dataclass(frozen=True)
class _Shape:
    """Data shared by boxes of one shape. Index arrays count unknowns (2 per corner) from the
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
    first_cell: int
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
    >>> from knitcore.gridsolver.factor import lower_triangle
    >>> solver = GridFactor(2, 1, np.zeros(12, dtype=bool))
    >>> solver.factorise(np.tile(lower_triangle(np.eye(8)), (2, 1)))
    >>> solver.solve(np.ones(12)).round(2).tolist()[:4]
    [1.0, 1.0, 0.5, 0.5]
    """

    def __init__(self, columns: int, rows: int, fixed: NDArray[np.bool_]) -> None:
        self.unknowns = 2 * (columns + 1) * (rows + 1)
        self.fixed = fixed.copy()
        self._fixed_numbers = np.flatnonzero(fixed)
        self._boxes: list[_Box] = []
        self._size = 0
        self._append(columns, rows, 0, columns, 0, rows)
        self._factor: Block = np.empty(0)
        self._work: Block = np.empty(0)
        self._single = True
        self._flatten()

    @property
    def entries(self) -> int:
        """Stored numbers of the factor."""
        return self._size

    def factorise(self, cell_matrices: Array) -> None:
        """Factorise the sum of symmetric cell matrices.

        They are given as for :class:`~knitcore.gridsolver.factor.Factor`.

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
        self._single = False  # single precision fails here, and would fail again

    def solve(self, right_hand_side: Array) -> Array:
        """Solution (2 * corners,) to the factor's precision; 0 at the fixed unknowns."""
        x = right_hand_side.ravel().astype(self._factor.dtype)
        x[self._fixed_numbers] = 0.0
        count, half = len(self._boxes), self._half_way
        tree = (self._factor, self._table, self._eliminated, self._border)
        v, w = np.empty((2, self._widest), x.dtype)
        if half == 0:
            elimination.forward(0, count, *tree, v, x)
            elimination.backward(0, count, *tree, v, x)
            return x.astype(np.float64)
        # Both branches add to the unknowns of the root, so each has a copy of its own on the way
        # up.
        root, second = self._boxes[-1].eliminated, self._second
        other = x.copy()
        other[root] = 0.0
        side_by_side(
            lambda: elimination.forward(0, half, *tree, v, x),
            lambda: elimination.forward(half, count - 1, *tree, w, other),
        )
        x[root] += other[root]
        x[second] = other[second]
        elimination.forward(count - 1, count, *tree, v, x)
        elimination.backward(count - 1, count, *tree, v, x)
        side_by_side(
            lambda: elimination.backward(0, half, *tree, v, x),
            lambda: elimination.backward(half, count - 1, *tree, w, x),
        )
        return x.astype(np.float64)

    def _eliminate(self, cell_matrices: Array, dtype: np.dtype[np.floating]) -> None:
        if self._factor.dtype != dtype or self._factor.size == 0:
            self._factor = np.empty(self._size, dtype)
            self._work = np.empty(self._work_size, dtype)
        count, half = len(self._boxes), self._half_way
        scalars = np.array([1.0, -1.0], dtype)

        def branch(first: int, last: int) -> bool:
            return bool(
                elimination.eliminate(
                    first,
                    last,
                    elimination.ROUTINES[dtype],
                    elimination.LETTERS,
                    np.zeros(4, np.int32),
                    scalars,
                    self._table,
                    self._shapes,
                    self._lists,
                    cell_matrices,
                    self.fixed,
                    self._eliminated,
                    self._border,
                    self._factor,
                    self._work,
                )
            )

        if half == 0:
            definite = branch(0, count)
        else:
            both = side_by_side(lambda: branch(0, half), lambda: branch(half, count - 1))
            definite = all(both) and branch(count - 1, count)
        if not definite:
            raise IndefiniteTangentError

    def _flatten(self) -> None:
        """The tree as tables, for compiled code."""
        self._eliminated = _concatenate([box.eliminated for box in self._boxes])
        self._border = _concatenate([box.border for box in self._boxes])
        self._table = np.full((len(self._boxes), 10), -1, dtype=np.int64)
        shapes: list[tuple[int, ...]] = []
        lists: list[Indices] = []
        numbers: dict[int, int] = {}
        length = e0 = b0 = 0
        for row, box in zip(self._table, self._boxes, strict=True):
            shape = box.shape
            if id(shape) not in numbers:
                numbers[id(shape)] = len(shapes)
                entry: list[int] = []
                for half in shape.halves:
                    entry += [length, len(half.inner), len(half.outer)]
                    lists += [half.inner, half.inner_places, half.outer, half.outer_places]
                    length += 2 * (len(half.inner) + len(half.outer))
                entry += [0] * (6 - len(entry)) + [length, len(shape.cells)]
                lists += [shape.cells, shape.places.ravel()]
                length += 37 * len(shape.cells)
                shapes.append(tuple(entry))
            s, b = len(box.eliminated), len(box.border)
            row[:3] = box.offset, s, b
            row[3 : 3 + len(box.children)] = box.children
            row[5] = numbers[id(shape)]
            row[6] = box.first_cell
            row[8:] = e0, b0
            e0, b0 = e0 + s, b0 + b
        self._shapes = np.array(shapes, dtype=np.int64)
        self._lists = _concatenate(lists)
        self._widest = int(self._table[:, 1:3].sum(axis=1).max())
        children = self._boxes[-1].children
        self._half_way = children[0] + 1 if len(self._boxes) >= SIDE_BY_SIDE else 0
        self._second = _concatenate(
            [box.eliminated for box in self._boxes[self._half_way : len(self._boxes) - 1]]
        )
        self._work_size = 0
        self._place(len(self._boxes) - 1, 0)

    def _place(self, number: int, base: int) -> None:
        """Give the Schur complement of a box room in the work space: it waits for its parent, and
        below it are those of the boxes around it.
        """
        self._table[number, 7] = base
        base += len(self._boxes[number].border) ** 2
        self._work_size = max(self._work_size, base)
        for child in self._boxes[number].children:
            if number == len(self._boxes) - 1:
                base = self._work_size  # the branches of the root do not share room
            self._place(child, base)
            base += len(self._boxes[child].border) ** 2

    def _append(self, columns: int, rows: int, x0: int, x1: int, y0: int, y1: int) -> int:
        """Append a box of cells after those that it is cut into; its number in this order, that of
        the elimination.
        """
        sides = (x0 > 0, x1 < columns, y0 > 0, y1 < rows)
        shape = _shape(x1 - x0, y1 - y0, sides, columns)
        halves: tuple[tuple[int, int, int, int], ...] = ()
        if shape.halves and x1 - x0 >= y1 - y0:
            middle = (x0 + x1) // 2
            halves = (x0, middle, y0, y1), (middle, x1, y0, y1)
        elif shape.halves:
            middle = (y0 + y1) // 2
            halves = (x0, x1, y0, middle), (x0, x1, middle, y1)
        children = tuple(self._append(columns, rows, *half) for half in halves)
        first = 2 * (y0 * (columns + 1) + x0)
        box = _Box(
            shape,
            children,
            y0 * columns + x0,
            shape.eliminated + first,
            shape.border + first,
            self._size,
        )
        self._size += len(box.eliminated) * (len(box.eliminated) + len(box.border))
        self._boxes.append(box)
        return len(self._boxes) - 1


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
        cells = (cy * columns + cx).ravel()
        corners = np.column_stack(corners_of(cells, columns))
        local = _positions(np.concatenate([own, border]), _unknowns(corners.ravel()))
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
    return np.concatenate([np.empty(0), *arrays]).astype(np.int64)
