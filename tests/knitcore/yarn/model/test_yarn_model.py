import math
from dataclasses import asdict

import pytest

from knitcore.yarn.model.yarn_model import YarnModel
from tests.knitcore.refusals import refuses

GOOD = asdict(YarnModel(0.046, 6e-4, 2.4, 0.74, 0.335))


BAD = {
    "bending_modulus_n_mm2": (0.0, -1.0),
    "contact_stiffness_n_per_mm3": (0.0, math.inf),
    "contact_exponent": (1.0,),
    "radius_mm": (math.nan, 740.0),
    "core_radius_mm": (-0.1, 0.74, 0.9),
}


@pytest.mark.parametrize(("name", "value"), [(n, v) for n, values in BAD.items() for v in values])
def test_a_yarn_that_cannot_be_is_refused_by_the_name_of_its_field(name, value):
    with refuses(name) as refusal:
        YarnModel(**(GOOD | {name: value}))
    assert refusal.value.remedy


def test_a_yarn_without_a_core_is_allowed():
    assert YarnModel(**(GOOD | {"core_radius_mm": 0.0})).shell_mm == pytest.approx(1.48)
