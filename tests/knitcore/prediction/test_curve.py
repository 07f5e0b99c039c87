"""Stretch of charts under stress."""

import numpy as np
import pytest

from knitcore import (
    Direction,
    Fabric,
    InputError,
    RelaxedSize,
    StitchChart,
    curve,
    material,
    predict,
)
from knitcore.law.uniaxial import uniaxial_response
from tests.knitcore.refusals import refuses

LOADS = [0.01, 0.05, 0.1, 0.2]


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_pure_fabrics_follow_their_law(fabric, direction):
    yarn = material("lace-cashmere:published")
    drawn = curve(StitchChart.of_fabric(fabric, 9, 9), yarn, direction, LOADS)
    stress = uniaxial_response(yarn.law(fabric), direction, drawn.strain).stress
    np.testing.assert_allclose(stress, LOADS, rtol=1e-9)
    assert drawn.provenance == "measured"


@pytest.mark.parametrize("text", ["KKPP\nPPKK", "KKPP\nKKPP\nPPKK\nPPKK", "KKKPPP", "K\nK\nP\nP"])
@pytest.mark.parametrize("direction", Direction)
def test_curves_start_with_the_predicted_modulus(text, direction):
    chart, yarn = StitchChart.parse(text), material("acrylic:published")
    small = 1e-6
    strain = curve(chart, yarn, direction, [small]).strain[0]
    assert small / strain == pytest.approx(
        predict(chart, yarn).modulus_n_per_mm(direction), rel=5e-3
    )


def test_bad_stresses_are_refused():
    yarn = material("acrylic:published")
    for bad in ([-0.1], [0.2, 0.1], [0.1, 0.1], [float("nan")]):
        with pytest.raises(InputError, match="stress"):
            curve(StitchChart.parse("KP"), yarn, Direction.WALE, bad)


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_stress_and_strain_are_inverse(fabric, direction):
    along = predict(StitchChart.of_fabric(fabric, 2, 2), material("cotton")).along(direction)
    loads = np.array([0.0, 1e-7, 1e-3, 0.01, 0.1, 0.5])
    np.testing.assert_allclose(along.stress(along.strain(loads)), loads, rtol=1e-3)
    assert along.stress(100.0) == pytest.approx(10.0)


def test_a_curve_keeps_its_stresses_and_takes_ones_own_gauge():
    chart, yarn = StitchChart.parse("KKPP"), material("acrylic")
    size = RelaxedSize(4.0, 3.0)
    drawn = curve(chart, yarn, "course", [0, 1], size=size)
    assert drawn.stress_n_per_mm.tolist() == [0.0, 1.0]
    own = predict(chart, yarn, size=size).course.strain([0.05])
    assert curve(chart, yarn, "course", [0.05], size=size).strain == pytest.approx(own)
    assert curve(chart, yarn, "course", [0.05]).strain != pytest.approx(own, rel=1e-3)


@pytest.mark.parametrize(
    "method", ["strain", "stress", "held_strain", "held_stress", "across_strain"]
)
def test_what_cannot_be_asked_is_named(method):
    along = predict(StitchChart.parse("KP"), material("acrylic")).course
    with refuses("strain" if method.endswith("stress") else "stress"):
        getattr(along, method)(-0.1)


def test_a_stress_beyond_any_fabric_is_refused_with_the_largest() -> None:
    with pytest.raises(InputError, match="at most 100 N/mm") as refused:
        curve("KP", "acrylic", "wale", [0.1, 1e9])
    assert refused.value.most == 100.0
