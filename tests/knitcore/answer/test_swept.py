"""Repeats that were stretched on the yarn level, as a measured material has them."""

from __future__ import annotations

import pytest

from knitcore import Direction, Fabric, InputError, StitchChart
from knitcore.answer.composite import composite
from knitcore.answer.repeat import Repeat
from knitcore.answer.swept import JUMPS, law_in_material, swept
from knitcore.materials import material
from knitcore.yarnlibrary.store import stored_charts, stored_stitch

BASKET = Repeat.of(StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK"))
MOSS = StitchChart.parse("PK\nPK\nKP\nKP")
SIMULATED = {f: material("acrylic:simulation").law(f) for f in Fabric}


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_a_basket_is_softer_than_its_flat_composite(name: str) -> None:
    """It folds at rest and unfolds first when it is pulled along the course."""
    found = swept(BASKET, material(name))
    assert found is not None
    flat = composite(BASKET, material(name))
    assert found.modulus_course_n_per_mm < flat.modulus_course_n_per_mm
    assert found.relaxed_course_mm < material(name).record(Fabric.SEED).stitch_course_mm


def test_shifted_turned_and_cut_it_is_the_same_cloth() -> None:
    acrylic = material("acrylic")
    found = swept(Repeat.of(MOSS), acrylic)
    assert found is not None
    for chart in (MOSS.turn_over(), MOSS.mirror_vertical(), MOSS.resized(11, 9)):
        again = swept(Repeat.of(chart), acrylic)
        assert again is not None
        for direction in Direction:
            one, other = found.along(direction), again.along(direction)
            assert one.response == other.response
            assert one.relaxed_mm == other.relaxed_mm


@pytest.mark.parametrize("text", ["K", "K\nP", "KP", "KP\nPK", "KKPP", "K\nK\nP\nP"])
def test_pure_fabrics_ribs_and_welts_have_better_sources(text: str) -> None:
    assert swept(Repeat.of(StitchChart.parse(text)), material("acrylic")) is None


def test_other_yarns_and_other_charts_are_unknown() -> None:
    assert swept(BASKET, material("glove-wool")) is None
    long = Repeat.of(StitchChart.parse("KKKKKPKPKK\nPPKPPPKKKP"))
    assert swept(long, material("acrylic")) is None


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_a_law_through_a_jump_says_so(name: str) -> None:
    seen = set()
    for chart in stored_charts(name):
        found = swept(Repeat.of(chart.tile(2, 2)), material(name))
        stored = stored_stitch(chart, name)
        if found is not None and stored is not None:
            assert (JUMPS in found.notes) == any(stored.law_jumps)
            seen.add(JUMPS in found.notes)
    assert seen == {True, False}


@pytest.mark.parametrize("fabric", Fabric)
def test_pure_fabrics_get_their_measured_moduli_and_stiffening(fabric: Fabric) -> None:
    acrylic = material("acrylic")
    repeat = Repeat.of(StitchChart.of_fabric(fabric, 2, 2))
    law = law_in_material(SIMULATED[fabric], SIMULATED, repeat, acrylic)
    for direction in Direction:
        assert law.modulus(direction) == pytest.approx(acrylic.law(fabric).modulus(direction))
        assert law.lock_up_strain(direction) == pytest.approx(
            acrylic.law(fabric).lock_up_strain(direction)
        )
    assert law.beta_xx == pytest.approx(acrylic.law(fabric).beta_xx)
    assert law.poisson_xy * law.poisson_yx == pytest.approx(
        SIMULATED[fabric].poisson_xy * SIMULATED[fabric].poisson_yx
    )


def test_mixed_repeats_take_the_mean_ratio_of_their_phases() -> None:
    acrylic, repeat = material("acrylic"), Repeat.of(StitchChart.parse("KKPP"))
    law = law_in_material(SIMULATED[Fabric.RIB], SIMULATED, repeat, acrylic)
    ratios = [
        acrylic.law(f).modulus_course / SIMULATED[f].modulus_course
        for f in (Fabric.STOCKINETTE, Fabric.RIB)
    ]
    expected = SIMULATED[Fabric.RIB].modulus_course * (ratios[0] * ratios[1]) ** 0.5
    assert law.modulus_course == pytest.approx(expected)


def test_every_phase_must_be_known() -> None:
    rib = Repeat.of(StitchChart.parse("KKPP"))
    plain = {Fabric.STOCKINETTE: SIMULATED[Fabric.STOCKINETTE]}
    with pytest.raises(InputError, match="lacks rib"):
        law_in_material(SIMULATED[Fabric.RIB], plain, rib, material("acrylic"))
