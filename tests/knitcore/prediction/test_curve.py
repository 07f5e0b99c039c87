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

LOADS = [0.01, 0.05, 0.1, 0.2]


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_pure_fabrics_follow_their_law(fabric, direction):
    yarn = material("lace-cashmere:published")
    found = curve(StitchChart.of_fabric(fabric, 9, 9), yarn, direction, LOADS)
    stress = uniaxial_response(yarn.law(fabric), direction, found.strain).stress
    np.testing.assert_allclose(stress, LOADS, rtol=1e-9)
    assert found.provenance == "measured"


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


def test_charts_of_any_size_have_a_curve():
    noise = StitchChart(np.random.default_rng(0).random((120, 90)) < 0.5)
    found = curve(noise, material("acrylic:published"), "wale", LOADS)
    assert np.all(np.diff(found.strain) > 0)
    assert found.provenance == "learned"


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
    found = curve(chart, yarn, "course", [0, 1], size=size)
    assert found.stress_n_per_mm.tolist() == [0.0, 1.0]
    own = predict(chart, yarn, size=size).course.strain([0.05])
    assert curve(chart, yarn, "course", [0.05], size=size).strain == pytest.approx(own)
    assert curve(chart, yarn, "course", [0.05]).strain != pytest.approx(own, rel=1e-3)


@pytest.mark.parametrize(
    ("asked", "field"),
    [
        ("strain", "stress"),
        ("stress", "strain"),
        ("held_strain", "stress"),
        ("held_stress", "strain"),
        ("across_strain", "stress"),
    ],
)
def test_what_cannot_be_asked_is_named(asked, field):
    along = predict(StitchChart.parse("KP"), material("acrylic")).course
    with pytest.raises(InputError) as refused:
        getattr(along, asked)(-0.1)
    assert refused.value.field == field


def test_a_stress_beyond_any_fabric_is_refused_with_the_largest() -> None:
    with pytest.raises(InputError, match="at most 100 N/mm") as refused:
        curve("KP", "acrylic", "wale", [0.1, 1e9])
    assert refused.value.most == 100.0
