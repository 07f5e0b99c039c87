"""Elementary functions against the mathematical library's."""

import math

import numpy as np
import pytest

from knitcore.base.elementary import arctan2, log, power

RNG = np.random.default_rng(1)


def test_logarithms_to_the_last_digits():
    for value in 10.0 ** RNG.uniform(-30.0, 30.0, 500):
        assert log(value) == pytest.approx(math.log(value), rel=4e-15, abs=1e-16)
    assert log(1.0) == 0.0


def test_powers_to_fourteen_digits():
    for tens, exponent in RNG.uniform((-5.0, -5.0), (1.0, 5.0), (500, 2)):
        base = 10.0**tens
        assert power(base, exponent) == pytest.approx(base**exponent, rel=2e-14)
    assert power(2.0, 10.0) == pytest.approx(1024.0, rel=1e-15)
    assert power(0.3, 0.0) == 1.0


def test_angles_all_around_to_the_last_digits():
    for y, x in RNG.standard_normal((500, 2)):
        assert arctan2(y, x) == pytest.approx(math.atan2(y, x), rel=4e-15)
    for y, x in ((0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (0.0, 0.0), (1e-300, 1.0)):
        assert arctan2(y, x) == pytest.approx(math.atan2(y, x))
