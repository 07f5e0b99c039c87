"""The stiffening term and shear: forms, derivatives and limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.law.stiffening import EXTENSION_START, StiffeningForm, shear_response, stiffening


def test_the_full_form_is_the_printed_term():
    s = np.linspace(0, 0.97, 50)
    _, slope, _ = stiffening(s)
    np.testing.assert_allclose(slope, 1 / (1 - s) ** 2 - 1 - 2 * s, atol=1e-10)


def test_the_published_form_is_the_full_one_to_fourth_order():
    """Note 9 drops terms of fifth order in the energy: the difference scales as s^5."""
    s = np.array([1e-3, 2e-3])
    difference = stiffening(s)[0] - stiffening(s, StiffeningForm.PUBLISHED)[0]
    assert difference[1] / difference[0] == pytest.approx(32, rel=0.01)


def test_slack_yarn_does_not_stiffen():
    for values in stiffening(np.array([-2.0, -0.1, 0.0])):
        np.testing.assert_array_equal(values, 0)


def test_the_continuation_is_twice_differentiable():
    below, above = (stiffening(EXTENSION_START + s) for s in (-1e-9, 1e-9))
    for before, after in zip(below, above, strict=True):
        assert before == pytest.approx(after, rel=1e-6)
    slopes = [float(stiffening(s)[1]) for s in (1.0, 1.5, 4.0)]
    assert slopes == sorted(slopes)


@given(st.floats(-1.5, 1.5), st.floats(0, 30))
def test_shear_stiffens_as_its_energy_says(angle, growth):
    """Stress and stiffness are derivatives, the energy is even and convex."""
    energy, stress, stiffness = shear_response(angle, 0.02, growth)
    step = 1e-5
    ahead, behind = (shear_response(angle + d, 0.02, growth) for d in (step, -step))
    assert stress == pytest.approx((ahead[0] - behind[0]) / (2 * step), abs=1e-7)
    assert stiffness == pytest.approx((ahead[1] - behind[1]) / (2 * step), rel=1e-6)
    assert energy == shear_response(-angle, 0.02, growth)[0]
    assert stiffness >= 0.02


@given(st.floats(0, 30), st.floats(-1, 1))
def test_shear_that_stiffens_keeps_compressed_fibres_as_stable(growth, share):
    """Up to the angle at which the secant modulus has doubled. In the tangent of a fibre, shear
    takes stress²/stiffness from what keeps it straight, and that is no more than of constant shear.
    """
    angle = share / max(growth, 1.0) ** 0.5
    _, stress, stiffness = shear_response(angle, 1.0, growth)
    assert stress**2 / stiffness <= angle**2 * (1 + 1e-12)
    assert stiffness >= 1.0
