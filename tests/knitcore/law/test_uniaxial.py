"""Pulls of a law along one direction."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import Direction, Fabric, InputError, material
from knitcore.law.constitutive import Transverse
from knitcore.law.uniaxial import free_strains_at_stress, held_strains_at_stress, uniaxial_response
from tests.knitcore.law.laws import laws

LAW = material("acrylic:published").law(Fabric.STOCKINETTE)


@given(laws, st.sampled_from(Direction))
def test_a_curve_is_in_equilibrium_and_stiffer_where_the_width_is_held(law, direction):
    strain = np.linspace(0.0, 0.8 * law.lock_up_strain(direction), 9)
    free = uniaxial_response(law, direction, strain)
    fixed = uniaxial_response(law, direction, strain, transverse=Transverse.FIXED)
    for curve in (free, fixed):
        np.testing.assert_array_equal(curve.strain, strain)
        pair = direction.of((strain, curve.transverse_strain), (curve.transverse_strain, strain))
        stress = law.stress(*pair)
        np.testing.assert_allclose(curve.stress, stress[direction.axis], rtol=1e-12)
        if curve is free:
            np.testing.assert_allclose(stress[direction.other.axis], 0, atol=1e-9)
    np.testing.assert_array_equal(fixed.transverse_strain, 0)
    assert np.all(fixed.stress[1:] > free.stress[1:])
    assert np.all(np.diff(free.stress) > 0)


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_a_sheet_pulled_to_the_lock_up_keeps_some_width(fabric, direction):
    law = material("acrylic").law(fabric)
    assert max(law.kappa_xx, law.kappa_yy) > 0
    strain = np.linspace(0.1, 0.999, 50) * law.lock_up_strain(direction)
    pulled = uniaxial_response(law, direction, strain)
    assert np.all(np.diff(pulled.transverse_strain) < 0)
    assert pulled.transverse_strain[-1] > -1
    assert np.all(np.diff(pulled.stress) > 0)


@given(laws, st.sampled_from(Direction))
def test_a_small_pull_shows_modulus_and_poisson_ratio(law, direction):
    curve = uniaxial_response(law, direction, [1e-7])
    assert curve.stress[0] / 1e-7 == pytest.approx(law.modulus(direction), rel=1e-3)
    ratio = law.poisson_yx if direction is Direction.COURSE else law.poisson_xy
    assert -curve.transverse_strain[0] / 1e-7 == pytest.approx(ratio, rel=1e-4)


@given(laws, st.sampled_from(Direction), st.sampled_from(Transverse), st.floats(1e-4, 2.0))
def test_the_strain_at_a_stress_carries_it(law, direction, transverse, stress):
    free = transverse is Transverse.FREE
    strains = (free_strains_at_stress if free else held_strains_at_stress)(
        law, direction, [0.0, stress]
    )
    curve = uniaxial_response(law, direction, strains, transverse=transverse)
    np.testing.assert_allclose(curve.stress, [0.0, stress], rtol=1e-6, atol=1e-11)
    assert np.all(strains < law.lock_up_strain(direction))


def test_the_lock_up_is_refused_with_the_limit_and_so_is_what_is_no_number():
    with pytest.raises(InputError, match=r"below 0\.900"):
        uniaxial_response(LAW, Direction.COURSE, [0.1, 0.95])
    lock = LAW.lock_up_strain(Direction.WALE)
    with pytest.raises(InputError, match="strain"):
        uniaxial_response(LAW, Direction.WALE, [lock])
    assert uniaxial_response(LAW, Direction.WALE, [0.999 * lock]).stress[0] > 0
    assert uniaxial_response(LAW, Direction.WALE, []).stress.shape == (0,)
    with pytest.raises(InputError, match="finite"):
        uniaxial_response(LAW, Direction.COURSE, [float("nan")])
    for bad in (-0.1, float("inf")):
        with pytest.raises(InputError, match="0 N/mm or more"):
            free_strains_at_stress(LAW, Direction.WALE, bad)
    assert free_strains_at_stress(LAW, Direction.WALE, 0.0) == 0.0
