"""Gaussian-process regression from computed charts to new ones, with its variance.

The covariance of two charts is that of a linear function of their densities, which depends slightly
on the yarn, plus that of a smooth function with features of many lengths (rational quadratic with
an exponent of 1). Far from every known chart the mean therefore returns to the linear function and
the variance grows. See Rasmussen and Williams, *Gaussian Processes for Machine Learning* (2006),
chapters 2 and 4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Mask


@dataclass(frozen=True)
class KernelSettings:
    """Hyperparameters, for features and yarn numbers in units of their spread.

    Attributes
    ----------
    linear, linear_by_yarn : variance of the linear part, and how much of it follows the yarn.
    smooth, length, yarn_length : variance of the smooth part, and its lengths in both spaces.
    noise : variance that no density explains.
    """

    linear: float
    linear_by_yarn: float
    smooth: float
    length: float
    yarn_length: float
    noise: float


@dataclass(frozen=True, eq=False)
class Samples:
    """Known charts: features (n, features) and yarn numbers (n, numbers) in units of their spread,
    and which of them are pure fabrics (n,), whose values are exact.
    """

    features: Array
    numbers: Array
    pure: Mask

    def __getitem__(self, rows: Mask | NDArray[np.int64]) -> Samples:
        return Samples(self.features[rows], self.numbers[rows], self.pure[rows])


_AT_ONCE = 32
"""Charts whose variance is computed at once: SciPy lets no other thread go on meanwhile."""
_PURE_NOISE = 1e-3
"""Noise of a pure fabric, as a fraction of the noise of others."""


def covariance(settings: KernelSettings, first: Samples, second: Samples) -> Array:
    """(n, m) prior covariance of two sets of charts."""
    from scipy.spatial.distance import cdist

    size = first.features.shape[1]
    linear = settings.linear * (first.features @ second.features.T / size)
    linear *= 1.0 + settings.linear_by_yarn * (first.numbers @ second.numbers.T)
    apart = cdist(first.features, second.features, "sqeuclidean") / size / settings.length**2
    apart += cdist(first.numbers, second.numbers, "sqeuclidean") / settings.yarn_length**2
    return np.asarray(linear + settings.smooth / (1.0 + apart / 2))


def noisy_covariance(settings: KernelSettings, samples: Samples) -> Array:
    """(n, n) prior covariance of observations."""
    matrix = covariance(settings, samples, samples)
    matrix[np.diag_indices_from(matrix)] += settings.noise * np.where(
        samples.pure, _PURE_NOISE, 1.0
    )
    return matrix


@dataclass(frozen=True, eq=False)
class KernelModel:
    """A fitted regression.

    Attributes
    ----------
    settings, samples : hyperparameters and known charts.
    factor : Cholesky factor of the observations' covariance.
    weights : (n, outputs).
    """

    settings: KernelSettings
    samples: Samples
    factor: Array
    weights: Array

    @classmethod
    def fit(cls, settings: KernelSettings, samples: Samples, targets: Array) -> KernelModel:
        """Fit to targets (n, outputs)."""
        from scipy.linalg import cho_solve

        from knitcore.base.threads import one_blas_thread

        matrix = noisy_covariance(settings, samples)
        # NumPy's lets other threads go on meanwhile, SciPy's does not
        with one_blas_thread():
            factor = np.asarray(np.linalg.cholesky(matrix), dtype=float)
            return cls(settings, samples, factor, cho_solve((factor, True), targets))

    def __call__(self, charts: Samples) -> tuple[Array, Array]:
        """Mean (m, outputs), and variance (m,) of an observation in units of each output's own."""
        from scipy.linalg import solve_triangular

        cross = covariance(self.settings, charts, self.samples)
        explained = np.empty(len(cross))
        for begin in range(0, len(cross), _AT_ONCE):
            some = slice(begin, begin + _AT_ONCE)
            reduced = solve_triangular(self.factor, cross[some].T, lower=True, check_finite=False)
            explained[some] = np.einsum("nm,nm->m", reduced, reduced)
        variance = self._prior_variance(charts) - explained + self.settings.noise
        return cross @ self.weights, variance

    def _prior_variance(self, charts: Samples) -> Array:
        size = charts.features.shape[1]
        linear = self.settings.linear * np.einsum("mf,mf->m", charts.features, charts.features)
        by_yarn = np.einsum("mk,mk->m", charts.numbers, charts.numbers)
        linear *= (1.0 + self.settings.linear_by_yarn * by_yarn) / size
        return np.asarray(linear + self.settings.smooth)
