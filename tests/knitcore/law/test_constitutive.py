"""The constitutive law: derivatives, symmetry rules, forms, inverse and refusals."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw, Symmetrisation, Transverse
from knitcore.law.stiffening import EXTENSION_START, StiffeningForm, shear_response, stiffening
from knitcore.law.uniaxial import held_strains_at_stress, strain_at_stress, uniaxial_response
from knitcore.materials import Laws, load_library, load_variants, material

ROWS = [
    (m.identifier, fabric)
    for m in [*load_library(Laws.PUBLISHED).values(), *load_variants(Laws.PUBLISHED).values()]
    for fabric in m.fabrics
]
laws = st.sampled_from(ROWS).map(lambda row: material(row[0]).law(row[1]))
coupled = st.builds(
    lambda law, kappa: replace(law, kappa_xx=kappa, kappa_yy=1.5 * kappa),
    laws,
    st.sampled_from([0.0, 0.4]),
)
forms = st.sampled_from(StiffeningForm)


SOUND = {
    "stiffness_xxxx": 0.2,
    "stiffness_yyyy": 0.9,
    "stiffness_xxyy": 0.09,
    "stiffness_yyxx": 0.4,
    "alpha_xx": 1.1,
    "alpha_yy": 2.5,
    "beta_xx": 0.05,
    "beta_yy": 0.01,
}


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
    for one, other in zip(below, above, strict=True):
        assert one == pytest.approx(other, rel=1e-6)
    slopes = [float(stiffening(s)[1]) for s in (1.0, 1.5, 4.0)]
    assert slopes == sorted(slopes)


@pytest.mark.parametrize("form", StiffeningForm)
def test_stiffening_is_differentiated_right(form):
    s = np.concatenate([np.linspace(-0.3, 0.97, 40), np.linspace(0.99, 2, 10)])
    step = 1e-6
    energy_low, slope_low, _ = stiffening(s - step, form)
    energy_high, slope_high, _ = stiffening(s + step, form)
    _, slope, curvature = stiffening(s, form)
    np.testing.assert_allclose((energy_high - energy_low) / (2 * step), slope, rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(
        (slope_high - slope_low) / (2 * step), curvature, rtol=1e-5, atol=1e-6
    )


@given(coupled, forms, st.floats(-0.3, 1.2), st.floats(-0.3, 1.2))
def test_stress_is_the_gradient_of_the_energy(law, form, s_x, s_y):
    law = law.symmetrised()
    ex, ey = s_x / law.alpha_xx, s_y / law.alpha_yy
    step = 1e-6
    numeric = [
        (
            law.energy_density(ex + dx, ey + dy, form=form)
            - law.energy_density(ex - dx, ey - dy, form=form)
        )
        / (2 * step)
        for dx, dy in ((step, 0), (0, step))
    ]
    stress = law.stress(ex, ey, form)
    scale = max(1.0, *(abs(float(s)) for s in stress))
    np.testing.assert_allclose(numeric, stress, rtol=1e-4, atol=1e-6 * scale)


@given(coupled, forms, st.floats(-0.3, 1.2), st.floats(-0.3, 1.2))
def test_tangent_is_the_derivative_of_the_stress(law, form, s_x, s_y):
    ex, ey = s_x / law.alpha_xx, s_y / law.alpha_yy
    step = 1e-7
    tangent = law.tangent(ex, ey, form)
    for column, (dx, dy) in enumerate(((step, 0), (0, step))):
        high, low = law.stress(ex + dx, ey + dy, form), law.stress(ex - dx, ey - dy, form)
        numeric = [(float(h) - float(w)) / (2 * step) for h, w in zip(high, low, strict=True)]
        # At the start of the continuation and at slack the curvature itself jumps in slope.
        np.testing.assert_allclose(
            numeric, tangent[:2, column], rtol=1e-3, atol=1e-5 * float(np.abs(tangent).max())
        )
    np.testing.assert_array_equal(tangent[2], [0, 0, law.shear_modulus])


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


@given(coupled, st.floats(-1, 3), st.floats(-1, 3))
def test_the_full_symmetric_law_is_convex(law, s_x, s_y):
    law = law.symmetrised()
    strains = np.maximum([s_x / law.alpha_xx, s_y / law.alpha_yy], -1)  # no fibre is shorter than 0
    assert np.linalg.eigvalsh(law.tangent(*strains)).min() > 0


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


@given(laws)
def test_geometric_symmetrisation_keeps_the_moduli(law):
    symmetric = law.symmetrised()
    assert symmetric.is_symmetric
    for direction in Direction:
        assert symmetric.modulus(direction) == pytest.approx(law.modulus(direction), rel=1e-12)
    assert symmetric.poisson_xy * symmetric.poisson_yx == pytest.approx(
        law.poisson_xy * law.poisson_yx
    )


def test_arithmetic_symmetrisation_is_the_paper_s_mean():
    law = material("acrylic:published").law(Fabric.GARTER)
    mean = law.symmetrised(Symmetrisation.ARITHMETIC)
    assert mean.stiffness_xxyy == pytest.approx((law.stiffness_xxyy + law.stiffness_yyxx) / 2)
    script = law.symmetrised(Symmetrisation.SCRIPT)
    assert script.stiffness_yyxx == script.stiffness_xxyy == law.stiffness_xxyy
    with pytest.raises(InputError, match="positive definite"):
        material("lace-bamboo:published").law(Fabric.STOCKINETTE).symmetrised(
            Symmetrisation.ARITHMETIC
        )


def test_an_asymmetric_law_has_no_energy():
    with pytest.raises(InputError, match="no energy"):
        material("acrylic:published").law(Fabric.RIB).energy_density(0.1, 0.0)


def test_a_sheet_at_rest_has_no_energy_and_shear_costs_as_its_modulus_and_growth_say():
    law = material("acrylic").law(Fabric.GARTER).symmetrised()
    assert law.energy_density(0.0, 0.0) == 0
    sheared = law.energy_density(0.1, 0.2, [0.0, 0.05, -0.05])
    assert sheared[1] == sheared[2]
    grown = 1 + law.shear_stiffening * 0.1**2 / 2
    assert sheared[1] - sheared[0] == pytest.approx(2 * law.shear_modulus * 0.05**2 * grown)


@given(laws, st.sampled_from(Direction))
def test_a_small_pull_shows_modulus_and_poisson_ratio(law, direction):
    curve = uniaxial_response(law, direction, [1e-7])
    assert curve.stress[0] / 1e-7 == pytest.approx(law.modulus(direction), rel=1e-3)
    ratio = law.poisson_yx if direction is Direction.COURSE else law.poisson_xy
    assert -curve.transverse_strain[0] / 1e-7 == pytest.approx(ratio, rel=1e-4)


@given(laws, st.sampled_from(Direction), st.sampled_from(Transverse), st.floats(1e-4, 2.0))
def test_the_strain_at_a_stress_carries_it(law, direction, transverse, stress):
    strain = strain_at_stress(law, direction, stress, transverse=transverse)
    curve = uniaxial_response(law, direction, strain, transverse=transverse)
    assert curve.stress[0] == pytest.approx(stress, rel=1e-6)
    assert strain < law.lock_up_strain(direction)


@given(laws, st.sampled_from(Direction))
def test_many_strains_at_a_held_width_are_those_of_single_stresses(law, direction):
    stresses = [0.0, 1e-3, 0.1, 1.0]
    single = [strain_at_stress(law, direction, s, transverse=Transverse.FIXED) for s in stresses]
    np.testing.assert_allclose(
        held_strains_at_stress(law, direction, stresses), single, rtol=1e-6, atol=1e-11
    )


@given(laws, st.sampled_from(Direction))
def test_a_held_width_is_stiffer(law, direction):
    strain = np.linspace(0.01, 0.8 * law.lock_up_strain(direction), 8)
    free = uniaxial_response(law, direction, strain)
    fixed = uniaxial_response(law, direction, strain, transverse=Transverse.FIXED)
    assert np.all(fixed.stress > free.stress)
    assert np.all(np.diff(free.stress) > 0)
    np.testing.assert_array_equal(fixed.transverse_strain, 0)
    other = law.stress(
        *(
            (strain, free.transverse_strain)
            if direction is Direction.COURSE
            else (free.transverse_strain, strain)
        )
    )[direction.other.axis]
    np.testing.assert_allclose(other, 0, atol=1e-9)


@given(laws, st.floats(0.01, 1.5))
def test_the_published_form_has_its_own_equilibrium(law, share):
    direction = Direction.COURSE
    strain = share * law.lock_up_strain(direction)
    curve = uniaxial_response(law, direction, strain, form=StiffeningForm.PUBLISHED)
    stress = law.stress(strain, curve.transverse_strain, StiffeningForm.PUBLISHED)
    assert abs(float(stress[1][0])) < 1e-9


def test_strains_at_the_lock_up_are_refused_with_the_limit():
    law = material("acrylic:published").law(Fabric.STOCKINETTE)
    with pytest.raises(InputError, match=r"below 0\.900"):
        uniaxial_response(law, Direction.COURSE, [0.1, 0.95])
    with pytest.raises(InputError, match="finite"):
        uniaxial_response(law, Direction.COURSE, [float("nan")])
    for bad in (-0.1, float("inf")):
        with pytest.raises(InputError, match="0 N/mm or more"):
            strain_at_stress(law, Direction.WALE, bad)
    assert strain_at_stress(law, Direction.WALE, 0.0) == 0.0


def test_a_law_without_stiffening_never_locks():
    law = replace(
        material("acrylic:published").law(Fabric.SEED).symmetrised(), alpha_xx=0.0, alpha_yy=0.0
    )
    assert law.lock_up_strain(Direction.WALE) == np.inf
    assert law.energy_density(0.1, 0.1) > 0


@pytest.mark.parametrize(
    ("change", "field"),
    [
        *(
            ({name: bad}, name)
            for name in ("stiffness_xxxx", "stiffness_yyyy", "shear_modulus")
            for bad in (0.0, -1.0, float("nan"))
        ),
        *(
            ({name: bad}, name)
            for name in (*SOUND, "kappa_xx", "kappa_yy", "shear_stiffening")
            if not name.startswith("stiffness")
            for bad in (-0.1, float("inf"))
        ),
        ({"stiffness_xxyy": -0.1}, "stiffness_yyxx"),
        ({"stiffness_yyxx": -0.1}, "stiffness_yyxx"),
        ({"stiffness_xxyy": 2.0}, "stiffness_xxyy"),
        ({"stiffness_xxyy": 0.45}, "stiffness_xxyy"),  # the determinant is 0
    ],
)
def test_unphysical_constants_are_refused_by_name(change, field):
    ConstitutiveLaw(**SOUND)
    for may_be_zero in ("alpha_xx", "beta_yy", "kappa_xx", "stiffness_xxyy", "stiffness_yyxx"):
        ConstitutiveLaw(**SOUND | {may_be_zero: 0.0})
    with pytest.raises(InputError) as caught:
        ConstitutiveLaw(**{**SOUND, **change})
    assert caught.value.field == field
