"""The constitutive law: derivatives, symmetry rules and refusals."""

from dataclasses import asdict, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import Direction, Fabric, InputError, material
from knitcore.law.constitutive import ConstitutiveLaw, Symmetrisation
from knitcore.law.stiffening import StiffeningForm
from tests.knitcore.law.laws import laws
from tests.knitcore.refusals import refuses

coupled = st.builds(
    lambda law, kappa: replace(law, kappa_xx=kappa, kappa_yy=1.5 * kappa),
    laws,
    st.sampled_from([0.0, 0.4]),
)
forms = st.sampled_from(StiffeningForm)
SOUND = asdict(ConstitutiveLaw(0.2, 0.9, 0.09, 0.4, 1.1, 2.5, 0.05, 0.01))


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


@given(coupled, st.floats(-1, 3), st.floats(-1, 3))
def test_the_full_symmetric_law_is_convex(law, s_x, s_y):
    law = law.symmetrised()
    strains = np.maximum([s_x / law.alpha_xx, s_y / law.alpha_yy], -1)  # no fibre is shorter than 0
    assert np.linalg.eigvalsh(law.tangent(*strains)).min() > 0


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
            for name in SOUND
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
    with refuses(field):
        ConstitutiveLaw(**{**SOUND, **change})
