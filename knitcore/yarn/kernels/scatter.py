"""From samples to unknowns: gradients and Hessian blocks added up."""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.curve_samples import control_of
from knitcore.yarn.kernels.structures import Layout, Pairs


@compiled
def scatter_gradient(force: Array, gradient: Array, layout: Layout) -> Array:
    """Gradient by the unknowns from dE/dx (n or n + 1, 3) and dE/d(d1, d2, d3) (n, 3, 3)."""
    basis, dof, sign, mirror = layout.basis, layout.dof, layout.sign, layout.mirror
    per_span = basis.shape[1]
    samples = layout.place.shape[0]
    count = samples // per_span
    size = layout.unknowns
    out = np.zeros(size)
    for j in range(layout.rows):
        for s in range(samples):
            i = j * samples + s
            span, o = s // per_span, s % per_span
            out[size - 2] += gradient[i, 0, 0]
            for a in range(6):
                c, z_sign = control_of(span, a, count, mirror)
                for m in range(3):
                    value = basis[0, o, a] * force[i, m]
                    for d in range(3):
                        value += basis[d + 1, o, a] * gradient[i, d, m]
                    if m == 2:
                        value *= z_sign
                    out[dof[j, c, m]] += sign[j, c, m] * value
    return out


@compiled
def scatter_local(  # noqa: PLR0912 - loops over a small tensor product
    local: Array,
    position: Array,
    position_speed: Array,
    layout: Layout,
    tiles: Array,
    where: Pairs,
    sizes: Array,
) -> None:
    """Add the Hessian blocks that one sample has with itself to the tiles and the rows of the two
    sizes of a stitch.

    ``local`` (n, 9, 9) in d1, d2, d3; ``position`` (n, 3, 3) in x; ``position_speed`` (n, 3, 3)
    between x (first) and d1 (second).
    """
    basis, dof, sign, mirror = layout.basis, layout.dof, layout.sign, layout.mirror
    per_span = basis.shape[1]
    samples = layout.place.shape[0]
    count = samples // per_span
    size = layout.unknowns
    tile_size = tiles.shape[1]
    block = np.zeros((12, 12))
    half = np.zeros((18, 12))
    full = np.zeros((18, 18))
    index = np.zeros(18, np.int64)
    factor = np.zeros(18)
    for j in range(layout.rows):
        for span in range(count):
            full[:] = 0.0
            for a in range(6):
                c, z_sign = control_of(span, a, count, mirror)
                for m in range(3):
                    index[3 * a + m] = dof[j, c, m]
                    factor[3 * a + m] = sign[j, c, m] * (z_sign if m == 2 else 1.0)
            first = j * samples + span * per_span
            # course size enters d1 of every sample (its effect on x is in the contact)
            total = 0.0
            for i in range(first, first + per_span):
                total += local[i, 0, 0]
            sizes[0, size - 2] += total
            moves = False
            for u in range(18):
                moves = moves or factor[u] != 0.0
            if not moves:  # none of its control points does
                continue
            for o in range(per_span):
                i = first + o
                for m in range(9):
                    for n in range(9):
                        block[3 + m, 3 + n] = local[i, m, n]
                for m in range(3):
                    for n in range(3):
                        block[m, n] = position[i, m, n]
                        block[m, 3 + n] = block[3 + n, m] = position_speed[i, m, n]
                for a in range(6):
                    for m in range(3):
                        for col in range(12):
                            value = 0.0
                            for d in range(4):
                                value += basis[d, o, a] * block[3 * d + m, col]
                            half[3 * a + m, col] = value
                for row in range(18):
                    for b in range(6):
                        for n in range(3):
                            value = 0.0
                            for d in range(4):
                                value += basis[d, o, b] * half[row, 3 * d + n]
                            full[row, 3 * b + n] += value
                for a in range(6):
                    for m in range(3):
                        value = factor[3 * a + m] * (
                            basis[1, o, a] * local[i, m, 0]
                            + basis[2, o, a] * local[i, 3 + m, 0]
                            + basis[3, o, a] * local[i, 6 + m, 0]
                        )
                        sizes[0, index[3 * a + m]] += value
            for row in range(18):
                block1, o1 = index[row] // tile_size, index[row] % tile_size
                for col in range(18):
                    block2, o2 = index[col] // tile_size, index[col] % tile_size
                    if block1 >= block2:
                        tiles[where[block1, block2], o1, o2] += (
                            factor[row] * factor[col] * full[row, col]
                        )
