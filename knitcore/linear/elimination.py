"""Compiled elimination and substitution on a tree of fronts, without Python in between: a tree has
thousands of small fronts, and two threads can work on two of its branches.

Matrices are views [column, row] of Fortran's order; only lower triangles are kept.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.linear import dense

Block = NDArray[np.floating]
Indices = NDArray[np.int64]


@compiled
def eliminate(
    first: int,
    last: int,
    boxes: Indices,
    own: Indices,
    border: Indices,
    places: Indices,
    rank: Indices,
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    blocks: Array,
    factor: Block,
    work: Block,
) -> bool:
    """Eliminate the boxes from first to last; False if a pivot is not positive definite.

    Parameters
    ----------
    first, last : range of boxes.
    boxes : (boxes, 8) offset in the factor, eliminated, border, both children (or -1), place in
        ``work``, starts in ``own`` and ``border``.
    own, border : unknowns by box, in the order of elimination.
    places : of each unknown of a border in its parent's front.
    rank : of each corner in the order of elimination.
    starts, columns, blocks : see :class:`knitcore.linear.front_tree.BlockRows`.
    factor, work : the factor, and room for the remainders that wait.
    """
    n = blocks.shape[1]
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
        _assemble(own[e0 : e0 + s : n], rank, at, starts, columns, blocks, front)
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
def _assemble(
    own: Indices,
    rank: Indices,
    at: Indices,
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    blocks: Array,
    front: Block,
) -> None:
    """Add the matrix between a front's own corners and those that are eliminated later."""
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
def add_cells(
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
            value, one, other = cells[cell, k], places[0, k], places[1, k]
            flat[first + one] += value
            if one != other:
                flat[first + other] += value
    for unknown in range(fixed.size):
        if fixed[unknown]:
            corner, m = divmod(unknown, 2)
            for side in range(9):
                other = near[9 * corner + side]
                if other != corner or side == 4:
                    blocks[9 * corner + side, m, :] = 0.0
                    blocks[9 * other + 8 - side, :, m] = 0.0
            blocks[9 * corner + 4, m, m] = 1.0


@compiled
def forward(
    first: int,
    last: int,
    factor: Block,
    boxes: Indices,
    eliminated: Indices,
    border: Indices,
    v: Block,
    x: Block,
) -> None:
    """Forward substitution in place; ``v`` has room for the unknowns of one front."""
    for box in range(first, last):
        offset, s, b = boxes[box, 0], boxes[box, 1], boxes[box, 2]
        e0, b0 = boxes[box, 6], boxes[box, 7]
        for i in range(s):
            v[i] = x[eliminated[e0 + i]]
        v[s : s + b] = 0.0
        dense.forward(factor[offset : offset + s * (s + b)].reshape((s, s + b)), v[: s + b])
        for i in range(s):
            x[eliminated[e0 + i]] = v[i]
        for r in range(b):
            x[border[b0 + r]] += v[s + r]


@compiled
def backward(
    first: int,
    last: int,
    factor: Block,
    boxes: Indices,
    eliminated: Indices,
    border: Indices,
    v: Block,
    x: Block,
) -> None:
    """Backward substitution in place."""
    for box in range(last - 1, first - 1, -1):
        offset, s, b = boxes[box, 0], boxes[box, 1], boxes[box, 2]
        e0, b0 = boxes[box, 6], boxes[box, 7]
        for i in range(s):
            v[i] = x[eliminated[e0 + i]]
        for r in range(b):
            v[s + r] = x[border[b0 + r]]
        dense.backward(factor[offset : offset + s * (s + b)].reshape((s, s + b)), v[: s + b])
        for i in range(s):
            x[eliminated[e0 + i]] = v[i]
