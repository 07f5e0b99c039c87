import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.yarn.kernels.potential import CAP, potential, potential_and_derivatives

K, P, R, CORE = 6e-4, 2.4, 0.74, 0.335
SHELL = 2 * (R - CORE)


def slope_at(distance):
    return potential_and_derivatives(distance, K, P, R, CORE)[1]


@given(st.floats(0.02, 0.999))
def test_slope_and_curvature_are_the_derivatives(zeta):
    distance, step = 2 * CORE + zeta * SHELL, 1e-6 * SHELL * zeta
    slope = (
        potential(distance + step, K, P, R, CORE) - potential(distance - step, K, P, R, CORE)
    ) / (2 * step)
    bend = (slope_at(distance + step) - slope_at(distance - step)) / (2 * step)
    _, first, second = potential_and_derivatives(distance, K, P, R, CORE)
    assert first == pytest.approx(slope, rel=1e-5, abs=1e-12)
    assert second == pytest.approx(bend, rel=1e-5)


def test_force_is_the_measured_compression_law():
    # paper, Supplementary Note 2: force per area k rho0 / p * ((rho0 / rho)^p - 1)
    zeta = 0.4
    force = K * SHELL / P * (zeta**-P - 1)
    assert -slope_at(2 * CORE + zeta * SHELL) == pytest.approx(force)


def test_yarns_apart_do_not_feel_each_other():
    for distance in (2 * R, 3 * R):
        assert potential(distance, K, P, R, CORE) == 0
        assert potential_and_derivatives(distance, K, P, R, CORE) == (0, 0, 0)


def test_inside_the_core_the_potential_is_finite_and_grows():
    edge = 2 * CORE + CAP * SHELL
    at_edge = potential(edge, K, P, R, CORE)
    inside = potential(0.9 * edge, K, P, R, CORE)
    assert inside == pytest.approx(at_edge + 100 * 0.1**2)
    assert slope_at(0.9 * edge) == pytest.approx(-200 * 0.1 / edge)


@given(st.floats(-0.2, 1.2))
def test_the_value_alone_is_that_with_derivatives(zeta):
    distance = 2 * CORE + zeta * SHELL
    together, _, _ = potential_and_derivatives(distance, K, P, R, CORE)
    assert together == pytest.approx(potential(distance, K, P, R, CORE), rel=1e-9, abs=1e-15)
