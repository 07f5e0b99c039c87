"""Factors of a sheet's Hessian: multifrontal Cholesky by nested dissection, in single precision.

The sheet is halved along its rows or its columns, each half again. Stitches of one half that touch
those of the other, as neighbours or because the sheet is folded, are cut out: a least vertex cover
of what crosses. Cuts are eliminated after what they part, each as a dense front by LAPACK. General
sparse solvers do not know the sheet, and take several times as long where it is rolled up.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.sparse import bsr_matrix, csr_matrix

from knitcore.arrays import Array
from knitcore.gridsolver import elimination
from knitcore.yarnlevel.elimination_order import vertex_cover

Ints = NDArray[np.int64]
Floats = NDArray[np.float32]

_LEAF = 40
"""Corners that are not divided any more."""


@dataclass(frozen=True, eq=False)
class _Front:
    """Corners that are eliminated together, and those after them that they touch, in the order of
    elimination; fronts whose remainders are added to this one."""

    own: Ints
    border: Ints
    children: tuple[int, ...]


class SheetFactor:
    """Cholesky factor of a matrix.

    Parameters
    ----------
    matrix : symmetric, blocks of (3, 3), one for each corner of the sheet.
    columns : corners in a row of the sheet.
    again : whether other matrices have its pattern, too: the order of elimination is then kept.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the matrix is not positive definite in single precision.
    """

    def __init__(self, matrix: bsr_matrix, columns: int, *, again: bool = False) -> None:
        pattern = (part.astype(np.int32).tobytes() for part in (matrix.indptr, matrix.indices))
        fronts = (_fronts if again else _fronts.__wrapped__)(*pattern, columns)
        count = matrix.shape[0] // 3
        order = np.concatenate([front.own for front in fronts])
        rank = np.empty(count, np.int64)
        rank[order] = np.arange(count)
        table, size, work = _table(fronts)
        places = [
            np.searchsorted(rank[np.concatenate([front.own, front.border])], rank[fronts[c].border])
            for front in fronts
            for c in front.children
        ]
        self._boxes = table
        self._own = _unknowns(order)
        self._factor = np.empty(size, np.float32)
        border = np.concatenate([front.border for front in fronts])
        self._border = _unknowns(border)
        single = np.dtype(np.float32)
        if not _eliminate(
            elimination.ROUTINES[single], elimination.LETTERS, np.zeros(4, np.int32),
            np.array([1.0, -1.0], np.float32), table, order, rank,
            border, np.concatenate([np.empty(0, np.int64), *places]), matrix.indptr,
            matrix.indices, matrix.data, self._factor, np.empty(work, np.float32),
        ):  # fmt: skip
            raise np.linalg.LinAlgError("The matrix is not positive definite.")

    def solve(self, right: Array) -> Array:
        """The inverse times a vector, (unknowns,)."""
        x = right.astype(np.float32)
        tree = self._factor, self._boxes, self._own, self._border
        room = np.empty(int(self._boxes[:, 1:3].sum(axis=1).max()), np.float32)
        elimination.forward(0, len(self._boxes), *tree, room, x)
        elimination.backward(0, len(self._boxes), *tree, room, x)
        return x.astype(float)


@lru_cache(maxsize=8)
def _fronts(indptr: bytes, indices: bytes, columns: int) -> list[_Front]:
    first, near = np.frombuffer(indptr, np.int32), np.frombuffer(indices, np.int32)
    count = len(first) - 1
    touching = csr_matrix((np.ones(len(near), bool), near, first), (count, count))
    at = np.stack(np.divmod(np.arange(count), columns))
    fronts: list[_Front] = []
    eliminated = np.zeros(count, bool)

    def add(own: Ints, children: tuple[int, ...]) -> int:
        near = touching[own].indices.astype(np.int64)
        parts = [near, *(fronts[child].border for child in children)]
        eliminated[own] = True
        border = np.unique(np.concatenate(parts))
        fronts.append(_Front(own, border[~eliminated[border]].astype(np.int64), children))
        return len(fronts) - 1

    def divide(part: Ints) -> int:
        halves = _halved(touching, part, at) if len(part) > _LEAF else None
        if halves is None:
            return add(part, ())
        one, two, cut = halves
        return add(cut, (divide(one), divide(two)))

    divide(np.arange(count))
    rank = np.empty(count, np.int64)
    rank[np.concatenate([front.own for front in fronts])] = np.arange(count)
    return [
        _Front(front.own, front.border[np.argsort(rank[front.border])], front.children)
        for front in fronts
    ]


def _halved(touching: csr_matrix, part: Ints, at: Ints) -> tuple[Ints, Ints, Ints] | None:
    """Two parts that do not touch, and the cut between them, along the axis where it is shorter."""
    inside = touching[part][:, part]
    found = []
    for place in at[:, part]:
        first = place < np.median(place)
        one, two = np.flatnonzero(first), np.flatnonzero(~first)
        crossing = inside[one][:, two]
        rows, others = np.flatnonzero(np.diff(crossing.indptr)), np.unique(crossing.indices)
        left, right = vertex_cover(crossing[rows][:, others].toarray())
        cut = one[rows[left]], two[others[right]]
        if len(one) > len(cut[0]) and len(two) > len(cut[1]):
            rest = np.setdiff1d(one, cut[0]), np.setdiff1d(two, cut[1])
            found.append((part[rest[0]], part[rest[1]], part[np.concatenate(cut)]))
    return min(found, key=lambda parts: len(parts[2]), default=None)


def _table(fronts: list[_Front]) -> tuple[Ints, int, int]:
    """The fronts as compiled code takes them, see :func:`knitcore.gridsolver.elimination.eliminate`
    (columns of shapes and cells are not used); sizes of the factor, and of the room for remainders.
    """
    table = np.full((len(fronts), 10), -1, np.int64)
    s = 3 * np.array([len(front.own) for front in fronts])
    b = 3 * np.array([len(front.border) for front in fronts])
    table[:, 1], table[:, 2] = s, b
    for k, ends in ((0, s * (s + b)), (8, s), (9, b)):
        table[:, k] = np.cumsum(ends) - ends
    for row, front in zip(table, fronts, strict=True):
        row[3 : 3 + len(front.children)] = front.children
    room = np.zeros(len(fronts), np.int64)  # where a remainder waits for its parent
    for k in range(len(fronts) - 1, -1, -1):
        base = room[k] + b[k] ** 2
        for child in fronts[k].children:
            room[child] = base
            base += b[child] ** 2
    table[:, 7] = room
    return table, int((s * (s + b)).sum()), int((room + b**2).max())


def _unknowns(corners: Ints) -> Ints:
    return (3 * corners[:, None] + np.arange(3)).ravel()


@njit(cache=True, nogil=True)
def _eliminate(
    routines: Ints,
    letters: NDArray[np.uint8],
    numbers: NDArray[np.int32],
    scalars: Floats,
    boxes: Ints,
    order: Ints,
    rank: Ints,
    border: Ints,
    places: Ints,
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    blocks: Array,
    factor: Floats,
    work: Floats,
) -> bool:
    """Eliminate all fronts; False if a pivot is not positive definite."""
    at = np.empty(len(order), np.int64)  # of corners in the front
    taken = 0
    for box in range(len(boxes)):
        offset, s, b, room = boxes[box, 0], boxes[box, 1], boxes[box, 2], boxes[box, 7]
        own = order[boxes[box, 8] // 3 : (boxes[box, 8] + s) // 3]
        edge = border[boxes[box, 9] // 3 : (boxes[box, 9] + b) // 3]
        for k in range(len(own)):
            at[own[k]] = 3 * k
        for k in range(len(edge)):
            at[edge[k]] = s + 3 * k
        front = factor[offset : offset + s * (s + b)]
        front[:] = 0.0
        pivot = front[: s * s].reshape((s, s))
        below = front[s * s :].reshape((s, b))
        schur = work[room : room + b * b].reshape((b, b))
        schur[:] = 0.0
        _assemble(own, rank, at, starts, columns, blocks, pivot, below)
        for side in range(3, 5):
            child = boxes[box, side]
            if child < 0:
                continue
            size = boxes[child, 2]
            rest = work[boxes[child, 7] : boxes[child, 7] + size * size].reshape((size, size))
            _extend(rest, places[taken : taken + size // 3], pivot, below, schur)
            taken += size // 3
        if not elimination.reduce_front(
            routines, letters, numbers, scalars, offset, s, b, room, factor, work
        ):
            return False
    return True


@njit(cache=True, nogil=True)
def _assemble(
    own: Ints,
    rank: Ints,
    at: Ints,
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    blocks: Array,
    pivot: Floats,
    below: Floats,
) -> None:
    """Add the matrix between a front's own corners and those that are eliminated later."""
    s = pivot.shape[0]
    for i in own:
        for k in range(starts[i], starts[i + 1]):
            j = columns[k]
            if rank[j] < rank[i]:
                continue
            for m in range(3):
                for n in range(m if i == j else 0, 3):
                    to = at[j] + n
                    if to < s:
                        pivot[at[i] + m, to] += blocks[k, m, n]
                    else:
                        below[at[i] + m, to - s] += blocks[k, m, n]


@njit(cache=True, nogil=True)
def _extend(rest: Floats, places: Ints, pivot: Floats, below: Floats, schur: Floats) -> None:
    """Add what a child leaves, its lower triangle, to its parent's front."""
    s = pivot.shape[0]
    for c in range(rest.shape[0]):
        column = 3 * places[c // 3] + c % 3
        for r in range(c, rest.shape[0]):
            row = 3 * places[r // 3] + r % 3
            if row < s:
                pivot[column, row] += rest[c, r]
            elif column < s:
                below[column, row - s] += rest[c, r]
            else:
                schur[column - s, row - s] += rest[c, r]
