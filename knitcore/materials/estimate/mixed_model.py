"""A mixed model of logarithmic quantities over yarns, four fabrics and two directions.

    y[yarn, fabric, direction] = mean[fabric, direction] + general[yarn] ± contrast[yarn] + rest

A yarn is generally stiffer or softer than the mean, and more or less so course-wise (+) than
wale-wise (-). With the same cells for all yarns the variances of the three parts follow in closed
form (analysis of variance), and a new yarn's values from any measured cells by best linear unbiased
prediction. Its error variance is that of known means times 1 + 1/yarns, because the means are
averages over as many yarns.

Of several quantities together, variances are matrices, since a fabric that is stiff at first
stiffens later otherwise than a soft one. A point of a stretch curve is one equation between
modulus, alpha and beta; its update is that of an iterated extended Kalman filter, in logarithms.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError
from knitcore.law.stiffening import stiffening

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
class MixedModel:
    """Logarithms of a yarn's fabrics.

    Attributes
    ----------
    mean : (quantities, 4, 2) by quantity, fabric and direction.
    covariance : (cells, cells) of the same, raveled.
    """

    mean: Array
    covariance: Array

    @classmethod
    def fit(cls, values: Array) -> MixedModel:
        """A new yarn's values, from those of known yarns, (yarns, quantities, 4, 2).

        Raises
        ------
        InputError
            If there are fewer than three yarns.
        """
        if len(values) < 3:
            raise InputError("yarns", f"{len(values)} are too few.", "Fit to at least three yarns.")
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
        """Standard deviations (quantities, 4, 2)."""
        variances = np.maximum(np.diag(self.covariance), 0.0)  # rounding, where cells are known
        return np.sqrt(variances).reshape(self.mean.shape)

    def knowing_cells(self, values: Array, measured: Mask) -> MixedModel:
        """Condition the model on measured cells.

        Parameters
        ----------
        values : (quantities, 4, 2), read where measured.
        measured : (4, 2).
        """
        m = np.broadcast_to(measured, self.mean.shape).ravel()
        gain = np.linalg.solve(self.covariance[np.ix_(m, m)], self.covariance[m]).T
        change = gain @ (values - self.mean).ravel()[m]
        covariance = self.covariance - gain @ self.covariance[m]
        return MixedModel(self.mean + change.reshape(self.mean.shape), covariance)

    def knowing(self, points: Sequence[LogStrain]) -> MixedModel:
        """Condition the model on points of stretch curves; quantities are those of the law."""
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
        return MixedModel(state.reshape(self.mean.shape), covariance)

    def log_strain(
        self, fabric: int, direction: int, stress_n_per_mm: float
    ) -> tuple[float, float]:
        """Logarithm of the strain under a stress, and its standard deviation."""
        point = LogStrain(fabric, direction, stress_n_per_mm, 0.0, 0.0)
        value, slopes = self._linear(self.mean.ravel(), [point])
        return float(value[0]), math.sqrt(float((slopes @ self.covariance @ slopes.T)[0, 0]))

    def _linear(self, state: Array, points: Sequence[LogStrain]) -> tuple[Array, Array]:
        """Logarithms of strains (points,), and their derivatives (points, 24)."""
        values, slopes = np.zeros(len(points)), np.zeros((len(points), *self.mean.shape))
        for i, point in enumerate(points):
            cell = state.reshape(self.mean.shape)[:, point.fabric, point.direction]
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


def leave_one_out(values: Array, measured: Mask) -> tuple[Array, Array]:
    """Predict each yarn from the others and its own measured cells.

    Returns
    -------
    (predictions, standard deviations), each (yarns, 4, 2).
    """
    models = [
        MixedModel.fit(np.delete(values, i, axis=0)[:, None]).knowing_cells(row[None], measured)
        for i, row in enumerate(values)
    ]
    return np.array([m.mean[0] for m in models]), np.array([m.deviation[0] for m in models])


def interval_factor(values: Array, measured: Mask, coverage: float) -> float:
    """Standard deviations that an interval needs to cover this share of left-out values.

    The quantile of the left-out yarns' standardised errors: it holds whatever their distribution.
    """
    predictions, deviations = leave_one_out(values, measured)
    errors = np.abs(values - predictions)[:, ~measured] / deviations[:, ~measured]
    return covering(errors, coverage)


def covering(errors: Array, coverage: float) -> float:
    """Size of error that a new one exceeds no more often than this share allows.

    With n errors known, the new one is as likely to fall into each of the n + 1 gaps, so the
    quantile is that of ``coverage (n + 1) / n`` (split conformal prediction).
    """
    return float(np.quantile(errors, min(1.0, coverage * (1 + 1 / errors.size))))
