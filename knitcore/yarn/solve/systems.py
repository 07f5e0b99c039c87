"""Linear systems of a Newton step: the damped Hessian under the prescribed lengths.

A dense factor serves small cells, a sparse one large ones. The penalty of the lengths, which would
couple a whole course, is left out of the sparse matrix: it is the same for all steps that lead to
the prescribed lengths.
"""

from abc import ABC, abstractmethod
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.linear.dense import dot, eliminate, norm, product, solved, substitute, times
from knitcore.yarn.kernels.tiles import one_tile
from knitcore.yarn.model.energy import Slope
from knitcore.yarn.solve.fronts import Front, FrontalFactor, Precision, Room


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

    def softest(
        self, start: Array | None, iterations: int, lengths: Array | None = None
    ) -> tuple[float, Array]:
        """Lowest curvature of the undamped matrix, and its direction with greatest component 1.

        Inverse iteration from ``start`` (free unknowns), or from a shape without symmetry; with
        ``lengths`` (constraints, unknowns) among the directions that keep the constraints.
        """
        rules = None if lengths is None else lengths[:, self._free]
        if rules is not None and self._by_tension is None:
            self._by_tension = self._through_factor(rules.T)
        count = int(np.count_nonzero(self._free))
        v = _without_symmetry(count) if start is None or len(start) != count else start
        for _ in range(iterations):
            v = v / norm(v)
            through = self._through_factor(v[:, None])[:, 0]
            if rules is not None and self._by_tension is not None:
                through -= times(self._by_tension, self._against(rules, times(rules, through)))
            curvature = 1.0 / dot(v, through) - self._damping
            v = through
        return curvature, v / np.abs(v).max()

    def solve(self, slope: Slope, excess: Array, remaining: Array) -> tuple[Array, Array]:
        """Step to the prescribed lengths, and the change of the tensions.

        The response to the tensions is solved for once for each factor: later steps with the same
        factor meet the lengths just as well.
        """
        lengths = slope.lengths[:, self._free]
        missing = excess + times(slope.lengths[:, self._held], remaining)
        uphill = self._downhill_gradient(slope, excess, remaining)[:, None]
        if self._by_tension is None:
            both = self._through_factor(np.column_stack([uphill, lengths.T]))
            uphill, self._by_tension = both[:, 0], both[:, 1:]
        else:
            uphill = self._through_factor(uphill)[:, 0]
        change = self._against(lengths, missing - times(lengths, uphill))
        step = np.empty(len(self._free))
        step[self._free] = -uphill - times(self._by_tension, change)
        step[self._held] = remaining
        return step, change

    def mending(self, lengths: Array, excess: Array) -> Array:
        """Least step, in the metric of the factor, that takes an excess of the lengths away.

        ``solve`` goes first with each factor.
        """
        assert self._by_tension is not None  # noqa: S101 - see above
        pulls = self._against(lengths[:, self._free], excess)
        step = np.zeros(len(self._free))
        step[self._free] = -times(self._by_tension, pulls)
        return step

    def _against(self, lengths: Array, excess: Array) -> Array:
        """Changes of the tensions that take an excess of the lengths away."""
        assert self._by_tension is not None  # noqa: S101 - see above
        pulls: Array = solved(product(lengths, self._by_tension), excess)
        return pulls

    def decrease(self, slope: Slope, step: Array, change: Array, excess: Array) -> float:
        """Decrease of the merit, with the changed tensions, that the quadratic model predicts."""
        bent = dot(step, self._times(step))
        return self._downhill(slope, step, change, excess) - 0.5 * bent

    def decrease_solved(
        self, slope: Slope, step: Array, change: Array, excess: Array, fraction: float
    ) -> float:
        """Decrease for a fraction of what ``solve`` returned, without a product with the matrix."""
        along = self._downhill(slope, step, change, excess)
        return (1.0 - 0.5 * fraction) * along + 0.5 * self._damping * dot(step, step)

    def _downhill(self, slope: Slope, step: Array, change: Array, excess: Array) -> float:
        by_length = dot(change + self._penalty * excess, times(slope.lengths, step))
        return -(dot(slope.gradient, step) + by_length)


class DenseSystem(System):
    """Newton's system with a dense Cholesky factor."""

    def __init__(self, slope: Slope, penalty: float, free: NDArray[np.bool_]) -> None:
        super().__init__(slope, penalty, free)
        assert slope.hessian is not None  # noqa: S101 - a system is made of both derivatives
        self._hessian = slope.hessian
        self._hessian += penalty * product(slope.lengths.T, slope.lengths)

    def _factorised(self, damping: float) -> bool:
        matrix = self._hessian
        if len(self._held):
            matrix = matrix[np.ix_(self._free, self._free)]
        self._factor = np.zeros(matrix.shape)
        self._scale = _scale(matrix, damping, self._factor)
        return bool(eliminate(self._factor))

    def _through_factor(self, right: Array) -> Array:
        """The damped matrix's inverse times the columns given."""
        columns = np.ascontiguousarray(right.T * self._scale)
        substitute(self._factor, columns)
        return np.asarray((columns * self._scale).T)

    def _times(self, step: Array) -> Array:
        return times(self._hessian, step)

    def _downhill_gradient(self, slope: Slope, excess: Array, remaining: Array) -> Array:
        gradient = slope.gradient[self._free]
        gradient = gradient + times(slope.lengths[:, self._free].T, self._penalty * excess)
        if len(self._held):
            gradient = gradient + times(self._hessian[np.ix_(self._free, self._held)], remaining)
        return np.asarray(gradient)


class SparseSystem(System):
    """Newton's system with a sparse factor.

    The two sizes of a stitch, which touch everything, come last.
    """

    def __init__(
        self, slope: Slope, penalty: float, free: NDArray[np.bool_], fronts: tuple[Front, ...],
        room: Room, precision: Precision,
    ) -> None:  # fmt: skip
        super().__init__(slope, penalty, free)
        assert slope.sparse is not None  # noqa: S101 - see the dense system
        self._hessian = slope.sparse
        self._lengths = slope.lengths
        self._factor = FrontalFactor(slope.sparse.matrix, fronts, room, precision)
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
        self._rest = corner - product(self._beside.T, self._through)
        return bool(eliminate(self._rest.copy()))

    def _through_factor(self, right: Array) -> Array:
        local = self._hessian.sizes.shape[1] - 2
        local_part = self._factor.solve(right[:local])
        if not len(self._sizes):
            return local_part
        sizes = right[local:] - product(self._through.T, right[:local])
        sizes = np.stack([solved(self._rest, column) for column in sizes.T], axis=1)
        return np.concatenate([local_part - product(self._through, sizes), sizes])

    def keep(self) -> None:
        """Leave the room to others, and free what only another factor, or a predicted decrease,
        would need."""
        self._factor.keep()
        self._hessian = replace(self._hessian, matrix=one_tile(0))

    def _times(self, step: Array) -> Array:
        by_length = self._penalty * times(self._lengths, step)
        return self._hessian.times(step) + times(self._lengths.T, by_length)

    def _downhill_gradient(self, slope: Slope, excess: Array, remaining: Array) -> Array:
        gradient = slope.gradient[self._free]
        if len(self._held):
            columns = self._hessian.sizes[self._held - len(self._free) + 2][:, self._free]
            gradient = gradient + times(columns.T, remaining)
        return np.asarray(gradient)


def _without_symmetry(count: int) -> Array:
    """A direction (count,) that no symmetry of a fabric leaves unchanged, of exact numbers."""
    squares = np.arange(count, dtype=np.int64) ** 2
    return np.asarray((squares * 16807 % 2147483647) / 1073741823.5 - 1.0)


@compiled
def _scale(matrix: Array, damping: float, out: Array) -> Array:
    """Fill the lower triangle, ``[column, row]``, with the damped matrix scaled to a unit diagonal;
    returns the scale."""
    n = matrix.shape[0]
    scale = np.empty(n)
    for i in range(n):
        scale[i] = 1.0 / np.sqrt(abs(matrix[i, i]) + damping)
    for j in range(n):
        for i in range(j, n):
            out[j, i] = matrix[j, i] * scale[j] * scale[i]
        out[j, j] += damping * scale[j] * scale[j]
    return scale
