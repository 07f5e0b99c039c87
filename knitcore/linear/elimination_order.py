"""Order of elimination by nested dissection: a sheet is cut in two, each half again, cuts last.

What is left of a half never touches the other, so only the cuts fill up. Where folded fabric
touches cannot be known from the chart, so the cuts are found in the pattern itself: its slowest
wave halves it, and a least vertex cover of what crosses the halves is the cut (König's theorem).
"""

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_LEAF = 12
"""Blocks that are not divided any more."""
_SWEEPS = 60
"""Averages over the blocks around, which leave the slowest wave of a pattern."""


def dissected(touching: Bools) -> Ints:
    """Order of elimination of the blocks of a symmetric pattern (blocks, blocks)."""
    return np.concatenate(_parts(touching, np.arange(len(touching))))


def _parts(touching: Bools, of: Ints) -> list[Ints]:
    if len(of) <= _LEAF:
        return [of]
    sub = touching[np.ix_(of, of)]
    halves = [_halved(sub, begin) for begin in (np.arange(len(of), dtype=float), _steps(sub))]
    first, second, cut = min(halves, key=lambda parts: len(parts[2]))
    if not (len(first) and len(second)):
        return [of]
    return [*_parts(touching, of[first]), *_parts(touching, of[second]), of[cut]]


def _halved(touching: Bools, begin: Array) -> tuple[Ints, Ints, Ints]:
    """Two parts of a pattern (n, n) that do not touch, and the cut between them."""
    order = np.argsort(_slowest_wave(touching, begin, _SWEEPS), kind="stable")
    first, second = np.sort(order[: len(order) // 2]), np.sort(order[len(order) // 2 :])
    rows, columns = vertex_cover(touching[np.ix_(first, second)])
    return first[~rows], second[~columns], np.concatenate([first[rows], second[columns]])


def vertex_cover(crossing: Bools) -> tuple[Bools, Bools]:
    """Least set of rows and columns that together hold every True of a matrix."""
    partner = scipy.sparse.csgraph.maximum_bipartite_matching(
        scipy.sparse.csr_array(crossing), perm_type="column"
    )
    matched = partner >= 0
    row_of = np.full(crossing.shape[1], -1)
    row_of[partner[matched]] = np.flatnonzero(matched)
    # alternating paths from the rows without a partner
    rows, columns = ~matched, np.zeros(crossing.shape[1], bool)
    new = rows.copy()
    while new.any():
        reached = crossing[new].any(axis=0) & ~columns
        columns |= reached
        new = np.zeros_like(rows)
        new[row_of[reached & (row_of >= 0)]] = True
        new &= ~rows
        rows |= new
    return ~rows, columns


def _steps(touching: Bools) -> Array:
    """(n,) steps to each block of a pattern from the one farthest from the first."""
    links: Any = scipy.sparse.csr_array(touching)
    farthest = scipy.sparse.csgraph.breadth_first_order(links, 0, return_predecessors=False)[-1]
    steps = scipy.sparse.csgraph.shortest_path(links, "D", unweighted=True, indices=farthest)
    return np.where(np.isfinite(steps), steps, -1.0)


@compiled
def _slowest_wave(touching: Bools, begin: Array, sweeps: int) -> Array:
    """About the Fiedler vector of a pattern (n, n), in arithmetic that is the same everywhere."""
    n = touching.shape[0]
    degree = np.empty(n)
    links = 0.0
    for i in range(n):
        degree[i] = 0.0
        for j in range(n):
            degree[i] += touching[i, j]
        links += degree[i]
    wave, mean = begin.copy(), np.empty(n)
    for _ in range(sweeps):
        centre = 0.0
        for i in range(n):
            centre += degree[i] * wave[i] / links
        for i in range(n):
            total = 0.0
            for j in range(n):
                if touching[i, j]:
                    total += wave[j] - centre
            mean[i] = total / degree[i]
        wave, mean = mean, wave
    return wave
