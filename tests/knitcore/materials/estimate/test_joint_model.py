"""The joint model against its definition, the law, and the mixed model."""

import math

import numpy as np
import pytest

from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.uniaxial import free_strains_at_stress
from knitcore.materials import material
from knitcore.materials.estimate.joint_model import JointModel, LogStrain
from knitcore.materials.estimate.mixed_model import MixedModel

LAW = material("acrylic:published").law(Fabric.STOCKINETTE)
"""Its stiffening has no coupling, as that of the model."""


def made(yarns: int = 8) -> np.ndarray:
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


def test_each_quantity_alone_is_the_mixed_model() -> None:
    values = made()
    joint = JointModel.fit(values)
    for i in range(3):
        alone = MixedModel.fit(values[:, i])
        total = (alone.general + alone.contrast + alone.rest) * (1 + 1 / 8)
        assert joint.deviation[i] ** 2 == pytest.approx(np.full((4, 2), total), rel=0.1)


def test_strains_are_those_of_the_law_and_their_slopes_are_right() -> None:
    for direction in Direction:
        cell = (0, direction.axis)
        own = np.log([LAW.modulus(direction), LAW.alpha(direction), LAW.beta(direction)])
        mean = made()[0]
        mean[:, cell[0], cell[1]] = own
        strain, deviation = JointModel(mean, np.eye(24)).log_strain(*cell, 0.1)
        assert strain == pytest.approx(
            math.log(free_strains_at_stress(LAW, direction, 0.1)), rel=1e-6
        )
        slopes = []
        for i in range(3):
            step = np.zeros((3, 4, 2))
            step[i, cell[0], cell[1]] = 1e-5
            high = JointModel(mean + step, np.eye(24)).log_strain(*cell, 0.1)[0]
            slopes.append((high - strain) / 1e-5)
        assert deviation == pytest.approx(float(np.linalg.norm(slopes)), rel=1e-3)


def test_a_precise_point_is_met_and_narrows_the_rest() -> None:
    model = JointModel.fit(made())
    before = model.log_strain(0, 0, 0.1)
    point = LogStrain(0, 0, 0.1, before[0] + 0.3, 1e-3)
    after = model.knowing([point])
    assert after.log_strain(0, 0, 0.1)[0] == pytest.approx(point.value, abs=1e-4)
    assert (after.deviation <= model.deviation + 1e-12).all()
    softer = after.log_strain(2, 0, 0.1)[0] - model.log_strain(2, 0, 0.1)[0]
    assert 0 < softer < 0.3  # a soft swatch means softer other fabrics, by less
