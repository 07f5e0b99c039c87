from dataclasses import replace

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.yarn.library.law_of_stretches import fit_sweeps
from tests.knitcore.yarn.study.synthetic import sweep

NU_YX, NU_XY = 0.45, 0.2
C_X, C_Y, ALPHA_X, ALPHA_Y, BETA_X, BETA_Y = 0.2, 0.75, 1.4, 3.0, 0.005, 0.013


def stretches(top_x=0.5, top_y=0.25, points=30):
    x, y = np.linspace(0, top_x, points), np.linspace(0, top_y, points)

    def stiffening(s):
        return 1 / (1 - s) ** 2 - 1 - 2 * s

    stress_x = C_X * (1 - NU_XY * NU_YX) * x + BETA_X * stiffening(ALPHA_X * x)
    stress_y = C_Y * (1 - NU_XY * NU_YX) * y + BETA_Y * stiffening(ALPHA_Y * y)
    return (
        sweep(Direction.COURSE, x, -NU_YX * x, stress_x),
        sweep(Direction.WALE, y, -NU_XY * y, stress_y),
    )


def test_constants_come_back():
    course, wale = stretches()
    found = fit_sweeps(course, wale)
    law = found.law
    assert law.stiffness_xxxx == pytest.approx(C_X, rel=1e-3)
    assert law.stiffness_yyyy == pytest.approx(C_Y, rel=1e-3)
    assert (law.poisson_yx, law.poisson_xy) == pytest.approx((NU_YX, NU_XY))
    assert (law.alpha_xx, law.alpha_yy) == pytest.approx((ALPHA_X, ALPHA_Y), rel=1e-2)
    assert (law.beta_xx, law.beta_yy) == pytest.approx((BETA_X, BETA_Y), rel=3e-2)
    assert found.rms_course_n_per_mm < 1e-5


def test_only_the_range_of_stress_is_fitted():
    course, wale = stretches()
    found = fit_sweeps(course, wale, max_stress_n_per_mm=0.05)
    last = course.strain[course.stress_n_per_mm <= 0.05][-1]
    assert found.largest_strain_course == pytest.approx(last)


def test_points_behind_the_first_excess_are_left_out():
    course, wale = stretches()
    stress = course.stress_n_per_mm.copy()
    stress[20:] = 0.01
    stress[19] = 0.5
    found = fit_sweeps(replace(course, stress_n_per_mm=stress), wale)
    assert found.largest_strain_course == pytest.approx(course.strain[18])


def test_swapped_or_short_stretches_are_refused():
    course, wale = stretches()
    with pytest.raises(InputError, match="Swap"):
        fit_sweeps(wale, course)
    with pytest.raises(InputError, match="points"):
        fit_sweeps(course, wale, max_stress_n_per_mm=1e-4)


def test_a_stretch_that_leaves_no_initial_stiffness_has_no_law():
    # flat, then steep, as a welt that unfolds: least squares want a negative initial stiffness
    course, _ = stretches()
    strain = np.linspace(0.0, 1.4, 30)
    stress = 0.01 * strain + 0.25 * (strain / 1.4) ** 12
    unfolding = sweep(Direction.WALE, strain, -NU_XY * strain, stress)
    with pytest.raises(InputError, match="wale stretch stiffens faster"):
        fit_sweeps(course, unfolding)


def test_the_range_ends_where_the_stretches_do():
    course, wale = stretches()
    least = min(course.stress_n_per_mm[-1], wale.stress_n_per_mm[-1])
    assert fit_sweeps(course, wale, max_stress_n_per_mm=90.0).max_stress_n_per_mm == least
    assert fit_sweeps(course, wale, max_stress_n_per_mm=0.05).max_stress_n_per_mm == 0.05
