"""The pressure of a tube of any chart."""

from __future__ import annotations

import pytest

from knitcore.answer.choose import choose
from knitcore.answer.tube import tube_for, tube_pressure
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.materials import material
from knitcore.mechanics.pressure import MMHG_PER_KPA, limb_pressure

ACRYLIC = material("acrylic")
RIB = StitchChart.parse("KKPP\nKKPP")


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_presses_as_its_law_says(fabric: Fabric, direction: Direction) -> None:
    chart = StitchChart.of_fabric(fabric, rows=2, columns=2)
    found = tube_pressure(choose(chart, ACRYLIC).along(direction), 200.0, 240.0)
    law = limb_pressure(ACRYLIC.law(fabric), direction, 200.0, 240.0)
    assert (found.kpa.low, found.kpa.high) == pytest.approx((law.kpa.low, law.kpa.high), rel=2e-3)
    assert found.axial_strain_free == pytest.approx(law.axial_strain_free, rel=2e-3)


def test_the_size_for_a_pressure_gives_that_pressure() -> None:
    along = choose(RIB, ACRYLIC).along(Direction.COURSE)
    sizes = tube_for(along, 250.0, 15.0)
    loose, tight = (tube_pressure(along, size, 250.0).kpa for size in (sizes.high, sizes.low))
    assert loose.high * MMHG_PER_KPA == pytest.approx(15.0, rel=1e-3)
    assert tight.low * MMHG_PER_KPA == pytest.approx(15.0, rel=1e-3)


@pytest.mark.parametrize(
    ("rest", "worn", "field"),
    [(0.0, 200.0, "rest_mm"), (200.0, 190.0, "worn_mm"), (50.0, 4000.0, "worn_mm")],
)
def test_impossible_tubes_are_refused(rest: float, worn: float, field: str) -> None:
    with pytest.raises(InputError) as refused:
        tube_pressure(choose(RIB, ACRYLIC).along(Direction.COURSE), rest, worn)
    assert refused.value.field == field
