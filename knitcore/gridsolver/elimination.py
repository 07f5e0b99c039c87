"""Compiled elimination and substitution on the tree of a dissected grid.

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


@njit(cache=True, nogil=True)
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


@njit(cache=True, nogil=True)
def eliminate(
    first: int,
    last: int,
    routines: Indices,
    letters: NDArray[np.uint8],
    numbers: NDArray[np.int32],
    scalars: Block,
    boxes: Indices,
    shapes: Indices,
    table: Indices,
    matrices: Array,
    fixed: NDArray[np.bool_],
    eliminated: Indices,
    border: Indices,
    factor: Block,
    work: Block,
) -> bool:
    """Eliminate the boxes from first to last; False if a pivot is not positive definite.

    Parameters
    ----------
    first, last : range of boxes.
    routines, letters : addresses and the letters "LRTN".
    numbers, scalars : room for four integers; 1 and -1.
    boxes : (boxes, 10) offset in the factor, eliminated, border, both children, shape, first cell,
        place in ``work``, starts in ``eliminated`` and ``border``.
    shapes : (shapes, 9) see :func:`knitcore.gridsolver.dissection.GridFactor`.
    table : index lists of the shapes, one after the other.
    matrices : (cells, 36) lower triangles of cell matrices, by rows.
    fixed : prescribed unknowns.
    eliminated, border : unknowns by box.
    factor, work : the factor, and room for the Schur complements that wait.
    """
    for index in range(first, last):
        offset, s, b = boxes[index, 0], boxes[index, 1], boxes[index, 2]
        middle = offset + s * s
        place = boxes[index, 7]
        front = factor[offset : middle + s * b]
        front[:] = 0.0
        pivot = factor[offset:middle].reshape((s, s))
        below = factor[middle : middle + s * b].reshape((s, b))
        schur = work[place : place + b * b].reshape((b, b))
        schur[:] = 0.0
        shape = shapes[boxes[index, 5]]
        if boxes[index, 3] >= 0:
            for side in range(2):
                child = boxes[index, 3 + side]
                size = boxes[child, 2]
                start = boxes[child, 7]
                at, inner, outer = shape[3 * side], shape[3 * side + 1], shape[3 * side + 2]
                _extend_add(
                    work[start : start + size * size].reshape((size, size)),
                    table[at : at + inner],
                    table[at + inner : at + 2 * inner],
                    table[at + 2 * inner : at + 2 * inner + outer],
                    table[at + 2 * inner + outer : at + 2 * (inner + outer)],
                    pivot,
                    below,
                    schur,
                )
        else:
            at, count = shape[6], shape[7]
            _add_cells(
                matrices,
                boxes[index, 6],
                table[at : at + count],
                table[at + count : at + 37 * count].reshape((count, 36)),
                front,
                schur.ravel(),
            )
            e0, b0 = boxes[index, 8], boxes[index, 9]
            _fix(fixed, eliminated[e0 : e0 + s], border[b0 : b0 + b], pivot, below, schur)
        if not reduce_front(routines, letters, numbers, scalars, offset, s, b, place, factor, work):
            return False
    return True


@njit(cache=True, nogil=True)
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
            pivot[place, inner_places[r]] += child[column, inner[r]]
        for r in range(outer.size):
            row = outer[r]
            below[place, outer_places[r]] += child[min(row, column), max(row, column)]
    for c in range(outer.size):
        column, place = outer[c], outer_places[c]
        for r in range(c, outer.size):
            schur[place, outer_places[r]] += child[column, outer[r]]


@njit(cache=True, nogil=True)
def _add_cells(
    matrices: Array, first: int, cells: Indices, places: Indices, front: Block, schur: Block
) -> None:
    """Add the lower triangles of cell matrices to a leaf: its columns in the factor, its border."""
    for n in range(cells.size):
        matrix = matrices[first + cells[n]]
        for k in range(36):
            place = places[n, k]
            if place >= 0:
                front[place] += matrix[k]
            else:
                schur[-place - 1] += matrix[k]


@njit(cache=True, nogil=True)
def _fix(
    fixed: NDArray[np.bool_],
    eliminated: Indices,
    border: Indices,
    pivot: Block,
    below: Block,
    schur: Block,
) -> None:
    """Replace the rows and columns of fixed unknowns by those of the identity."""
    for i in range(eliminated.size):
        if fixed[eliminated[i]]:
            pivot[i, :] = 0.0
            pivot[:, i] = 0.0
            below[i, :] = 0.0
            pivot[i, i] = 1.0
    for i in range(border.size):
        if fixed[border[i]]:
            below[:, i] = 0.0
            schur[i, :] = 0.0
            schur[:, i] = 0.0
            schur[i, i] = 1.0


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
        e0, b0 = boxes[box, 8], boxes[box, 9]
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
        e0, b0 = boxes[box, 8], boxes[box, 9]
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
