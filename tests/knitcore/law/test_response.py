"""Responses of a sheet: through points, of laws, stiffened, and the other way round."""

import numpy as np
import pytest

from knitcore import Direction, Fabric, material
from knitcore.law.response import (
    MAX_STRESS_N_PER_MM,
    free_response,
    held_response,
    response_through,
    stiffened,
)

STRESS, STRAIN = np.array([0.01, 0.1, 1.0]), np.array([0.2, 0.5, 0.8])
LAW = material("acrylic:published").law(Fabric.RIB)


def test_through_points_it_is_linear_a_power_law_and_then_stiff() -> None:
    response = response_through(STRESS, STRAIN)
    assert response.modulus_n_per_mm == pytest.approx(0.05)
    assert response.strain(STRESS) == pytest.approx(STRAIN)
    assert response.strain([0.0, 0.002, 0.005]) == pytest.approx([0.0, 0.04, 0.1])
    assert response.strain(np.sqrt(0.001)) == pytest.approx(np.sqrt(0.2 * 0.5))
    assert response.strain(5) == pytest.approx(0.8)
    assert response.strain([0, 1]) == pytest.approx([0.0, 0.8])  # whole numbers, too


@pytest.mark.parametrize("direction", Direction)
def test_of_a_law_they_start_with_its_constants(direction: Direction) -> None:
    free, held = free_response(LAW, direction), held_response(LAW, direction)
    assert free.modulus_n_per_mm == pytest.approx(LAW.modulus(direction))
    assert held.modulus_n_per_mm == pytest.approx(LAW.stiffness[direction.axis, direction.axis])
    for response in (free, held):
        assert 1e-6 / response.strain(1e-6) == pytest.approx(response.modulus_n_per_mm, rel=1e-3)


def test_stiffened_it_needs_so_many_times_the_stress() -> None:
    own = free_response(LAW, Direction.COURSE)
    twice = stiffened(own, lambda stress: np.full_like(stress, np.log(2.0), dtype=float))
    assert twice.modulus_n_per_mm == pytest.approx(2 * own.modulus_n_per_mm)
    assert twice.strain(STRESS) == pytest.approx(own.strain(STRESS / 2))


def test_the_stress_at_a_strain_is_the_inverse() -> None:
    response = response_through(STRESS, STRAIN)
    assert response.stress(STRAIN[:2]) == pytest.approx(STRESS[:2], rel=0.03)
    assert response.stress([0, 0.04]) == pytest.approx([0.0, 0.002], abs=1e-6)
    law = free_response(LAW, Direction.COURSE)
    small = np.geomspace(1e-6, 0.05, 40)
    assert law.strain(law.stress(small)) == pytest.approx(small, rel=2e-3)
    assert law.stress(50.0) == pytest.approx(MAX_STRESS_N_PER_MM)
