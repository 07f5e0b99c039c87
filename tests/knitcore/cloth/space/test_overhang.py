"""Peirce's test against the heavy elastica."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.cloth.space.even_cloth import EvenCloth
from knitcore.cloth.space.overhang import overhang
from knitcore.measure.heavy_elastica import heavy_elastica

WEIGHT, LENGTH = 3e-6, 12.0
CLOTH = EvenCloth(
    stitch_mm=(3.0, 2.0),
    membrane_n_per_mm=(0.3, 0.2, 0.05, 0.03),
    rigidity_n_mm=(WEIGHT * LENGTH**3, 8.0 * WEIGHT * LENGTH**3),
    twist_n_mm=0.004,
    curvature_per_mm=(0.0, 0.0),
    thickness_mm=2.0,
    weight_n_per_mm2=WEIGHT,
)


@pytest.mark.parametrize("times", [1.0, 2.0, 4.0])
def test_a_strip_hangs_as_the_heavy_elastica(times: float) -> None:
    found = overhang(CLOTH, 0, times * LENGTH)
    _, reach, fall = heavy_elastica(times**3)
    assert found.converged
    assert found.reach_mm == pytest.approx(times * LENGTH * reach[-1], abs=0.005 * times * LENGTH)
    assert found.fall_mm == pytest.approx(times * LENGTH * fall[-1], abs=0.005 * times * LENGTH)


def test_two_bending_lengths_fall_by_the_angle_of_the_test() -> None:
    found = overhang(CLOTH, 0)
    assert found.overhang_mm == pytest.approx(2 * LENGTH)
    assert np.degrees(found.angle_rad) == pytest.approx(41.5, abs=0.2)


def test_the_rigidity_that_is_read_is_the_one_that_went_in() -> None:
    """Within the error of Peirce's formula, 2 % of the length."""
    found = overhang(CLOTH, 1)
    assert found.rigidity_n_mm == pytest.approx(CLOTH.rigidity_n_mm[1], rel=0.07)


def test_the_curl_of_the_fabric_is_left_out() -> None:
    rolled = replace(CLOTH, curvature_per_mm=(0.7, -0.4))
    assert overhang(rolled, 0).angle_rad == pytest.approx(overhang(CLOTH, 0).angle_rad, rel=1e-6)


@pytest.mark.parametrize(("length", "problem"), [(1e-9, "do not bend"), (61.0, "straight down")])
def test_a_strip_that_does_not_bend_or_hangs_straight_down_is_refused(
    length: float, problem: str
) -> None:
    with pytest.raises(InputError, match=problem):
        overhang(CLOTH, 0, length)
