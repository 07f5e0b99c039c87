"""A measured bias strip, whose data are no part of the product."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.bias_strip import graded


def test_one_shear_modulus_has_a_bias_strips_force_up_to_10_percent_only(study_data: Path) -> None:
    """Jersey needs a shear modulus of a quarter to two thirds of the mean of Young's moduli, and
    one that grows: with a constant one the force at 30 % is less than half of the measured one.
    """
    test = graded(study_data / "graded", poisson=0.3)
    ratio = test.matching_ratio(100.0)
    assert 0.25 < ratio < 0.67
    forces = np.array(test.bias_force(ratio, 100.0, np.array([0.05, 0.1, 0.3])))
    measured = test.force_n[[0, 1, 3]]
    assert forces[:2] == pytest.approx(measured[:2], rel=0.1)
    assert 0.25 < forces[2] / measured[2] < 0.5
