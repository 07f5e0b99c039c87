"""Linear systems of a Newton step: the damped Hessian under the prescribed lengths.

A dense factor serves small cells, a sparse one large ones. The penalty of the lengths, which would
couple a whole course, is left out of the sparse matrix: it is the same for all steps that lead to
the prescribed lengths.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import blas, lapack

from knitcore.arrays import Array
from knitcore.compiled import compiled
from knitcore.yarnlevel.energy import Slope
from knitcore.yarnlevel.fronts import Front, FrontalFactor, Room
from knitcore.yarnlevel.kernels import one_tile


class System(ABC):
    """The linear system of a step.

    Parameters
    ----------
    slope : derivatives where the step begins.
    penalty : stiffness of the constraints in the merit, N/mm.
    free : (unknowns,) which of them the step determines; the others are prescribed sizes.
    """

    def __init__(self, slope: Slope, penalty: float, free: NDArray[np.bool_]) -> None:
        self._penalty = penalty
        self._free = free
        self._held = np.flatnonzero(~free)
        self._damping = 0.0
        self._by_tension: Array | None = None

    def factorise(self, damping: float) -> bool:
        """Factor of the damped matrix; False where it is not positive definite."""
        self._damping = damping
        self._by_tension = None
        return self._factorised(damping)

    @abstractmethod
    def _factorised(self, damping: float) -> bool:
        """See ``factorise``."""

    @abstractmethod
    def _through_factor(self, right: Array) -> Array:
        """The damped matrix's inverse times the columns given (free unknowns, k)."""

    @abstractmethod
    def _times(self, step: Array) -> Array:
        """The Hessian of the merit times a step."""

    @abstractmethod
    def _downhill_gradient(self, slope: Slope, excess: Array, remaining: Array) -> Array:
        """Gradient of what the step minimises, by the free unknowns."""

    def softest(self, start: Array | None, iterations: int) -> tuple[float, Array]:
        """Lowest curvature of the undamped matrix, and its direction with greatest component 1.

        Inverse iteration from ``start`` (free unknowns), or from a shape without symmetry.
        """
        count = np.count_nonzero(self._free)
        v = np.cos(np.arange(count) ** 2.0) if start is None or len(start) != count else start
        for _ in range(iterations):
            v = v / np.linalg.norm(v)
            through = self._through_factor(v[:, None])[:, 0]
            curvature = 1.0 / float(v @ through) - self._damping
            v = through
        return curvature, v / np.abs(v).max()

    def solve(self, slope: Slope, excess: Array, remaining: Array) -> tuple[Array, Array]:
        """Step to the prescribed lengths, and the change of the tensions.

        The response to the tensions is solved for once for each factor: later steps with the same
        factor meet the lengths just as well.
        """
        lengths = slope.lengths[:, self._free]
        missing = excess + slope.lengths[:, self._held] @ remaining
        uphill = self._downhill_gradient(slope, excess, remaining)[:, None]
        if self._by_tension is None:
            both = self._through_factor(np.column_stack([uphill, lengths.T]))
            uphill, self._by_tension = both[:, 0], both[:, 1:]
        else:
            uphill = self._through_factor(uphill)[:, 0]
        schur, missed = lengths @ self._by_tension, missing - lengths @ uphill
        change = np.asarray(np.linalg.solve(schur, missed), dtype=float)
        step = np.empty(len(self._free))
        step[self._free] = -uphill - self._by_tension @ change
        step[self._held] = remaining
        return step, change

    def mending(self, lengths: Array, excess: Array) -> Array:
        """Least step, in the metric of the factor, that takes an excess of the lengths away.

        ``solve`` goes first with each factor.
        """
        assert self._by_tension is not None  # noqa: S101 - see above
        pulls = np.linalg.solve(lengths[:, self._free] @ self._by_tension, excess)
        step = np.zeros(len(self._free))
        step[self._free] = -self._by_tension @ pulls
        return step

    def decrease(self, slope: Slope, step: Array, change: Array, excess: Array) -> float:
        """Decrease of the merit, with the changed tensions, that the quadratic model predicts."""
        bent = float(step @ self._times(step))
        return self._downhill(slope, step, change, excess) - 0.5 * bent

    def decrease_solved(
        self, slope: Slope, step: Array, change: Array, excess: Array, fraction: float
    ) -> float:
        """The same for a fraction of what ``solve`` returned, without a product with the matrix."""
        along = self._downhill(slope, step, change, excess)
        return (1.0 - 0.5 * fraction) * along + 0.5 * self._damping * float(step @ step)

    def _downhill(self, slope: Slope, step: Array, change: Array, excess: Array) -> float:
        by_length = (change + self._penalty * excess) @ (slope.lengths @ step)
        return -float(slope.gradient @ step + by_length)


class DenseSystem(System):
    """With a dense Cholesky factor, in single precision if ``single``."""

    def __init__(self, slope: Slope, penalty: float, free: NDArray[np.bool_], single: bool) -> None:
        super().__init__(slope, penalty, free)
        self._single = single
        assert slope.hessian is not None  # noqa: S101 - a system is made of both derivatives
        # the Hessian of the penalty, added in place (the matrix is symmetric)
        self._hessian = blas.dgemm(
            penalty, slope.lengths, slope.lengths, beta=1.0, c=slope.hessian.T,
            trans_a=True, overwrite_c=True,
        )  # fmt: skip

    def _factorised(self, damping: float) -> bool:
        matrix = self._hessian.T
        if len(self._held):
            matrix = matrix[np.ix_(self._free, self._free)]
        if self._single:
            self._scale = 1.0 / np.sqrt(np.abs(np.diagonal(matrix)) + damping)
            lower = _scaled(matrix, self._scale, damping)
            self._factor, info = lapack.spotrf(lower.T, lower=0, overwrite_a=1, clean=0)
        else:
            damped = matrix.copy()
            damped[np.diag_indices_from(damped)] += damping
            self._factor, info = lapack.dpotrf(damped.T, lower=0, overwrite_a=1, clean=0)
        return int(info) == 0

    def _through_factor(self, right: Array) -> Array:
        """The damped matrix's inverse times the columns given."""
        if self._single:
            scaled, _ = lapack.spotrs(self._factor, right * self._scale[:, None], lower=0)
            return np.asarray(scaled * self._scale[:, None])
        found, _ = lapack.dpotrs(self._factor, right, lower=0)
        return np.asarray(found)

    def _times(self, step: Array) -> Array:
        return np.asarray(self._hessian @ step)

    def _downhill_gradient(self, slope: Slope, excess: Array, remaining: Array) -> Array:
        gradient = slope.gradient[self._free]
        gradient = gradient + (self._penalty * excess) @ slope.lengths[:, self._free]
        if len(self._held):
            gradient = gradient + self._hessian[np.ix_(self._free, self._held)] @ remaining
        return np.asarray(gradient)


class SparseSystem(System):
    """With a sparse factor; the two sizes of a stitch, which touch everything, come last."""

    def __init__(
        self, slope: Slope, penalty: float, free: NDArray[np.bool_], fronts: tuple[Front, ...],
        room: Room,
    ) -> None:  # fmt: skip
        super().__init__(slope, penalty, free)
        assert slope.sparse is not None  # noqa: S101 - see the dense system
        self._hessian = slope.sparse
        self._lengths = slope.lengths
        self._factor = FrontalFactor(slope.sparse.matrix, fronts, room)
        self._sizes = np.flatnonzero(free[-2:])
        self._beside = slope.sparse.sizes[self._sizes, :-2].T

    def _factorised(self, damping: float) -> bool:
        if not self._factor.factorise(damping):
            return False
        if not len(self._sizes):
            return True
        self._through = self._factor.solve(self._beside)
        corner = self._hessian.sizes[np.ix_(self._sizes, self._sizes - 2)]
        corner = corner + damping * np.eye(len(corner))
        self._rest = corner - self._beside.T @ self._through
        return bool(np.all(np.linalg.eigvalsh(self._rest) > 0.0))

    def _through_factor(self, right: Array) -> Array:
        local = self._hessian.sizes.shape[1] - 2
        found = self._factor.solve(right[:local])
        if not len(self._sizes):
            return found
        sizes = np.linalg.solve(self._rest, right[local:] - self._through.T @ right[:local])
        return np.concatenate([found - self._through @ sizes, sizes])

    def keep(self) -> None:
        """Leave the room to others, and free what only another factor, or a predicted decrease,
        would need."""
        self._factor.keep()
        self._hessian = replace(self._hessian, matrix=one_tile(0))

    def _times(self, step: Array) -> Array:
        by_length = self._penalty * (self._lengths @ step)
        return self._hessian.times(step) + by_length @ self._lengths

    def _downhill_gradient(self, slope: Slope, excess: Array, remaining: Array) -> Array:
        gradient = slope.gradient[self._free]
        if len(self._held):
            columns = self._hessian.sizes[self._held - len(self._free) + 2][:, self._free]
            gradient = gradient + remaining @ columns
        return np.asarray(gradient)


@compiled
def _scaled(matrix: Array, scale: Array, damping: float) -> NDArray[np.float32]:
    """Lower triangle, damped and scaled, in single precision; entries above it are arbitrary."""
    n = matrix.shape[0]
    out = np.empty((n, n), np.float32)
    for i in range(n):
        for j in range(i + 1):
            out[i, j] = matrix[i, j] * scale[i] * scale[j]
        out[i, i] += damping * scale[i] * scale[i]
    return out
