"""Modulus, alpha and beta of all fabrics together, and what points of a stretch curve say of them.

The mixed model of :mod:`knitcore.materials.estimate.mixed_model` with the three quantities of the
law at once: its variances become matrices (3, 3), since a fabric that is stiff at first stiffens
later otherwise than a soft one. A point of a stretch curve is one equation between the three; its
update is that of an iterated extended Kalman filter, in logarithms.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.law.stiffening import stiffening

QUANTITY_COUNT = 3
_SHAPE = (QUANTITY_COUNT, 4, 2)
_CELLS = 8
_SIGNS = np.tile([1.0, -1.0], 4)
_HALVINGS = 60
_STEPS = 30


@dataclass(frozen=True)
class LogStrain:
    """A point of a stretch curve, the width free.

    Attributes
    ----------
    fabric, direction : indices of the cell.
    stress_n_per_mm : force per width.
    value, deviation : logarithm of the strain, and its standard deviation.
    """

    fabric: int
    direction: int
    stress_n_per_mm: float
    value: float
    deviation: float


@dataclass(frozen=True, eq=False)
class JointModel:
    """Logarithms of modulus, alpha and beta of a yarn's fabrics.

    Attributes
    ----------
    mean : (3, 4, 2) by quantity, fabric and direction.
    covariance : (24, 24) of the same, raveled.
    """

    mean: Array
    covariance: Array

    @classmethod
    def fit(cls, values: Array) -> JointModel:
        """A new yarn's values, from those of known yarns, (yarns, 3, 4, 2)."""
        freedom, mean = len(values) - 1, values.mean(axis=0)
        deviation = values - mean
        general = deviation.mean(axis=(2, 3))
        contrast = (deviation[..., 0] - deviation[..., 1]).mean(axis=2) / 2
        rest = deviation - general[..., None, None] - contrast[..., None, None] * _SIGNS[:2]
        rests = np.einsum("nqfd,npfd->qp", rest, rest) / (freedom * (_CELLS - 2))
        shared, opposed = (
            _positive(part.T @ part / freedom - rests / _CELLS) for part in (general, contrast)
        )
        total = (
            np.kron(shared, np.ones((_CELLS, _CELLS)))
            + np.kron(opposed, np.outer(_SIGNS, _SIGNS))
            + np.kron(rests, np.eye(_CELLS))
        )
        return cls(mean, total * (1 + 1 / len(values)))

    @property
    def deviation(self) -> Array:
        """Standard deviations (3, 4, 2)."""
        return np.sqrt(np.diag(self.covariance)).reshape(_SHAPE)

    def knowing(self, points: Sequence[LogStrain]) -> JointModel:
        """Condition the model on points of stretch curves."""
        if not points:
            return self
        start: Array = self.mean.ravel()
        noise = np.diag([point.deviation**2 for point in points])
        measured = np.array([point.value for point in points])
        state: Array = start
        gain: Array = np.zeros((len(start), len(points)))
        slopes: Array = np.zeros((len(points), len(start)))
        for step in range(_STEPS):
            expected, slopes = self._linear(state, points)
            spread = slopes @ self.covariance @ slopes.T + noise
            gain = np.asarray(np.linalg.solve(spread, slopes @ self.covariance).T, dtype=float)
            new = start + gain @ (measured - expected - slopes @ (start - state))
            change = new - state
            state = state + (change if step < 8 else 0.5 * change)
            if np.abs(change).max() < 1e-7:
                break
        covariance = self.covariance - gain @ slopes @ self.covariance
        return replace(self, mean=state.reshape(_SHAPE), covariance=covariance)

    def log_strain(
        self, fabric: int, direction: int, stress_n_per_mm: float
    ) -> tuple[float, float]:
        """Logarithm of the strain under a stress, and its standard deviation."""
        point = LogStrain(fabric, direction, stress_n_per_mm, 0.0, 0.0)
        value, slopes = self._linear(self.mean.ravel(), [point])
        return float(value[0]), math.sqrt(float((slopes @ self.covariance @ slopes.T)[0, 0]))

    @staticmethod
    def _linear(state: Array, points: Sequence[LogStrain]) -> tuple[Array, Array]:
        """Logarithms of strains (points,), and their derivatives (points, 24)."""
        values, slopes = np.zeros(len(points)), np.zeros((len(points), *_SHAPE))
        for i, point in enumerate(points):
            cell = state.reshape(_SHAPE)[:, point.fabric, point.direction]
            values[i], slopes[i, :, point.fabric, point.direction] = _log_strain(
                cell, point.stress_n_per_mm
            )
        return values, slopes.reshape(len(points), -1)


def _log_strain(cell: Array, stress: float) -> tuple[float, Array]:
    """Logarithm of the strain of a law with these logarithms, and its derivatives (3,)."""
    modulus, alpha, beta = np.exp(cell).tolist()
    low, high = 0.0, min(stress / modulus, (1 - 1e-9) / alpha)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        carried = modulus * middle + beta * float(stiffening(alpha * middle)[1])
        low, high = (middle, high) if carried < stress else (low, middle)
    strain = (low + high) / 2
    reach = alpha * strain
    stiffened, rate = (beta * float(value) for value in stiffening(reach)[1:])
    # d strain / d logarithm = - (d stress / d logarithm) / (d stress / d strain)
    slope = modulus * strain + rate * reach
    return math.log(strain), -np.array([modulus * strain, rate * reach, stiffened]) / slope


def _positive(matrix: Array) -> Array:
    """The nearest matrix without negative eigenvalues."""
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)
