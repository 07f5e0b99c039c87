import math

import pytest

from knitcore.base.errors import InputError
from knitcore.yarn.model.yarn_model import YarnModel

GOOD = {
    "bending_modulus_n_mm2": 0.046,
    "contact_stiffness_n_per_mm3": 6e-4,
    "contact_exponent": 2.4,
    "radius_mm": 0.74,
    "core_radius_mm": 0.335,
}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("bending_modulus_n_mm2", 0.0),
        ("bending_modulus_n_mm2", -1.0),
        ("contact_stiffness_n_per_mm3", 0.0),
        ("contact_stiffness_n_per_mm3", math.inf),
        ("contact_exponent", 1.0),
        ("radius_mm", math.nan),
        ("radius_mm", 740.0),
        ("core_radius_mm", -0.1),
        ("core_radius_mm", 0.74),
        ("core_radius_mm", 0.9),
    ],
)
def test_a_yarn_that_cannot_be_is_refused_by_the_name_of_its_field(name, value):
    with pytest.raises(InputError) as refusal:
        YarnModel(**(GOOD | {name: value}))
    assert refusal.value.field == name
    assert refusal.value.remedy


def test_a_yarn_without_a_core_is_allowed():
    assert YarnModel(**(GOOD | {"core_radius_mm": 0.0})).core_radius_mm == 0.0
