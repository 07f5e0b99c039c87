"""Couplings of samples with each other, summed up by spans before they go into a large matrix.

Samples of a span share their control points. So the couplings of a sample are gathered by the
control points of the others, then by those of its own span, and then written into the tiles.
"""

from typing import NamedTuple

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.curve_samples import control_of
from knitcore.yarn.kernels.structures import Ints, Layout, Pairs


class Couplings(NamedTuple):
    """Couplings of a span with the control points that touch it.

    Attributes
    ----------
    slot : (controls,) where a control point has its sums, or -1.
    touched : (controls,) which control point each slot belongs to.
    by_sample : (controls, 18) of one sample: rows by its position, then those by its speed.
    by_controls : (controls, 6, 9) of the span.
    """

    slot: Ints
    touched: Ints
    by_sample: Array
    by_controls: Array


@compiled
def no_couplings(layout: Layout) -> Couplings:
    """Room for the couplings of a span."""
    controls = layout.dof.shape[0] * layout.dof.shape[1]
    slot = np.full(controls, -1, np.int64)
    touched = np.empty(controls, np.int64)
    return Couplings(slot, touched, np.zeros((controls, 18)), np.zeros((controls, 6, 9)))


@compiled
def couple(
    couplings: Couplings, filled: int, o: int, others: Ints, columns: Array, layout: Layout
) -> int:
    """Add what couples sample ``o`` of a span with others; returns how many slots are filled then.

    ``columns`` (others, 2, 18) belong to the positions and speeds of the others.
    """
    basis, slot, touched = layout.basis, couplings.slot, couplings.touched
    samples, per_span = layout.place.shape[0], basis.shape[1]
    count = samples // per_span
    for k in range(others.shape[0]):
        row_j = others[k] // samples
        span_j = (others[k] % samples) // per_span
        o_j = (others[k] % samples) % per_span
        of_position, of_speed = columns[k, 0], columns[k, 1]
        for b in range(6):
            c, z_sign = control_of(span_j, b, count, layout.mirror)
            c += row_j * count
            if slot[c] < 0:
                slot[c] = filled
                touched[filled] = c
                filled += 1
            b0 = basis[0, o_j, b]
            b1 = basis[1, o_j, b]
            into = couplings.by_sample[slot[c]]
            for m in range(18):
                into[m] += b0 * of_position[m] + b1 * of_speed[m]
            if z_sign < 0.0:
                for m in range(2, 18, 3):
                    into[m] -= 2.0 * (b0 * of_position[m] + b1 * of_speed[m])
    for to in range(filled):
        rows_of = couplings.by_sample[to]
        for a in range(6):
            b0 = basis[0, o, a]
            b1 = basis[1, o, a]
            into = couplings.by_controls[to, a]
            for m in range(9):
                into[m] += b0 * rows_of[m] + b1 * rows_of[9 + m]
        rows_of[:] = 0.0
    return filled


@compiled
def end_span(
    couplings: Couplings, filled: int, row: int, span: int, layout: Layout, tiles: Array,
    where: Pairs,
) -> None:  # fmt: skip
    """Add the couplings of a span to the tiles, where each stands once: see ``mirrored``."""
    dof, sign = layout.dof, layout.sign
    count = layout.place.shape[0] // layout.basis.shape[1]
    tile_size = tiles.shape[1]
    row_block, row_in, row_sign = np.empty(18, np.int64), np.empty(18, np.int64), np.empty(18)
    for a in range(6):
        c, z_sign = control_of(span, a, count, layout.mirror)
        for m in range(3):
            row_block[3 * a + m] = dof[row, c, m] // tile_size
            row_in[3 * a + m] = dof[row, c, m] % tile_size
            row_sign[3 * a + m] = sign[row, c, m] * (z_sign if m == 2 else 1.0)
    for to in range(filled):
        c2 = couplings.touched[to]
        couplings.slot[c2] = -1
        j2, k2 = c2 // count, c2 % count
        by_controls = couplings.by_controls[to]
        for n in range(3):
            s2 = sign[j2, k2, n]
            if s2 == 0.0:
                continue
            block2 = dof[j2, k2, n] // tile_size
            o2 = dof[j2, k2, n] % tile_size
            for q in range(18):
                block1, o1 = row_block[q], row_in[q]
                value = row_sign[q] * s2 * by_controls[q // 3, 3 * (q % 3) + n]
                if block1 >= block2:
                    tiles[where[block1, block2], o1, o2] += value
                else:
                    tiles[where[block2, block1], o2, o1] += value
        by_controls[:] = 0.0


@compiled
def add_transposed(tiles: Array, where: Pairs) -> None:
    """A + A.T in the tiles of the diagonal, once all couplings are there."""
    step = 32  # part by part, as columns are far apart
    for block in range(where.shape[0]):
        matrix = tiles[where[block, block]]
        size = matrix.shape[0]
        for first in range(0, size, step):
            for second in range(0, first + 1, step):
                for i in range(first, min(first + step, size)):
                    for j in range(second, min(second + step, i + 1)):
                        both = matrix[i, j] + matrix[j, i]
                        matrix[i, j] = both
                        matrix[j, i] = both


@compiled
def add_to_sizes(by_position: Array, by_speed: Array, layout: Layout, sizes: Array) -> None:
    """Add to the rows of the two sizes of a stitch what couples them with the samples' positions
    and speeds, (n, 2, 3)."""
    basis, dof, sign = layout.basis, layout.dof, layout.sign
    samples, per_span = layout.place.shape[0], basis.shape[1]
    count = samples // per_span
    for i in range(by_position.shape[0]):
        row_i = i // samples
        span_i = (i % samples) // per_span
        o_i = (i % samples) % per_span
        for a in range(6):
            c, z_sign = control_of(span_i, a, count, layout.mirror)
            b0 = basis[0, o_i, a]
            b1 = basis[1, o_i, a]
            for m in range(3):
                r1 = dof[row_i, c, m]
                s1 = sign[row_i, c, m] * (z_sign if m == 2 else 1.0)
                for g in range(2):
                    value = s1 * (b0 * by_position[i, g, m] + b1 * by_speed[i, g, m])
                    sizes[g, r1] += value
