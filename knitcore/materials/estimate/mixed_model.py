"""A mixed model of one logarithmic quantity over yarns, four fabrics and two directions.

    y[yarn, fabric, direction] = mean[fabric, direction] + general[yarn] ± contrast[yarn] + rest

A yarn is generally stiffer or softer than the mean, and more or less so course-wise (+) than
wale-wise (-). With the same cells for all yarns the variances of the three parts follow in closed
form (analysis of variance), and a new yarn's values from any measured cells by best linear unbiased
prediction. Its error variance is that of known means times 1 + 1/yarns, because the means are
averages over as many yarns.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError

_SIGNS = np.tile([1.0, -1.0], 4)
_CELLS = 8


@dataclass(frozen=True, eq=False)
class MixedModel:
    """Means and variances.

    Attributes
    ----------
    mean : (4, 2) by fabric and direction.
    general, contrast, rest : variances of the three parts.
    yarns : number of yarns behind it.
    """

    mean: Array
    general: float
    contrast: float
    rest: float
    yarns: int

    @classmethod
    def fit(cls, values: Array) -> MixedModel:
        """Fit to (yarns, 4, 2) values.

        Raises
        ------
        InputError
            If there are fewer than three yarns.
        """
        yarns = len(values)
        if yarns < 3:
            raise InputError("yarns", f"{yarns} are too few.", "Fit to at least three yarns.")
        mean = values.mean(axis=0)
        deviation = values - mean
        general = deviation.mean(axis=(1, 2))
        contrast = (deviation[:, :, 0] - deviation[:, :, 1]).mean(axis=1) / 2
        sign = np.array([1.0, -1.0])
        rest = deviation - general[:, None, None] - contrast[:, None, None] * sign
        freedom = yarns - 1
        variance = float(np.sum(rest**2)) / (freedom * (_CELLS - 2))
        return cls(
            mean=mean,
            general=max(float(np.sum(general**2)) / freedom - variance / _CELLS, 0.0),
            contrast=max(float(np.sum(contrast**2)) / freedom - variance / _CELLS, 0.0),
            rest=variance,
            yarns=yarns,
        )

    def weights(self, measured: Mask) -> tuple[Array, Array]:
        """Weights (8, measured cells) of the measured deviations, and variances (8,) of the errors.

        Parameters
        ----------
        measured : (4, 2) which cells of the new yarn are measured.
        """
        m = measured.ravel()
        shared = self.general + self.contrast * np.outer(_SIGNS, _SIGNS)
        total = shared + self.rest * np.eye(_CELLS)
        known = shared[:, m]
        weights: Array = np.zeros((_CELLS, 0))
        if m.any():
            weights = np.asarray(np.linalg.solve(total[np.ix_(m, m)], known.T).T, dtype=float)
        variance = np.diag(total) - np.sum(weights * known, axis=1)
        return weights, np.asarray(variance * (1 + 1 / self.yarns))

    def predict(self, values: Array, measured: Mask) -> tuple[Array, Array]:
        """All cells of a new yarn and their standard deviations, each (4, 2).

        Parameters
        ----------
        values : (4, 2), read where measured.
        measured : (4, 2).
        """
        weights, variance = self.weights(measured)
        deviation = (values - self.mean)[measured]
        prediction = self.mean + (weights @ deviation).reshape(4, 2)
        return prediction, np.sqrt(variance).reshape(4, 2)


def leave_one_out(values: Array, measured: Mask) -> tuple[Array, Array]:
    """Predict each yarn from the others and its own measured cells.

    Returns
    -------
    (predictions, standard deviations), each (yarns, 4, 2).
    """
    predictions = [
        MixedModel.fit(np.delete(values, i, axis=0)).predict(values[i], measured)
        for i in range(len(values))
    ]
    return np.array([p for p, _ in predictions]), np.array([s for _, s in predictions])


def interval_factor(values: Array, measured: Mask, coverage: float) -> float:
    """Standard deviations that an interval needs to cover this share of left-out values.

    The quantile of the left-out yarns' standardised errors: it holds whatever their distribution.
    """
    predictions, deviations = leave_one_out(values, measured)
    errors = np.abs(values - predictions) / deviations
    return covering(errors[:, ~measured], coverage)


def covering(errors: Array, coverage: float) -> float:
    """Size of error that a new one exceeds no more often than this share allows.

    With n errors known, the new one is as likely to fall into each of the n + 1 gaps, so the
    quantile is that of ``coverage (n + 1) / n`` (split conformal prediction).
    """
    return float(np.quantile(errors, min(1.0, coverage * (1 + 1 / errors.size))))
