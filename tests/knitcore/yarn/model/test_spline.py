"""Quintic B-splines: partition of unity, derivatives, interpolation, refinement."""

import numpy as np
import pytest

from knitcore.yarn.model.spline import SplineGrid, quintic_basis


def test_basis_reproduces_one_and_the_place():
    u = np.linspace(0.0, 1.0, 11)
    basis = quintic_basis(u, 0)
    np.testing.assert_allclose(basis.sum(axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose(basis @ (np.arange(6) - 2.0), u, atol=1e-13)


@pytest.mark.parametrize("derivative", [0, 1, 2])
def test_each_derivative_is_the_slope_of_the_one_before(derivative):
    u, h = np.linspace(0.1, 0.9, 9), 3e-5
    slope = (quintic_basis(u + h, derivative) - quintic_basis(u - h, derivative)) / (2 * h)
    np.testing.assert_allclose(slope, quintic_basis(u, derivative + 1), atol=1e-8)


@pytest.mark.parametrize("antiperiodic", [False, True])
def test_interpolation_passes_through_the_values(antiperiodic):
    grid = SplineGrid(controls=12)
    values = np.random.default_rng(3).standard_normal(12)
    controls = grid.interpolate(values, antiperiodic=antiperiodic)
    sign = -1.0 if antiperiodic else 1.0
    around = np.concatenate([sign * controls[-2:], controls, sign * controls[:3]])
    weights = quintic_basis(np.array([0.0]), 0)[0]
    passed = np.array([weights @ around[c : c + 6] for c in range(12)])
    np.testing.assert_allclose(passed, values, atol=1e-12)


def test_refining_keeps_a_smooth_curve():
    coarse, fine = SplineGrid(16), SplineGrid(24)
    t = np.arange(16) / 16
    wave = np.stack([np.sin(2 * np.pi * t), np.cos(4 * np.pi * t), 0 * t], axis=1)
    controls = np.stack([coarse.interpolate(v) for v in wave.T], axis=1)
    refined = coarse.refine(fine, controls)
    t = np.arange(24) / 24
    exact = np.stack([fine.interpolate(v) for v in (np.sin(2 * np.pi * t), np.cos(4 * np.pi * t))])
    np.testing.assert_allclose(refined[:, :2], exact.T, atol=2e-4)
