"""Yarn parameters of materials in charts."""

from dataclasses import replace

import pytest

from knitcore import Fabric, StitchChart, material
from knitcore.materials import load_library
from knitcore.yarn.library.yarns import phase_shares, yarn_for, yarn_friction
from knitcore.yarn.model.paper_samples import sample
from tests.knitcore.refusals import refuses


@pytest.mark.parametrize("fabric", list(Fabric))
@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_a_pure_fabric_has_the_parameters_of_its_sample(name, fabric):
    used = yarn_for(material(name), StitchChart.of_fabric(fabric, 2, 2))
    entry = sample(name, fabric)
    assert used.loop_length_mm == entry.loop_length_mm
    assert used.yarn.radius_mm == entry.yarn.radius_mm
    assert used.yarn.contact_stiffness_n_per_mm3 == pytest.approx(
        entry.yarn.contact_stiffness_n_per_mm3
    )
    assert not used.estimated


def test_a_mixed_repeat_has_the_mean_over_its_quarters():
    chart = StitchChart.parse("KKPP")
    assert phase_shares(chart) == {Fabric.STOCKINETTE: 0.5, Fabric.RIB: 0.5}
    used = yarn_for(material("cotton"), chart)
    assert used.loop_length_mm == pytest.approx((12.28 + 17.94) / 2)
    assert "mean" in used.provenance


def test_other_yarns_are_estimated_and_labelled():
    used = yarn_for(material("lace-cashmere"), StitchChart.parse("K"))
    assert used.estimated
    assert "estimated" in used.provenance
    record = material("lace-cashmere").record(Fabric.STOCKINETTE)
    assert used.loop_length_mm == record.loop_length_mm
    # proportions of worsted yarn: radius between 5 and 7 % of the loop
    assert 0.04 < used.yarn.radius_mm / used.loop_length_mm < 0.08
    assert 0.3 < used.yarn.core_radius_mm / used.yarn.radius_mm < 0.6


def test_a_loop_length_may_stand_in_for_a_missing_one():
    lace = material("lace-cashmere")
    record = replace(lace.record(Fabric.STOCKINETTE), loop_length_mm=None)
    unknown = replace(lace, fabrics={**lace.fabrics, Fabric.STOCKINETTE: record})
    stitch = StitchChart.parse("K")
    known = yarn_for(lace, stitch)
    assert yarn_for(unknown, stitch, known.loop_length_mm) == known
    alike = lace.record(Fabric.GARTER).loop_length_mm
    assert yarn_for(unknown, stitch).loop_length_mm == pytest.approx(alike)
    with refuses("material", "has no loop length"):
        yarn_for(replace(lace, fabrics={Fabric.STOCKINETTE: record}), stitch)


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
