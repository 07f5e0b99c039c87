"""Compiled elimination and substitution on a tree of fronts.

Dense work is done by LAPACK, called without Python in between: a tree has thousands of small
fronts, and two threads can work on two of its branches without the interpreter lock.

Matrices are views [column, row] of Fortran's order; only lower triangles are kept.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import get_cython_function_address, intrinsic
from numpy.typing import NDArray

from knitcore.arrays import Array
from knitcore.compiled import compiled

Block = NDArray[np.floating]
Indices = NDArray[np.int64]


ROUTINES = {
    np.dtype(dtype): np.array(
        [
            get_cython_function_address("scipy.linalg.cython_lapack", letter + "potrf"),
            get_cython_function_address("scipy.linalg.cython_blas", letter + "trsm"),
            get_cython_function_address("scipy.linalg.cython_blas", letter + "syrk"),
        ],
        dtype=np.int64,
    )
    for letter, dtype in (("s", np.float32), ("d", np.float64))
}
"""Addresses of Cholesky, triangular solution and symmetric update by precision."""

LETTERS = np.frombuffer(b"LRTN", dtype=np.uint8).copy()


def _generate_call(_context: Any, address: Any, arguments: Any) -> Any:
    """Call the routine at an address with a tuple of addresses."""

    def generate(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        parts = [builder.extract_value(values[1], i) for i in range(len(arguments))]
        pointer = ir.IntType(8).as_pointer()
        routine = ir.FunctionType(ir.VoidType(), [pointer] * len(parts)).as_pointer()
        builder.call(
            builder.inttoptr(values[0], routine),
            [builder.inttoptr(part, pointer) for part in parts],
        )
        return context.get_dummy_value()

    return types.void(address, arguments), generate


call: Any = intrinsic(_generate_call)


@compiled
def reduce_front(
    routines: Indices,
    letters: NDArray[np.uint8],
    numbers: NDArray[np.int32],
    scalars: Block,
    offset: int,
    s: int,
    b: int,
    place: int,
    factor: Block,
    work: Block,
) -> bool:
    """Factorise a front in place; False if a pivot is not positive definite.

    Parameters
    ----------
    routines, letters, numbers, scalars : see :func:`eliminate`.
    offset : of the front in ``factor``: s columns to eliminate, then b of their border.
    place : in ``work``, of the (b, b) remainder that the border's product is taken from.
    """
    if s == 0:
        return True
    numbers[0], numbers[1], numbers[2] = s, b, 0
    letter, number, scalar = letters.ctypes.data, numbers.ctypes.data, scalars.ctypes.data
    lower, right, transposed, plain = letter, letter + 1, letter + 2, letter + 3
    s_at, b_at, info_at = number, number + 4, number + 8
    one, minus = scalar, scalar + scalars.itemsize
    pivot = factor.ctypes.data + offset * factor.itemsize
    below = pivot + s * s * factor.itemsize
    schur = work.ctypes.data + place * work.itemsize
    call(routines[0], (lower, s_at, pivot, s_at, info_at))
    if numbers[2] != 0:
        return False
    if b > 0:
        call(
            routines[1],
            (right, lower, transposed, plain, b_at, s_at, one, pivot, s_at, below, b_at),
        )
        call(routines[2], (lower, plain, b_at, s_at, minus, below, b_at, one, schur, b_at))
    return True


@compiled
def eliminate(
    first: int,
    last: int,
    routines: Indices,
    letters: NDArray[np.uint8],
    numbers: NDArray[np.int32],
    scalars: Block,
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
    routines, letters : addresses and the letters "LRTN".
    numbers, scalars : room for four integers; 1 and -1.
    boxes : (boxes, 8) offset in the factor, eliminated, border, both children (or -1), place in
        ``work``, starts in ``own`` and ``border``.
    own, border : unknowns by box, in the order of elimination.
    places : of each unknown of a border in its parent's front.
    rank : of each corner in the order of elimination.
    starts, columns, blocks : see :class:`knitcore.gridsolver.tree.BlockRows`.
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
        front = factor[offset : offset + s * (s + b)]
        front[:] = 0.0
        pivot = front[: s * s].reshape((s, s))
        below = front[s * s :].reshape((s, b))
        schur = work[room : room + b * b].reshape((b, b))
        schur[:] = 0.0
        _assemble(own[e0 : e0 + s : n], rank, at, starts, columns, blocks, pivot, below)
        for side in range(3, 5):
            child = boxes[box, side]
            if child < 0:
                continue
            size, place, start = boxes[child, 2], boxes[child, 5], boxes[child, 7]
            rest = work[place : place + size * size].reshape((size, size))
            _extend(rest, places[start : start + size], pivot, below, schur)
        if not reduce_front(routines, letters, numbers, scalars, offset, s, b, room, factor, work):
            return False
    return True


@compiled
def _assemble(
    own: Indices,
    rank: Indices,
    at: Indices,
    starts: NDArray[np.int32],
    columns: NDArray[np.int32],
    blocks: Array,
    pivot: Block,
    below: Block,
) -> None:
    """Add the matrix between a front's own corners and those that are eliminated later."""
    s, size = pivot.shape[0], blocks.shape[1]
    for unknown in own:
        i = unknown // size
        for k in range(starts[i], starts[i + 1]):
            j = columns[k]
            if rank[j] < rank[i]:
                continue
            for m in range(size):
                for n in range(m if i == j else 0, size):
                    to = at[j] + n
                    if to < s:
                        pivot[at[i] + m, to] += blocks[k, m, n]
                    else:
                        below[at[i] + m, to - s] += blocks[k, m, n]


@compiled
def _extend(rest: Block, places: Indices, pivot: Block, below: Block, schur: Block) -> None:
    """Add what a child leaves, its lower triangle, to its parent's front."""
    s = pivot.shape[0]
    for c in range(rest.shape[0]):
        column = places[c]
        for r in range(c, rest.shape[0]):
            row = places[r]
            if row < s:
                pivot[column, row] += rest[c, r]
            elif column < s:
                below[column, row - s] += rest[c, r]
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


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
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


@njit(cache=True, nogil=True, fastmath={"reassoc", "contract", "nsz"})
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
    zero = x.dtype.type(0.0)
    for box in range(last - 1, first - 1, -1):
        offset, s, b = boxes[box, 0], boxes[box, 1], boxes[box, 2]
        e0, b0 = boxes[box, 6], boxes[box, 7]
        below = offset + s * s
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
