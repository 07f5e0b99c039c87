"""Stretch of charts under stress."""

import numpy as np
import pytest

from knitcore import StitchChart, curve, predict
from knitcore.answer.composite import composite
from knitcore.answer.repeat import Repeat
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import load_library, material
from knitcore.mechanics.repeat_curve import repeat_curve, repeat_curve_at_stress

LOADS = [0.01, 0.05, 0.1, 0.2]


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_pure_fabrics_follow_their_law(fabric, direction):
    yarn = material("lace-cashmere")
    found = curve(StitchChart.of_fabric(fabric, 9, 9), yarn, direction, LOADS)
    stress = uniaxial_response(yarn.law(fabric), direction, found.strain).stress
    np.testing.assert_allclose(stress, LOADS, rtol=1e-9)
    assert found.provenance == "measured"


@pytest.mark.parametrize("identifier", load_library())
def test_wide_rib_stretches_more_at_every_load(identifier):
    wide, narrow = (
        curve(StitchChart.parse(text), material(identifier), Direction.COURSE)
        for text in ("KKPP", "KP")
    )
    assert np.all(wide.strain[1:] > narrow.strain[1:])
    assert wide.provenance == "composite with known size"


@pytest.mark.parametrize("text", ["KKPP\nPPKK", "KKPP\nKKPP\nPPKK\nPPKK", "KKKPPP", "K\nK\nP\nP"])
@pytest.mark.parametrize("direction", Direction)
def test_curves_start_with_the_predicted_modulus(text, direction):
    chart, yarn = StitchChart.parse(text), material("acrylic")
    small = 1e-6
    strain = curve(chart, yarn, direction, [small]).strain[0]
    assert small / strain == pytest.approx(
        predict(chart, yarn).modulus_n_per_mm(direction), rel=5e-3
    )


def test_stress_and_strain_control_agree():
    chart, yarn = StitchChart.parse("KKPP\nPPKK"), material("cotton")
    by_stress = repeat_curve_at_stress(chart, yarn, Direction.COURSE, LOADS)
    by_strain = repeat_curve(chart, yarn, Direction.COURSE, by_stress.strain)
    np.testing.assert_allclose(by_strain.stress, LOADS, rtol=1e-5)
    np.testing.assert_allclose(
        by_strain.transverse_strain, by_stress.transverse_strain, rtol=1e-5, atol=1e-8
    )


def test_bad_stresses_are_refused():
    yarn = material("acrylic")
    for bad in ([-0.1], [0.2, 0.1], [float("nan")]):
        with pytest.raises(InputError, match="stress"):
            curve(StitchChart.parse("KP"), yarn, Direction.WALE, bad)


def test_charts_of_any_size_have_a_curve():
    noise = StitchChart(np.random.default_rng(0).random((120, 90)) < 0.5)
    found = curve(noise, material("acrylic"), "wale", LOADS)
    assert np.all(np.diff(found.strain) > 0)
    assert found.provenance == "composite"


@pytest.mark.parametrize("text", ["KKP\nKPK", "KKPP\nPPKK\nKPKP"])
@pytest.mark.parametrize("direction", Direction)
def test_lines_of_cells_are_near_the_full_solution(text, direction):
    """9 % at most in a larger study."""
    yarn, repeat = material("acrylic"), Repeat.of(StitchChart.parse(text).tile(2, 2))
    full = repeat_curve_at_stress(repeat.chart, yarn, direction, LOADS)
    lines = composite(repeat, yarn).along(direction).strain(LOADS)
    np.testing.assert_allclose(lines, full.strain, rtol=0.09)


@pytest.mark.parametrize("fabric", Fabric)
@pytest.mark.parametrize("direction", Direction)
def test_stress_and_strain_are_inverse(fabric, direction):
    along = predict(StitchChart.of_fabric(fabric, 2, 2), material("cotton")).along(direction)
    loads = np.array([0.0, 1e-7, 1e-3, 0.01, 0.1, 0.5])
    np.testing.assert_allclose(along.stress(along.strain(loads)), loads, rtol=1e-3)
    assert along.stress(100.0) == pytest.approx(10.0)
