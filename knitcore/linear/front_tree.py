"""Cholesky factors on a tree of dense fronts (multifrontal method).

Corners of a grid are eliminated box by box: those that only a box holds, as one dense front with
the corners around it that are eliminated later. What is left for these is added to the front of the
box that the first one is a half of. A tree has thousands of small fronts, so the loops over them
are compiled, and two threads can work on two branches.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.base.threads import side_by_side
from knitcore.linear import dense

Block = NDArray[np.floating]
"""Matrices are views [column, row] of Fortran's order; only lower triangles are kept."""
Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class CornerFront:
    """Corners that are eliminated together, those after them that they touch, and the fronts whose
    remainders are added to this one."""

    own: Indices
    border: Indices
    children: tuple[int, ...]


class BlockRows(NamedTuple):
    """A symmetric matrix by rows of blocks.

    Attributes
    ----------
    starts : (rows + 1,), where each row's blocks begin.
    columns : (count,), the column of each block.
    blocks : (count, n, n)
    """

    starts: NDArray[np.int32]
    columns: NDArray[np.int32]
    blocks: Array


class Order(NamedTuple):
    """An order of elimination as the compiled loops read it.

    Attributes
    ----------
    boxes : (boxes, 8) offset in the factor, eliminated, border, both children (or -1), place in
        the room for remainders, starts in ``own`` and ``border``.
    own, border : unknowns by box, in the order of elimination.
    places : of each unknown of a border in its parent's front.
    rank : of each corner in the order of elimination.
    """

    boxes: Indices
    own: Indices
    border: Indices
    places: Indices
    rank: Indices


class FrontTree:
    """The order of elimination of matrices of one pattern.

    Parameters
    ----------
    fronts : children before their parents; every corner is one front's own.
    size : unknowns of a corner.
    two_threads : whether each works on one of the branches at the root.
    """

    def __init__(self, fronts: list[CornerFront], size: int, *, two_threads: bool = False) -> None:
        order = np.concatenate([front.own for front in fronts])
        rank = np.empty(len(order), np.int64)
        rank[order] = np.arange(len(order))
        borders = [front.border[np.argsort(rank[front.border])] for front in fronts]
        places: list[Indices] = [np.empty(0, np.int64)] * len(fronts)
        for front, border in zip(fronts, borders, strict=True):
            ranks = rank[np.concatenate([front.own, border])]
            for child in front.children:
                places[child] = np.searchsorted(ranks, rank[borders[child]])
        own, border, place = (
            (size * corners[:, None] + np.arange(size)).ravel()
            for corners in (order, np.concatenate(borders), np.concatenate(places))
        )
        s = size * np.array([len(front.own) for front in fronts])
        b = size * np.array([len(border) for border in borders])
        children = np.full((len(fronts), 2), -1)
        for row, front in zip(children, fronts, strict=True):
            row[: len(front.children)] = front.children
        room, self.work = _room(children, b)
        self.entries = int((s * (s + b)).sum())
        offset, own_at, border_at = (np.cumsum(ends) - ends for ends in (s * (s + b), s, b))
        boxes = np.column_stack([offset, s, b, children, room, own_at, border_at])
        self._order = Order(boxes, own, border, place, rank)
        self._widest = int((s + b).max())
        self._half = int(children[-1, 0]) + 1 if two_threads else 0

    def eliminate(self, matrix: BlockRows, factor: Block, work: Block) -> bool:
        """Factorise a matrix; False if it is not positive definite in the factor's precision.

        Parameters
        ----------
        matrix : of the pattern; an entry counts where its row is eliminated before its column.
        factor, work : (entries,) and (work,), the factor and room for what waits.
        """

        def branch(first: int, last: int) -> bool:
            done: bool = _eliminate(first, last, self._order, matrix, factor, work)
            return done

        root = len(self._order.boxes) - 1
        if self._half == 0:
            return branch(0, root + 1)
        both = side_by_side(lambda: branch(0, self._half), lambda: branch(self._half, root))
        return all(both) and branch(root, root + 1)

    def solve(self, factor: Block, right: Array) -> Array:
        """The inverse times a vector, (unknowns,), to the factor's precision."""
        x = right.ravel().astype(factor.dtype)
        order, half = self._order, self._half
        root = len(order.boxes) - 1
        v, w = np.empty((2, self._widest), x.dtype)
        if half == 0:
            _forward(0, root + 1, order, factor, v, x)
            _backward(0, root + 1, order, factor, v, x)
            return x.astype(np.float64)
        # Both branches add to the unknowns of the root, so each has a copy of its own on the way
        # up.
        second, top = np.split(order.own[order.boxes[half, 6] :], [-order.boxes[root, 1]])
        other = x.copy()
        other[top] = 0.0
        side_by_side(
            lambda: _forward(0, half, order, factor, v, x),
            lambda: _forward(half, root, order, factor, w, other),
        )
        x[top] += other[top]
        x[second] = other[second]
        _forward(root, root + 1, order, factor, v, x)
        _backward(root, root + 1, order, factor, v, x)
        side_by_side(
            lambda: _backward(0, half, order, factor, v, x),
            lambda: _backward(half, root, order, factor, w, x),
        )
        return x.astype(np.float64)


def _room(children: Indices, border: Indices) -> tuple[Indices, int]:
    """Where the remainder of each front waits for its parent, and how much room all need.

    The first child's waits while the second branch is eliminated; below it is used again. The
    branches of the root do not share room, so that two threads can work on them.
    """
    own = border**2
    extent = own.copy()
    for k, (first, second) in enumerate(children):
        if first >= 0:
            extent[k] += max(extent[first], own[first] + extent[second])
    room = np.zeros(len(own), np.int64)
    root = len(own) - 1
    for k in range(root, -1, -1):
        first, second = children[k]
        if first >= 0:
            room[first] = room[k] + own[k]
            room[second] = room[first] + (extent if k == root else own)[first]
    return room, int((room + extent).max())


@compiled
def _eliminate(
    first: int, last: int, order: Order, matrix: BlockRows, factor: Block, work: Block
) -> bool:
    """Eliminate the boxes from first to last; False if a pivot is not positive definite."""
    boxes, own, border, places, rank = order
    n = matrix.blocks.shape[1]
    at = np.empty(len(rank), np.int64)  # of corners in the front
    for box in range(first, last):
        offset, s, b, room = boxes[box, 0], boxes[box, 1], boxes[box, 2], boxes[box, 5]
        e0, b0 = boxes[box, 6], boxes[box, 7]
        for k in range(0, s, n):
            at[own[e0 + k] // n] = k
        for k in range(0, b, n):
            at[border[b0 + k] // n] = s + k
        front = factor[offset : offset + s * (s + b)].reshape((s, s + b))
        front[:] = 0.0
        schur = work[room : room + b * b].reshape((b, b))
        schur[:] = 0.0
        _assemble(own[e0 : e0 + s : n], rank, at, matrix, front)
        for side in range(3, 5):
            child = boxes[box, side]
            if child < 0:
                continue
            size, place, start = boxes[child, 2], boxes[child, 5], boxes[child, 7]
            rest = work[place : place + size * size].reshape((size, size))
            _extend(rest, places[start : start + size], front, schur)
        if not dense.eliminate(front):
            return False
        dense.subtract_product(schur[:, :], front[:, s:], front[:, s:], True)
    return True


@compiled
def _assemble(own: Indices, rank: Indices, at: Indices, matrix: BlockRows, front: Block) -> None:
    """Add the matrix between a front's own corners and those that are eliminated later."""
    starts, columns, blocks = matrix
    size = blocks.shape[1]
    for unknown in own:
        i = unknown // size
        for k in range(starts[i], starts[i + 1]):
            j = columns[k]
            if rank[j] < rank[i]:
                continue
            for m in range(size):
                for n in range(m if i == j else 0, size):
                    front[at[i] + m, at[j] + n] += blocks[k, m, n]


@compiled
def _extend(rest: Block, places: Indices, front: Block, schur: Block) -> None:
    """Add what a child leaves, its lower triangle, to its parent's front."""
    s = front.shape[0]
    for c in range(rest.shape[0]):
        column = places[c]
        for r in range(c, rest.shape[0]):
            row = places[r]
            if column < s:
                front[column, row] += rest[c, r]
            else:
                schur[column - s, row - s] += rest[c, r]


@compiled
def _forward(first: int, last: int, order: Order, factor: Block, v: Block, x: Block) -> None:
    """Forward substitution in place; ``v`` has room for the unknowns of one front."""
    boxes, own, border, _, _ = order
    for box in range(first, last):
        offset, s, b = boxes[box, 0], boxes[box, 1], boxes[box, 2]
        e0, b0 = boxes[box, 6], boxes[box, 7]
        for i in range(s):
            v[i] = x[own[e0 + i]]
        v[s : s + b] = 0.0
        dense.forward(factor[offset : offset + s * (s + b)].reshape((s, s + b)), v[: s + b])
        for i in range(s):
            x[own[e0 + i]] = v[i]
        for r in range(b):
            x[border[b0 + r]] += v[s + r]


@compiled
def _backward(first: int, last: int, order: Order, factor: Block, v: Block, x: Block) -> None:
    """Backward substitution in place."""
    boxes, own, border, _, _ = order
    for box in range(last - 1, first - 1, -1):
        offset, s, b = boxes[box, 0], boxes[box, 1], boxes[box, 2]
        e0, b0 = boxes[box, 6], boxes[box, 7]
        for i in range(s):
            v[i] = x[own[e0 + i]]
        for r in range(b):
            v[s + r] = x[border[b0 + r]]
        dense.backward(factor[offset : offset + s * (s + b)].reshape((s, s + b)), v[: s + b])
        for i in range(s):
            x[own[e0 + i]] = v[i]
