"""Symmetric matrices in square tiles, of which only those that are not zero are kept."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.contact import apart
from knitcore.yarn.kernels.curve_samples import control_of
from knitcore.yarn.kernels.structures import Layout, Pairs


class TiledMatrix(NamedTuple):
    """Lower triangle of a symmetric matrix in tiles.

    Attributes
    ----------
    tiles : (t, s, s) the tiles; those on the diagonal are whole.
    where : (blocks, blocks) which tile holds rows of one block and columns of another, -1 where
        it is zero; used where the row's block is not before the column's.
    unknowns : number of rows; the last block is filled up with zeros.
    """

    tiles: Array
    where: NDArray[np.int32]
    unknowns: int


@compiled
def touching_blocks(  # noqa: PLR0912 - compiled: spans, then pairs
    at: Array, course_mm: float, wale_mm: float, pairs: Pairs, layout: Layout, size: int,
    reach: float,
) -> NDArray[np.bool_]:  # fmt: skip
    """(blocks, blocks) whether unknowns of two blocks of ``size`` are coupled.

    ``at`` are the samples as :func:`~knitcore.yarn.kernels.curve_samples.laid_out` gives them;
    pairs nearer than ``reach`` count.
    """
    per_span = layout.basis.shape[1]
    samples = layout.place.shape[0]
    count = samples // per_span
    local = layout.unknowns - 2
    blocks = (local + size - 1) // size
    most = 18
    spans = np.full((layout.rows * count, most), -1, np.int64)
    counts = np.zeros(layout.rows * count, np.int64)
    for row in range(layout.rows):
        for span in range(count):
            s = row * count + span
            for a in range(6):
                c, _ = control_of(span, a, count, 1)
                for m in range(3):
                    if layout.sign[row, c, m] == 0.0:
                        continue
                    b = layout.dof[row, c, m] // size
                    new = True
                    for q in range(counts[s]):
                        new = new and spans[s, q] != b
                    if new:
                        spans[s, counts[s]] = b
                        counts[s] += 1
    out = np.zeros((blocks, blocks), np.bool_)
    for s in range(spans.shape[0]):
        for p in range(counts[s]):
            for q in range(counts[s]):
                out[spans[s, p], spans[s, q]] = True
    square = reach * reach
    for k in range(pairs.shape[0]):
        dx, dy, dz = apart(at, pairs, k, layout, course_mm, wale_mm)
        if dx * dx + dy * dy + dz * dz >= square:
            continue
        s, t = pairs[k, 0] // per_span, pairs[k, 1] // per_span
        for p in range(counts[s]):
            for q in range(counts[t]):
                out[spans[s, p], spans[t, q]] = True
                out[spans[t, q], spans[s, p]] = True
    return out


def empty_tiles(touching: NDArray[np.bool_], size: int, unknowns: int) -> TiledMatrix:
    """A matrix of zeros with tiles where blocks touch."""
    lower = np.tril(touching)
    where = np.full(touching.shape, -1, np.int32)
    count = int(lower.sum())
    where[lower] = np.arange(count)
    return TiledMatrix(np.zeros((count, size, size)), where, unknowns)


def one_tile(unknowns: int) -> TiledMatrix:
    """A dense matrix of zeros."""
    return TiledMatrix(
        np.zeros((1, unknowns, unknowns)), np.zeros((1, 1), np.int32), unknowns
    )  # fmt: skip


@compiled
def tiled_product(tiles: Array, where: NDArray[np.int32], vector: Array) -> Array:
    """Matrix times vector."""
    size = tiles.shape[1]
    out = np.zeros(where.shape[0] * size)
    padded = np.zeros(where.shape[0] * size)
    for u in range(vector.shape[0]):
        padded[u] = vector[u]
    for a in range(where.shape[0]):
        for b in range(a + 1):
            t = where[a, b]
            if t < 0:
                continue
            for m in range(size):
                total = 0.0
                x = padded[a * size + m]
                for n in range(size):
                    total += tiles[t, m, n] * padded[b * size + n]
                    if a != b:
                        out[b * size + n] += tiles[t, m, n] * x
                out[a * size + m] += total
    return out[: vector.shape[0]]
