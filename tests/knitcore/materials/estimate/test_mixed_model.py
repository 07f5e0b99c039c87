"""The mixed model against its definition and against made yarns."""

from itertools import pairwise

import numpy as np
import pytest

from knitcore import InputError
from knitcore.materials.estimate.mixed_model import MixedModel, interval_factor, leave_one_out

NOTHING = np.zeros((4, 2), dtype=bool)


def swatch(*fabrics: int) -> np.ndarray:
    mask = NOTHING.copy()
    mask[list(fabrics)] = True
    return mask


def made(yarns: int, *, general: float, contrast: float, rest: float) -> np.ndarray:
    random = np.random.default_rng(0)
    mean = random.normal(size=(4, 2))
    sign = np.array([1.0, -1.0])
    return (
        mean
        + general * random.normal(size=(yarns, 1, 1))
        + contrast * random.normal(size=(yarns, 1, 1)) * sign
        + rest * random.normal(size=(yarns, 4, 2))
    )


def test_variances_are_recovered_from_many_yarns() -> None:
    model = MixedModel.fit(made(4000, general=0.6, contrast=0.3, rest=0.4))
    assert model.general == pytest.approx(0.36, rel=0.1)
    assert model.contrast == pytest.approx(0.09, rel=0.1)
    assert model.rest == pytest.approx(0.16, rel=0.1)


def test_without_a_swatch_the_prediction_is_the_mean() -> None:
    values = made(8, general=0.6, contrast=0.3, rest=0.4)
    model = MixedModel.fit(values)
    prediction, deviation = model.predict(values[0], NOTHING)
    assert prediction == pytest.approx(values.mean(axis=0))
    total = (model.general + model.contrast + model.rest) * (1 + 1 / 8)
    assert deviation == pytest.approx(np.sqrt(total))


def test_weights_are_those_of_best_linear_prediction() -> None:
    """Its errors are uncorrelated with what was measured."""
    model = MixedModel(np.zeros((4, 2)), general=0.3, contrast=0.1, rest=0.12, yarns=8)
    measured = swatch(0, 2)
    weights, _ = model.weights(measured)
    sign = np.tile([1.0, -1.0], 4)
    shared = 0.3 + 0.1 * np.outer(sign, sign)
    total = shared + 0.12 * np.eye(8)
    m = measured.ravel()
    assert shared[:, m] - weights @ total[np.ix_(m, m)] == pytest.approx(np.zeros((8, 4)))


def test_more_swatches_never_widen_the_interval() -> None:
    model = MixedModel(np.zeros((4, 2)), general=0.3, contrast=0.1, rest=0.12, yarns=8)
    spreads = [model.weights(m)[1] for m in (NOTHING, swatch(0), swatch(0, 2), swatch(0, 1, 2))]
    for wider, narrower in pairwise(spreads):
        assert np.all(narrower <= wider + 1e-12)


def test_leaving_out_uses_nothing_of_the_yarn_but_its_swatch() -> None:
    values = made(8, general=0.6, contrast=0.3, rest=0.4)
    changed = values.copy()
    changed[3, 1:] += 100.0
    for mask in (NOTHING, swatch(0)):
        before, after = leave_one_out(values, mask)[0], leave_one_out(changed, mask)[0]
        assert after[3] == pytest.approx(before[3])


def test_the_interval_factor_covers_what_it_was_asked_to() -> None:
    values = made(400, general=0.6, contrast=0.3, rest=0.4)
    assert interval_factor(values, swatch(0), 0.90) == pytest.approx(1.645, abs=0.1)


def test_two_yarns_are_too_few() -> None:
    with pytest.raises(InputError, match="too few"):
        MixedModel.fit(np.zeros((2, 4, 2)))
