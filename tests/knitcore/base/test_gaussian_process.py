"""Kernel regression: it passes through exact samples and knows where it knows nothing."""

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from knitcore.base.arrays import Array
from knitcore.base.gaussian_process import KernelModel, KernelSettings, Samples, covariance

SETTINGS = KernelSettings(0.5, 0.1, 1.0, 1.0, 2.0, 0.01)


def samples(count: int, seed: int, *, pure: bool = False) -> Samples:
    draw = np.random.default_rng(seed)
    return Samples(
        draw.standard_normal((count, 5)), draw.standard_normal((count, 2)), np.full(count, pure)
    )


def test_exact_samples_are_met() -> None:
    known = samples(12, 1, pure=True)
    targets = np.sin(known.features[:, :2])
    mean, _ = KernelModel.fit(SETTINGS, known, targets)(known)
    assert mean == pytest.approx(targets, abs=1e-3)


def test_the_variance_is_that_of_the_conditioned_prior() -> None:
    known, new = samples(9, 2), samples(3, 3)
    _, variance = KernelModel.fit(SETTINGS, known, np.zeros((9, 1)))(new)
    cross = covariance(SETTINGS, new, known)
    observed = covariance(SETTINGS, known, known) + SETTINGS.noise * np.eye(9)
    prior = covariance(SETTINGS, new, new)
    expected = np.diag(prior - cross @ np.linalg.inv(observed) @ cross.T) + SETTINGS.noise
    assert variance == pytest.approx(expected)


def test_far_away_the_variance_grows() -> None:
    known = samples(20, 4)
    model = KernelModel.fit(SETTINGS, known, known.features[:, :1])
    near, far = (
        known[np.arange(1)],
        Samples(known.features[:1] + 9, known.numbers[:1], known.pure[:1]),
    )
    assert model(far)[1] > 3 * model(near)[1]


def test_a_fit_keeps_one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    threads: list[int] = []
    factorise = np.linalg.cholesky

    def watched(matrix: Array) -> Array:
        pools = [pool for pool in threadpool_info() if pool["user_api"] == "blas"]
        threads.extend(pool["num_threads"] for pool in pools)
        return factorise(matrix)

    monkeypatch.setattr(np.linalg, "cholesky", watched)
    known = samples(4, 5)
    KernelModel.fit(SETTINGS, known, known.features[:, :1])
    assert set(threads) == {1}
