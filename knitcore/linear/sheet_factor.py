"""Factors of a sheet's Hessian: multifrontal Cholesky by nested dissection, in single precision.

The sheet is halved along its rows or its columns, each half again. Stitches of one half that touch
those of the other, as neighbours or because the sheet is folded, are cut out: a least vertex cover
of what crosses. Cuts are eliminated after what they part, each as a dense front. General
sparse solvers do not know the sheet, and take several times as long where it is rolled up.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.linear.elimination_order import vertex_cover
from knitcore.linear.front_tree import BlockRows, CornerFront, FrontTree

Ints = NDArray[np.int64]

_LEAF = 40
"""Corners that are not divided any more."""


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

    def __init__(
        self, matrix: scipy.sparse.bsr_matrix, columns: int, *, again: bool = False
    ) -> None:
        pattern = (part.astype(np.int32).tobytes() for part in (matrix.indptr, matrix.indices))
        self._tree = (_tree if again else _tree.__wrapped__)(*pattern, columns)
        self._factor = np.empty(self._tree.entries, np.float32)
        rows = BlockRows(matrix.indptr, matrix.indices, matrix.data)
        if not self._tree.eliminate(rows, self._factor, np.empty(self._tree.work, np.float32)):
            raise np.linalg.LinAlgError("The matrix is not positive definite.")

    def solve(self, right: Array) -> Array:
        """The inverse times a vector, (unknowns,)."""
        return self._tree.solve(self._factor, right)


@lru_cache(maxsize=8)
def _tree(indptr: bytes, indices: bytes, columns: int) -> FrontTree:
    first, near = np.frombuffer(indptr, np.int32), np.frombuffer(indices, np.int32)
    count = len(first) - 1
    touching = scipy.sparse.csr_matrix((np.ones(len(near), bool), near, first), (count, count))
    at = np.stack(np.divmod(np.arange(count), columns))
    fronts: list[CornerFront] = []
    eliminated = np.zeros(count, bool)

    def add(own: Ints, children: tuple[int, ...]) -> int:
        near = touching[own].indices.astype(np.int64)
        parts = [near, *(fronts[child].border for child in children)]
        eliminated[own] = True
        border = np.unique(np.concatenate(parts))
        fronts.append(CornerFront(own, border[~eliminated[border]].astype(np.int64), children))
        return len(fronts) - 1

    def divide(part: Ints) -> int:
        halves = _halved(touching, part, at) if len(part) > _LEAF else None
        if halves is None:
            return add(part, ())
        first_half, second_half, cut = halves
        return add(cut, (divide(first_half), divide(second_half)))

    divide(np.arange(count))
    return FrontTree(fronts, 3)


def _halved(
    touching: scipy.sparse.csr_matrix, part: Ints, at: Ints
) -> tuple[Ints, Ints, Ints] | None:
    """Two parts that do not touch, and the cut between them, along the axis where it is shorter."""
    inside = touching[part][:, part]
    divisions = []
    for place in at[:, part]:
        below = place < np.median(place)
        first, second = np.flatnonzero(below), np.flatnonzero(~below)
        crossing = inside[first][:, second]
        rows, others = np.flatnonzero(np.diff(crossing.indptr)), np.unique(crossing.indices)
        left, right = vertex_cover(crossing[rows][:, others].toarray())
        cut = first[rows[left]], second[others[right]]
        if len(first) > len(cut[0]) and len(second) > len(cut[1]):
            rest = np.setdiff1d(first, cut[0]), np.setdiff1d(second, cut[1])
            divisions.append((part[rest[0]], part[rest[1]], part[np.concatenate(cut)]))
    return min(divisions, key=lambda parts: len(parts[2]), default=None)
