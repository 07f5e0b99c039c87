"""A repeat's law from the yarn level, as a measured material has it."""

from __future__ import annotations

import pytest

from knitcore import Direction, Fabric, InputError, StitchChart
from knitcore.answer.swept import law_in_material, swept_answer
from knitcore.materials import material

SIMULATED = {f: material("acrylic:simulation").law(f) for f in Fabric}


@pytest.mark.parametrize("fabric", Fabric)
def test_pure_fabrics_get_their_measured_moduli_and_stiffening(fabric: Fabric) -> None:
    acrylic = material("acrylic:published")
    repeat = StitchChart.of_fabric(fabric, 2, 2)
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
    acrylic, repeat = material("acrylic:published"), StitchChart.parse("KKPP")
    law = law_in_material(SIMULATED[Fabric.RIB], SIMULATED, repeat, acrylic)
    ratios = [
        acrylic.law(f).modulus_course / SIMULATED[f].modulus_course
        for f in (Fabric.STOCKINETTE, Fabric.RIB)
    ]
    expected = SIMULATED[Fabric.RIB].modulus_course * (ratios[0] * ratios[1]) ** 0.5
    assert law.modulus_course == pytest.approx(expected)


def test_every_phase_must_be_known() -> None:
    rib = StitchChart.parse("KKPP")
    plain = {Fabric.STOCKINETTE: SIMULATED[Fabric.STOCKINETTE]}
    with pytest.raises(InputError, match="lacks rib"):
        law_in_material(SIMULATED[Fabric.RIB], plain, rib, material("acrylic:published"))


def test_sizes_are_carried_over_by_their_ratio_to_a_pure_fabric() -> None:
    acrylic, rib = material("acrylic:published"), StitchChart.parse("KKPP")
    found = swept_answer(SIMULATED[Fabric.RIB], (1.2, 2.2), SIMULATED, (1.5, 2.2), rib, acrylic)
    record = acrylic.record(Fabric.RIB)
    assert found.provenance == "swept"
    assert found.relaxed_course_mm == pytest.approx(0.8 * record.stitch_course_mm)
    assert found.relaxed_wale_mm == pytest.approx(record.stitch_wale_mm)
