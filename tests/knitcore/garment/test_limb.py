"""A tube of any chart on a limb."""

import pytest

from knitcore import Direction, Fabric, InputError, StitchChart, material, predict
from knitcore.garment.limb import PLACES, on_limb, tube_for, tube_pressure
from knitcore.mechanics.pressure import MMHG_PER_KPA, limb_pressure
from tests.knitcore.refusals import refuses

ACRYLIC = material("acrylic")
CHART = StitchChart.parse("KKPP\nKKPP")
RIB = predict(StitchChart.parse("KP"), material("acrylic")).along(Direction.COURSE)


def test_on_a_cylinder_it_presses_everywhere_as_a_tube() -> None:
    places = on_limb(RIB, [0.0, 100.0], [190.0, 190.0], [150.0, 150.0])
    expected = tube_pressure(RIB, 150.0, 190.0)
    assert len(places) == PLACES
    assert {place.pressure for place in places} == {expected}
    assert places[0].ease == pytest.approx(150.0 / 190.0 - 1.0)


def test_on_a_cone_it_is_tightest_at_the_wide_end_and_loose_at_the_narrow_one() -> None:
    places = on_limb(RIB, [0.0, 50.0, 100.0], [140.0, 170.0, 240.0], [150.0] * 3, places=11)
    assert places[0].pressure is None
    assert places[0].problem
    shares = [place.lock_up_share for place in places]
    assert shares[0] == 0.0
    assert max(shares) == shares[-1] < 1.0
    assert places[5].girth_mm == pytest.approx(170.0)


def test_beyond_its_lock_up_it_cannot_be_worn() -> None:
    places = on_limb(RIB, [0.0, 10.0], [160.0, 2000.0], [150.0, 150.0], places=2)
    assert places[0].pressure is not None
    assert places[1].pressure is None
    assert places[1].lock_up_share > 1.0


@pytest.mark.parametrize(
    ("at", "girths"), [([0.0], [100.0]), ([0.0, 0.0], [100.0, 100.0]), ([0.0, 1.0], [100.0, 9.9])]
)
def test_impossible_limbs_are_refused(at: list[float], girths: list[float]) -> None:
    with pytest.raises(InputError):
        on_limb(RIB, at, girths, [90.0] * len(at))


@pytest.mark.parametrize("direction", list(Direction))
@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_presses_as_its_law_says(fabric: Fabric, direction: Direction) -> None:
    chart = StitchChart.of_fabric(fabric, rows=2, columns=2)
    tube = tube_pressure(predict(chart, ACRYLIC).along(direction), 200.0, 240.0)
    law = limb_pressure(ACRYLIC.law(fabric), direction, 200.0, 240.0)
    assert (tube.kpa.low, tube.kpa.high) == pytest.approx((law.kpa.low, law.kpa.high), rel=2e-3)
    assert tube.axial_strain_free == pytest.approx(law.axial_strain_free, rel=2e-3)


def test_the_size_for_a_pressure_gives_that_pressure() -> None:
    along = predict(CHART, ACRYLIC).along(Direction.COURSE)
    sizes = tube_for(along, 250.0, 15.0)
    loose, tight = (tube_pressure(along, size, 250.0).kpa for size in (sizes.high, sizes.low))
    assert loose.high * MMHG_PER_KPA == pytest.approx(15.0, rel=1e-3)
    assert tight.low * MMHG_PER_KPA == pytest.approx(15.0, rel=1e-3)


@pytest.mark.parametrize(
    ("rest", "worn", "field"),
    [(0.0, 200.0, "rest_mm"), (200.0, 190.0, "worn_mm"), (50.0, 4000.0, "worn_mm")],
)
def test_impossible_tubes_are_refused(rest: float, worn: float, field: str) -> None:
    with refuses(field):
        tube_pressure(predict(CHART, ACRYLIC).along(Direction.COURSE), rest, worn)
