from dataclasses import replace

import numpy as np
import pytest

from knitcore import Direction, InputError
from knitcore.yarn.library.law_of_stretches import fit_sweeps
from tests.knitcore.results import sweep

NU_YX, NU_XY = 0.45, 0.2
C_X, C_Y, ALPHA_X, ALPHA_Y, BETA_X, BETA_Y = 0.2, 0.75, 1.4, 3.0, 0.005, 0.013


X, Y = np.linspace(0, 0.5, 30), np.linspace(0, 0.25, 30)


def stress(linear, beta, s):
    return linear + beta * (1 / (1 - s) ** 2 - 1 - 2 * s)


STRESS_X = stress(C_X * (1 - NU_XY * NU_YX) * X, BETA_X, ALPHA_X * X)
STRESS_Y = stress(C_Y * (1 - NU_XY * NU_YX) * Y, BETA_Y, ALPHA_Y * Y)
COURSE = sweep(Direction.COURSE, X, -NU_YX * X, STRESS_X)
WALE = sweep(Direction.WALE, Y, -NU_XY * Y, STRESS_Y)


def test_constants_come_back():
    fit = fit_sweeps(COURSE, WALE)
    law = fit.law
    assert law.stiffness_xxxx == pytest.approx(C_X, rel=1e-3)
    assert law.stiffness_yyyy == pytest.approx(C_Y, rel=1e-3)
    assert (law.poisson_yx, law.poisson_xy) == pytest.approx((NU_YX, NU_XY))
    assert (law.alpha_xx, law.alpha_yy) == pytest.approx((ALPHA_X, ALPHA_Y), rel=1e-2)
    assert (law.beta_xx, law.beta_yy) == pytest.approx((BETA_X, BETA_Y), rel=3e-2)
    assert fit.rms_course_n_per_mm < 1e-5


def test_only_the_range_of_stress_is_fitted():
    least = min(COURSE.stress_n_per_mm[-1], WALE.stress_n_per_mm[-1])
    assert fit_sweeps(COURSE, WALE, max_stress_n_per_mm=90.0).max_stress_n_per_mm == least
    fit = fit_sweeps(COURSE, WALE, max_stress_n_per_mm=0.05)
    assert fit.max_stress_n_per_mm == 0.05
    last = COURSE.strain[COURSE.stress_n_per_mm <= 0.05][-1]
    assert fit.largest_strain_course == pytest.approx(last)


def test_points_behind_the_first_excess_are_left_out():
    stress = COURSE.stress_n_per_mm.copy()
    stress[20:] = 0.01
    stress[19] = 0.5
    fit = fit_sweeps(replace(COURSE, stress_n_per_mm=stress), WALE)
    assert fit.largest_strain_course == pytest.approx(COURSE.strain[18])


def test_swapped_or_short_stretches_are_refused():
    with pytest.raises(InputError, match="Swap"):
        fit_sweeps(WALE, COURSE)
    with pytest.raises(InputError, match="points"):
        fit_sweeps(COURSE, WALE, max_stress_n_per_mm=1e-4)


def test_a_stretch_that_leaves_no_initial_stiffness_has_no_law():
    # flat, then steep, as a welt that unfolds: least squares want a negative initial stiffness
    strain = np.linspace(0.0, 1.4, 30)
    stress = 0.01 * strain + 0.25 * (strain / 1.4) ** 12
    unfolding = sweep(Direction.WALE, strain, -NU_XY * strain, stress)
    with pytest.raises(InputError, match="wale stretch stiffens faster"):
        fit_sweeps(COURSE, unfolding)
