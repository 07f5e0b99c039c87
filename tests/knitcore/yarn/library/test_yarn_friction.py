"""Friction of the library's yarns."""

from dataclasses import replace

import pytest

from knitcore.materials import load_library, material
from knitcore.yarn.library.yarn_friction import yarn_friction


def test_every_yarn_of_the_library_has_an_interval_around_its_default():
    for name in load_library():
        friction = yarn_friction(material(name))
        assert 0.0 < friction.low < friction.coefficient < friction.high < 1.0
        assert "not measured" in friction.source


@pytest.mark.parametrize(
    ("name", "high", "listed"),
    [("cotton", 0.51, True), ("glove-wool", 0.37, True), ("acrylic", 0.51, False)],
)
def test_the_first_fibre_that_is_named_decides(name, high, listed):
    friction = yarn_friction(material(name))
    assert friction.high == high
    assert ("not listed" not in friction.source) is listed


def test_a_measured_coefficient_goes_before_that_of_the_fibre():
    cotton = material("cotton")
    measured = replace(
        cotton, yarn=replace(cotton.yarn, friction=0.2, friction_interval=(0.2, 0.3))
    )
    friction = yarn_friction(measured)
    assert (friction.low, friction.coefficient, friction.high) == (0.2, 0.2, 0.3)
    assert "given" in friction.source
