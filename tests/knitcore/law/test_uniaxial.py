"""Pulls of a law along one direction."""

from __future__ import annotations

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.law.constitutive import Transverse
from knitcore.law.stiffening import StiffeningForm
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import material

LAW = material("acrylic:published").law(Fabric.STOCKINETTE)


@pytest.mark.parametrize("form", StiffeningForm)
@pytest.mark.parametrize("direction", Direction)
def test_a_curve_has_the_strains_given_and_the_stress_of_its_form(
    form: StiffeningForm, direction: Direction
) -> None:
    strain = np.array([0.0, 0.1, 0.3])
    found = uniaxial_response(LAW, direction, strain, transverse=Transverse.FREE, form=form)
    assert found.strain == pytest.approx(strain)
    along, across = found.strain, found.transverse_strain
    pair = (along, across) if direction is Direction.COURSE else (across, along)
    stress = LAW.stress(*pair, form)
    assert found.stress == pytest.approx(stress[direction.axis])
    assert stress[1 - direction.axis] == pytest.approx(np.zeros(3), abs=1e-9)
    held = uniaxial_response(LAW, direction, strain, transverse=Transverse.FIXED, form=form)
    assert not held.transverse_strain.any()
    assert np.all(held.stress[1:] > found.stress[1:])


def test_the_forms_differ_where_it_stiffens() -> None:
    full, published = (
        uniaxial_response(LAW, Direction.COURSE, [0.5], form=form).stress[0]
        for form in (StiffeningForm.FULL, StiffeningForm.PUBLISHED)
    )
    assert abs(full / published - 1) > 0.01


def test_the_lock_up_itself_is_refused_and_no_strains_are_none() -> None:
    lock = LAW.lock_up_strain(Direction.WALE)
    with pytest.raises(InputError, match="strain"):
        uniaxial_response(LAW, Direction.WALE, [lock])
    assert uniaxial_response(LAW, Direction.WALE, [0.999 * lock]).stress[0] > 0
    assert uniaxial_response(LAW, Direction.WALE, []).stress.shape == (0,)
    assert uniaxial_response(LAW, Direction.WALE, [0]).stress == pytest.approx([0.0])
