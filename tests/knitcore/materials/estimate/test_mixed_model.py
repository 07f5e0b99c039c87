"""The mixed model against its definition, made yarns, and the law."""

import math
from itertools import pairwise

import numpy as np
import pytest

from knitcore import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import material
from knitcore.materials.estimate.mixed_model import (
    LogStrain,
    MixedModel,
    interval_factor,
    leave_one_out,
)

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


SIGNS = np.tile([1.0, -1.0], 4)
TOTAL = 0.3 + 0.1 * np.outer(SIGNS, SIGNS) + 0.12 * np.eye(8)
MODEL = MixedModel(np.zeros((1, 4, 2)), TOTAL)


def test_variances_are_recovered_from_many_yarns() -> None:
    model = MixedModel.fit(made(4000, general=0.6, contrast=0.3, rest=0.4)[:, None])
    total = 0.36 + 0.09 * np.outer(SIGNS, SIGNS) + 0.16 * np.eye(8)
    assert model.covariance == pytest.approx(total, rel=0.1)


def test_without_a_swatch_the_prediction_is_the_mean() -> None:
    values = made(8, general=0.6, contrast=0.3, rest=0.4)[:, None]
    model = MixedModel.fit(values)
    known = model.knowing_cells(values[0], NOTHING)
    assert known.mean == pytest.approx(values.mean(axis=0))
    assert known.covariance == pytest.approx(model.covariance)


def test_weights_are_those_of_best_linear_prediction() -> None:
    """Its errors are uncorrelated with what was measured."""
    measured = swatch(0, 2)
    m = measured.ravel()
    units = [MODEL.knowing_cells(unit.reshape(1, 4, 2), measured) for unit in np.eye(8)[m]]
    weights = np.array([known.mean.ravel() for known in units]).T
    assert TOTAL[:, m] - weights @ TOTAL[np.ix_(m, m)] == pytest.approx(np.zeros((8, 4)))


def test_more_swatches_never_widen_the_interval() -> None:
    masks = (NOTHING, swatch(0), swatch(0, 2), swatch(0, 1, 2))
    spreads = [np.diag(MODEL.knowing_cells(MODEL.mean, m).covariance) for m in masks]
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
        MixedModel.fit(np.zeros((2, 1, 4, 2)))


LAW = material("acrylic:published").law(Fabric.STOCKINETTE)
"""Its stiffening has no coupling, as that of the model."""


def laws(yarns: int = 8) -> np.ndarray:
    random = np.random.default_rng(1)
    law = np.log(
        [
            [LAW.modulus(d) for d in Direction],
            [LAW.alpha(d) for d in Direction],
            [LAW.beta(d) for d in Direction],
        ]
    )
    general, rest = random.normal(size=(yarns, 3, 1, 1)), random.normal(size=(yarns, 3, 4, 2))
    return law[:, None, :] + 0.4 * general + 0.2 * rest


def test_strains_are_those_of_the_law_and_their_slopes_are_right() -> None:
    for direction in Direction:
        cell = (0, direction.axis)
        own = np.log([LAW.modulus(direction), LAW.alpha(direction), LAW.beta(direction)])
        mean = laws()[0]
        mean[:, cell[0], cell[1]] = own
        strain, deviation = MixedModel(mean, np.eye(24)).log_strain(*cell, 0.1)
        assert strain == pytest.approx(
            math.log(free_strains_at_stress(LAW, direction, 0.1)), rel=1e-6
        )
        slopes = []
        for i in range(3):
            step = np.zeros((3, 4, 2))
            step[i, cell[0], cell[1]] = 1e-5
            high = MixedModel(mean + step, np.eye(24)).log_strain(*cell, 0.1)[0]
            slopes.append((high - strain) / 1e-5)
        assert deviation == pytest.approx(float(np.linalg.norm(slopes)), rel=1e-3)


def test_a_precise_point_is_met_and_narrows_the_rest() -> None:
    model = MixedModel.fit(laws())
    before = model.log_strain(0, 0, 0.1)
    point = LogStrain(0, 0, 0.1, before[0] + 0.3, 1e-3)
    after = model.knowing([point])
    assert after.log_strain(0, 0, 0.1)[0] == pytest.approx(point.value, abs=1e-4)
    assert (after.deviation <= model.deviation + 1e-12).all()
    softer = after.log_strain(2, 0, 0.1)[0] - model.log_strain(2, 0, 0.1)[0]
    assert 0 < softer < 0.3  # a soft swatch means softer other fabrics, by less
