"""A yarn says what it serves for."""

from dataclasses import replace

from knitcore.chart.fabric import Fabric
from knitcore.materials import material
from knitcore.materials.estimate.without_tester import KnownSwatch, yarn_without_tester
from knitcore.materials.uses import Serves, uses_of


def test_a_yarn_of_the_library_serves_for_all() -> None:
    assert {use.serves for use in uses_of(material("acrylic"))} == {Serves.YES}


def test_two_tests_alone_do_not_serve_for_charts() -> None:
    acrylic = material("acrylic")
    record = replace(acrylic.record(Fabric.STOCKINETTE), loop_length_mm=None)
    yarn = replace(acrylic.yarn, bending_modulus_n_mm2=None)
    alone = replace(acrylic, fabrics={Fabric.STOCKINETTE: record}, yarn=yarn)
    charts, sizes, amount, level = uses_of(alone)
    assert charts.serves is amount.serves is level.serves is Serves.NO
    assert "garter, rib, seed" in charts.missing
    assert "unravel ten" in amount.missing
    assert "bending stiffness" in level.missing
    assert sizes.serves is Serves.YES


def test_one_loop_length_says_roughly_what_the_others_are() -> None:
    acrylic = material("acrylic")
    rib = replace(acrylic.record(Fabric.RIB), loop_length_mm=None)
    *_, amount, level = uses_of(replace(acrylic, fabrics={**acrylic.fabrics, Fabric.RIB: rib}))
    assert amount.serves is level.serves is Serves.ROUGHLY
    assert "rib: unravel ten" in amount.missing


def test_a_yarn_without_a_pull_serves_roughly() -> None:
    yarn = yarn_without_tester(KnownSwatch(Fabric.RIB, 20, 28)).material("mine")
    charts, *sizes, amount, level = uses_of(yarn)
    assert charts.serves is level.serves is Serves.ROUGHLY
    assert amount.serves is Serves.YES
    assert all(use.serves is Serves.ROUGHLY and "photos or tests" in use.missing for use in sizes)
