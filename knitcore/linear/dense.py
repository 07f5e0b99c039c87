"""Dense linear algebra that gives the same bits on every processor.

BLAS and LAPACK choose their kernels by the processor, and each adds in an order of its own. Where
a shape is followed over a saddle, or to one of several minima, the last bit can decide which. Here
the order of sums is fixed: every lane of a vector is a sum of its own, so that its width changes
nothing, and no product is fused with a sum.

Matrices are ``[column, row]``, of which only the lower triangle counts: ``a[j, i]`` with i >= j.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled, intrinsic

Floats = NDArray[np.floating]

_BYTES = 64
"""Height of a tile's columns: a vector of the widest processors, several of the others."""
_COLUMNS = 6
"""Columns of a tile, also eliminated together: its sums fit into sixteen registers of 32 bytes."""


def _tile(columns: int) -> Callable[..., None]:
    """A compiled function that subtracts a product from a tile of some columns, 64 bytes high.

    Called with the addresses and strides (in numbers) of the target, of the left and of the right
    factor, the number of products, and any number of the type in question.
    """

    def generate(
        _context: Any, target: Any, step: Any, left: Any, down: Any, right: Any, over: Any,
        count: Any, number: Any,
    ) -> Any:  # fmt: skip
        from llvmlite import ir
        from numba import types

        def code(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            to, stride, a, a_stride, b, b_stride, terms, _ = values
            kind = context.get_value_type(number)
            size = number.bitwidth // 8
            lanes = _BYTES // size
            vector, integer = ir.VectorType(kind, lanes), ir.IntType(64)
            every = ir.Constant(ir.VectorType(ir.IntType(32), lanes), [0] * lanes)

            def constant(value: int) -> Any:
                return ir.Constant(integer, value)

            def at(base: Any, place: Any, what: Any) -> Any:
                address = builder.add(base, builder.mul(place, constant(size)))
                return builder.inttoptr(address, what.as_pointer())

            def loaded(pointer: Any) -> Any:
                value = builder.load(pointer)
                value.align = size
                return value

            places = [at(to, builder.mul(stride, constant(j)), vector) for j in range(columns)]
            first = [loaded(place) for place in places]
            before = builder.block
            loop = builder.append_basic_block("products")
            builder.branch(loop)
            builder.position_at_end(loop)
            k = builder.phi(integer)
            k.add_incoming(constant(0), before)
            sums = []
            for value in first:
                sums.append(builder.phi(vector))
                sums[-1].add_incoming(value, before)
            column = loaded(at(a, builder.mul(k, a_stride), vector))
            for j, total in enumerate(sums):
                place = builder.add(builder.mul(k, b_stride), constant(j))
                single = builder.insert_element(
                    ir.Constant(vector, ir.Undefined), loaded(at(b, place, kind)), constant(0)
                )
                factor = builder.shuffle_vector(single, ir.Constant(vector, ir.Undefined), every)
                first[j] = builder.fsub(total, builder.fmul(column, factor))
                total.add_incoming(first[j], loop)
            following = builder.add(k, constant(1))
            k.add_incoming(following, loop)
            after = builder.append_basic_block("sums")
            builder.cbranch(builder.icmp_signed("<", following, terms), loop, after)
            builder.position_at_end(after)
            for value, pointer in zip(first, places, strict=True):
                builder.store(value, pointer).align = size
            return context.get_dummy_value()

        return types.void(target, step, left, down, right, over, count, number), code

    return intrinsic(generate)


def _lane_sum(_context: Any, first: Any, second: Any, count: Any, number: Any) -> Any:
    """A compiled function that adds the products of two vectors of whole columns, 64 bytes at a
    time: each lane by itself, then halves of the lanes to each other.

    Called with both addresses, how many columns there are, and any number of the type in question.
    """

    from llvmlite import ir

    def code(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        a, b, terms, _ = values
        kind = context.get_value_type(number)
        size = number.bitwidth // 8
        lanes = _BYTES // size
        vector, integer = ir.VectorType(kind, lanes), ir.IntType(64)
        nothing = ir.Constant(vector, [0.0] * lanes)
        before = builder.block
        loop, after = (builder.append_basic_block(name) for name in ("products", "sum"))
        builder.cbranch(builder.icmp_signed(">", terms, integer(0)), loop, after)
        builder.position_at_end(loop)
        k, total = builder.phi(integer), builder.phi(vector)
        parts = []
        for base in (a, b):
            address = builder.add(base, builder.mul(k, integer(_BYTES)))
            parts.append(builder.load(builder.inttoptr(address, vector.as_pointer())))
            parts[-1].align = size
        more = builder.fadd(total, builder.fmul(*parts))
        following = builder.add(k, integer(1))
        for value, initial, later in ((k, integer(0), following), (total, nothing, more)):
            value.add_incoming(initial, before)
            value.add_incoming(later, loop)
        builder.cbranch(builder.icmp_signed("<", following, terms), loop, after)
        builder.position_at_end(after)
        left = builder.phi(vector)
        left.add_incoming(nothing, before)
        left.add_incoming(more, loop)
        while lanes > 1:
            lanes //= 2
            low, high = (
                ir.Constant(ir.VectorType(ir.IntType(32), lanes), [*range(k, k + lanes)])
                for k in (0, lanes)
            )
            halves = (builder.shuffle_vector(left, left, places) for places in (low, high))
            left = builder.fadd(*halves)
        return builder.extract_element(left, ir.IntType(32)(0))

    return number(first, second, count, number), code


_wide, _narrow = _tile(_COLUMNS), _tile(1)
_products: Callable[..., Any] = intrinsic(_lane_sum)


@compiled
def _subtract(
    width: int, to: int, step: int, left: int, down: int, right: int, over: int, terms: int,
    zero: Any,
) -> None:  # fmt: skip
    """Subtract from a tile of ``_COLUMNS`` columns, or of one."""
    if width == 1:
        _narrow(to, step, left, down, right, over, terms, zero)
    else:
        _wide(to, step, left, down, right, over, terms, zero)


@compiled
def subtract_product(target: Floats, left: Floats, right: Floats, lower: bool) -> None:
    """``target[j, i] -= sum_k left[k, i] * right[k, j]``, the terms one by one from k = 0.

    Parameters
    ----------
    target, left, right : (columns, rows), (terms, rows), (terms, columns), rows of memory each.
    lower : whether only i >= j is wanted; entries above may then change, too.
    """
    columns, rows = target.shape
    terms, size = left.shape[0], target.itemsize
    if terms == 0 or columns == 0:
        return
    lanes = _BYTES // size
    whole = rows - rows % lanes
    step, down, over = target.strides[0] // size, left.strides[0] // size, right.strides[0] // size
    to, a, b = target.ctypes.data, left.ctypes.data, right.ctypes.data
    zero = target.dtype.type(0.0)
    # what does not fill a tile is filled up with zeros
    edge = np.zeros((terms if whole < rows else 0, lanes), target.dtype)
    for k in range(edge.shape[0]):
        for i in range(whole, rows):
            edge[k, i - whole] = left[k, i]
    end = np.zeros((_COLUMNS, lanes), target.dtype)
    j = 0
    while j < columns:
        width = _COLUMNS if columns - j >= _COLUMNS else 1
        factor = b + j * size
        for i in range(j - j % lanes if lower else 0, whole, lanes):
            place, column = to + (j * step + i) * size, a + i * size
            _subtract(width, place, step, column, down, factor, over, terms, zero)
        for c in range(width if whole < rows else 0):
            for i in range(whole, rows):
                end[c, i - whole] = target[j + c, i]
        if whole < rows:
            _subtract(
                width, end.ctypes.data, lanes, edge.ctypes.data, lanes, factor, over, terms, zero
            )
        for c in range(width if whole < rows else 0):
            for i in range(whole, rows):
                target[j + c, i] = end[c, i - whole]
        j += width


@compiled
def eliminate(a: Floats) -> bool:
    """Cholesky factor of the first columns of a front, in place; False if not positive definite.

    Parameters
    ----------
    a : (s, s + b) lower triangle of the s columns to eliminate, with the b rows below them.
    """
    count, rows = a.shape
    for first in range(0, count, _COLUMNS):
        last = min(first + _COLUMNS, count)
        subtract_product(
            a[first:last, first:], a[:first, first:], a[:first, first:last], True
        )  # fmt: skip
        for j in range(first, last):
            column = a[j]
            for k in range(first, j):
                other, factor = a[k], a[k, j]
                for i in range(j, rows):
                    column[i] -= other[i] * factor
            pivot = column[j]
            if not pivot > 0.0:  # nor a number that is none
                return False
            scale = a.dtype.type(1.0) / np.sqrt(pivot)
            for i in range(j, rows):
                column[i] *= scale
    return True


@compiled
def _dot(a: Floats, b: Floats) -> float:
    """Sum of products of two contiguous vectors."""
    lanes = _BYTES // a.itemsize
    whole = a.shape[0] // lanes
    total = _products(a.ctypes.data, b.ctypes.data, whole, a.dtype.type(0.0))
    for i in range(whole * lanes, a.shape[0]):
        total += a[i] * b[i]
    return total  # type: ignore[no-any-return] # compiled


@compiled
def forward(a: Floats, x: Floats) -> None:
    """Forward substitution with a front's factor, in place.

    Parameters
    ----------
    a : (s, s + b) what ``eliminate`` left.
    x : (s + b,) right-hand side of the columns; their share is taken from that of the rows below.
    """
    count, rows = a.shape
    whole = count - count % 4
    for j in range(0, whole, 4):
        c0, c1, c2, c3 = a[j], a[j + 1], a[j + 2], a[j + 3]
        x0 = x[j] / c0[j]
        x1 = (x[j + 1] - c0[j + 1] * x0) / c1[j + 1]
        x2 = (x[j + 2] - c0[j + 2] * x0 - c1[j + 2] * x1) / c2[j + 2]
        x3 = (x[j + 3] - c0[j + 3] * x0 - c1[j + 3] * x1 - c2[j + 3] * x2) / c3[j + 3]
        x[j], x[j + 1], x[j + 2], x[j + 3] = x0, x1, x2, x3
        for i in range(j + 4, rows):
            x[i] = x[i] - c0[i] * x0 - c1[i] * x1 - c2[i] * x2 - c3[i] * x3
    for j in range(whole, count):
        column = a[j]
        value = x[j] / column[j]
        x[j] = value
        for i in range(j + 1, rows):
            x[i] -= column[i] * value


@compiled
def backward(a: Floats, x: Floats) -> None:
    """Backward substitution with a front's factor, in place; what lies below is known."""
    for j in range(a.shape[0] - 1, -1, -1):
        column = a[j]
        x[j] = (x[j] - _dot(column[j + 1 :], x[j + 1 :])) / column[j]


@compiled
def substitute(a: Floats, right: Floats) -> None:
    """Solve with a whole factor (n, n) for every row of ``right`` (k, n), in place."""
    for row in right:
        forward(a, row)
        backward(a, row)


@compiled
def solved(matrix: Array, right: Array) -> Array:
    """Solution of a small system by elimination with the largest pivots.

    Parameters
    ----------
    matrix : (n, n), any ``[row, column]``.
    right : (n,)

    Raises
    ------
    ZeroDivisionError
        If the matrix is singular.
    """
    n = right.shape[0]
    a, x = matrix.copy(), right.copy()
    for k in range(n):
        p = k
        for i in range(k + 1, n):
            if abs(a[i, k]) > abs(a[p, k]):
                p = i
        if a[p, k] == 0.0:
            raise ZeroDivisionError
        if p != k:
            for j in range(k, n):
                a[k, j], a[p, j] = a[p, j], a[k, j]
            x[k], x[p] = x[p], x[k]
        for i in range(k + 1, n):
            factor = a[i, k] / a[k, k]
            if factor != 0.0:
                for j in range(k + 1, n):
                    a[i, j] -= factor * a[k, j]
                x[i] -= factor * x[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            x[k] -= a[k, j] * x[j]
        x[k] /= a[k, k]
    return x


@compiled
def _row_products(matrix: Array, vector: Array) -> Array:
    out = np.empty(matrix.shape[0])
    for i in range(matrix.shape[0]):
        out[i] = _dot(matrix[i], vector)
    return out


@compiled
def _matrix_products(a: Array, b: Array) -> Array:
    out = np.zeros((a.shape[0], b.shape[1]))
    for i in range(a.shape[0]):
        for k in range(a.shape[1]):
            for j in range(b.shape[1]):
                out[i, j] += a[i, k] * b[k, j]
    return out


def dot(a: Array, b: Array) -> float:
    """Sum of the products of two vectors (n,)."""
    return float(_dot(np.ascontiguousarray(a), np.ascontiguousarray(b)))


def norm(vector: Array) -> float:
    """Length of a vector (n,)."""
    return float(np.sqrt(dot(vector, vector)))


def times(matrix: Array, vector: Array) -> Array:
    """Product of a matrix (m, n), ``[row, column]``, with a vector (n,)."""
    product: Array = _row_products(np.ascontiguousarray(matrix), np.ascontiguousarray(vector))
    return product


def product(a: Array, b: Array) -> Array:
    """Product of two matrices (m, n) and (n, k), ``[row, column]``."""
    products: Array = _matrix_products(np.ascontiguousarray(a), np.ascontiguousarray(b))
    return products
