"""A tube along a limb."""

from __future__ import annotations

import pytest

from knitcore.answer.choose import choose
from knitcore.answer.limb import PLACES, on_limb
from knitcore.answer.tube import tube_pressure
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction
from knitcore.materials import material

RIB = choose(StitchChart.parse("KP"), material("acrylic")).along(Direction.COURSE)


def test_on_a_cylinder_it_presses_everywhere_as_a_tube() -> None:
    found = on_limb(RIB, [0.0, 100.0], [190.0, 190.0], [150.0, 150.0])
    expected = tube_pressure(RIB, 150.0, 190.0)
    assert len(found) == PLACES
    assert {place.pressure for place in found} == {expected}
    assert found[0].ease == pytest.approx(150.0 / 190.0 - 1.0)


def test_on_a_cone_it_is_tightest_at_the_wide_end_and_loose_at_the_narrow_one() -> None:
    found = on_limb(RIB, [0.0, 50.0, 100.0], [140.0, 170.0, 240.0], [150.0] * 3, places=11)
    assert found[0].pressure is None
    assert found[0].problem
    shares = [place.lock_up_share for place in found]
    assert shares[0] == 0.0
    assert max(shares) == shares[-1] < 1.0
    assert found[5].girth_mm == pytest.approx(170.0)


def test_beyond_its_lock_up_it_cannot_be_worn() -> None:
    found = on_limb(RIB, [0.0, 10.0], [160.0, 2000.0], [150.0, 150.0], places=2)
    assert found[0].pressure is not None
    assert found[1].pressure is None
    assert found[1].lock_up_share > 1.0


@pytest.mark.parametrize(
    ("at", "girths"),
    [([0.0], [100.0]), ([0.0, 0.0], [100.0, 100.0]), ([0.0, 1.0], [100.0, 9.9])],
)
def test_impossible_limbs_are_refused(at: list[float], girths: list[float]) -> None:
    with pytest.raises(InputError):
        on_limb(RIB, at, girths, [90.0] * len(at))
