from __future__ import annotations

import pytest

from knitcore import Direction, Fabric, StitchChart
from knitcore.answer.stored import known_repeat
from knitcore.materials import material
from knitcore.mechanics.homogenisation import homogenise
from knitcore.yarnlibrary.store import stored_charts, stored_stitch

BASKET = StitchChart.parse("KKPP\nKKPP\nPPKK\nPPKK")
MOSS = StitchChart.parse("PK\nPK\nKP\nKP")


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_a_basket_is_softer_than_its_flat_composite(name: str) -> None:
    """It folds at rest and unfolds first when it is pulled along the course."""
    known = known_repeat(BASKET, material(name))
    assert known is not None
    flat = homogenise(BASKET, material(name))
    assert known.law.modulus_course < flat.modulus_n_per_mm(Direction.COURSE)
    record = material(name).record(Fabric.SEED)
    assert known.relaxed.course_mm < record.stitch_course_mm


def test_shifted_turned_and_cut_it_is_the_same_cloth() -> None:
    acrylic = material("acrylic")
    known = known_repeat(MOSS, acrylic)
    assert known is not None
    for chart in (MOSS.turn_over(), MOSS.mirror_vertical(), MOSS.resized(11, 9)):
        again = known_repeat(chart, acrylic)
        assert again is not None
        assert again.law == known.law
        assert again.relaxed == known.relaxed


@pytest.mark.parametrize("text", ["K", "K\nP", "KP", "KP\nPK", "KKPP", "K\nK\nP\nP"])
def test_pure_fabrics_ribs_and_welts_have_better_sources(text: str) -> None:
    assert known_repeat(StitchChart.parse(text), material("acrylic")) is None


def test_other_yarns_and_other_charts_are_unknown() -> None:
    assert known_repeat(BASKET, material("glove-wool")) is None
    assert known_repeat(StitchChart.parse("KKKKKPKPKKPPKPPKKK"), material("acrylic")) is None


@pytest.mark.parametrize("name", ["acrylic", "cotton"])
def test_a_law_through_a_jump_says_so(name: str) -> None:
    told = set()
    for chart in stored_charts(name):
        known = known_repeat(chart, material(name))
        stored = stored_stitch(chart, name)
        if known is not None and stored is not None:
            assert bool(known.notes) == any(stored.law_jumps)
            told.add(bool(known.notes))
    assert told == {True, False}
