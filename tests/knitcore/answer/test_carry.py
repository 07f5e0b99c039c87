"""Carrying a yarn-level law over to a measured material."""

import pytest

from knitcore.answer.carry import carried_law
from knitcore.answer.prediction import predict
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.materials import material

SIMULATED = {f: material("acrylic:simulation").law(f) for f in Fabric}


@pytest.mark.parametrize("fabric", Fabric)
def test_pure_fabrics_get_their_measured_moduli_and_stiffening(fabric):
    acrylic = material("acrylic")
    repeat = StitchChart.of_fabric(fabric, 2, 2)
    law = carried_law(SIMULATED[fabric], SIMULATED, repeat, acrylic)
    for direction in Direction:
        assert law.modulus(direction) == pytest.approx(acrylic.law(fabric).modulus(direction))
        assert law.lock_up_strain(direction) == pytest.approx(
            acrylic.law(fabric).lock_up_strain(direction)
        )
    assert law.beta_xx == pytest.approx(acrylic.law(fabric).beta_xx)
    assert law.poisson_xy * law.poisson_yx == pytest.approx(
        SIMULATED[fabric].poisson_xy * SIMULATED[fabric].poisson_yx
    )


def test_mixed_repeats_take_the_mean_ratio_of_their_phases():
    acrylic, repeat = material("acrylic"), StitchChart.parse("KKPP")
    law = carried_law(SIMULATED[Fabric.RIB], SIMULATED, repeat, acrylic)
    ratios = [
        acrylic.law(f).modulus_course / SIMULATED[f].modulus_course
        for f in (Fabric.STOCKINETTE, Fabric.RIB)
    ]
    expected = SIMULATED[Fabric.RIB].modulus_course * (ratios[0] * ratios[1]) ** 0.5
    assert law.modulus_course == pytest.approx(expected)
    found = predict(repeat, acrylic, repeat_law=law)
    assert found.provenance == "yarn level"


def test_every_phase_must_be_known():
    with pytest.raises(InputError, match="lacks rib"):
        carried_law(
            SIMULATED[Fabric.RIB],
            {Fabric.STOCKINETTE: SIMULATED[Fabric.STOCKINETTE]},
            StitchChart.parse("KKPP"),
            material("acrylic"),
        )
