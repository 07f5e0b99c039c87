"""The glove on a hand of simple bodies."""

import json
from pathlib import Path

import meshio
import numpy as np
import pytest

from knitcore import material
from knitcore.garment.glove import FINGERS, Finger, Hand
from knitcore.garment.worn_glove import GloveOnHand, glove_on_hand

WOOL = material("glove-wool:glove")
HAND = Hand()


@pytest.fixture(scope="module")
def worn() -> GloveOnHand:
    return glove_on_hand(HAND, WOOL, ease=-0.1)


def test_it_is_written_with_its_pressure_and_shown_in_brief(
    worn: GloveOnHand, tmp_path: Path
) -> None:
    worn.write(tmp_path / "x.vtu")
    mesh = meshio.read(tmp_path / "x.vtu")
    assert len(mesh.cells[0].data) == len(mesh.cell_data["mmhg"][0])
    assert len(repr(worn)) < 400
    plain = worn.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain
    assert plain["plan"]["regions"][0]["name"]


def test_every_stitch_has_a_place_and_its_face_outside(worn: GloveOnHand) -> None:
    corners, stitch = worn.corners_mm, worn.plan.shaped.stitch
    across = corners[1:, 1:] - corners[:-1, :-1], corners[1:, :-1] - corners[:-1, 1:]
    area = 0.5 * np.linalg.norm(np.cross(*across), axis=2)[stitch]
    assert area.min() > 0.01
    assert np.median(area) == pytest.approx(2.6 * 2.3, rel=0.3)
    # seen from in front, the back of the hand shows its face: columns turn to rows leftwards
    normal = np.cross(*across)[..., 2]
    back = np.zeros_like(stitch)
    back[: len(stitch) // 2] = True
    assert (normal[stitch & back] > 0.0).mean() > 0.9
    assert (normal[stitch & ~back] < 0.0).mean() > 0.9


def test_fingers_are_as_long_and_as_thick_as_the_hands(worn: GloveOnHand) -> None:
    stitch = worn.plan.shaped.stitch
    tips = stitch.shape[1] - stitch[:, ::-1].argmax(axis=1)
    longest = np.flatnonzero(tips == tips.max())
    back = longest[: len(longest) // 2]
    reach = np.ptp(worn.corners_mm[back, : tips.max() + 1, 1])
    whole = HAND.cuff_mm + HAND.wrist_mm + HAND.palm_mm + HAND.fingers[1].length_mm
    assert reach == pytest.approx(whole, rel=0.02)
    middle = tips.max() - 15
    around = worn.corners_mm[back[0] : back[-1] + 2, middle]
    half = np.linalg.norm(np.diff(around, axis=0), axis=1).sum()
    assert half == pytest.approx(0.5 * HAND.fingers[1].circumference_mm, rel=0.02)


def test_thinner_fingers_of_the_same_glove_are_pressed_more_and_parts_are_named() -> None:
    worn = glove_on_hand(HAND, WOOL, ease=-0.15)
    looser = glove_on_hand(HAND, WOOL, ease=-0.05)
    assert {"cuff", "wrist support", "base of the thumb", "thumb", "hand", *FINGERS} == set(
        worn.parts
    )
    tight, slack = worn.parts["index finger"], looser.parts["index finger"]
    assert tight.pressure is not None
    assert tight.ease < slack.ease
    assert slack.pressure is None or tight.pressure.kpa.low > slack.pressure.kpa.high


@pytest.mark.parametrize("ease", [-0.15, 0.05])
def test_the_plan_knows_the_fit_of_every_part(ease: float) -> None:
    worn = glove_on_hand(HAND, WOOL, ease=ease)
    planned = {place.part: place for place in worn.plan.worn}
    assert planned.keys() == worn.parts.keys()
    for name, place in worn.parts.items():
        known = planned[name]
        assert (known.at_mm, known.rest_mm, known.worn_mm) == pytest.approx(
            (place.at_mm, place.rest_mm, place.girth_mm)
        )
        assert (known.pressure is None) == (place.pressure is None)
        if known.pressure and place.pressure:
            assert known.pressure.kpa.high == pytest.approx(place.pressure.kpa.high, rel=2e-3)


def test_the_hands_skin_has_its_girths() -> None:
    hand = Hand(thumb=Finger(50.0, 70.0))
    forearm, *_ = glove_on_hand(hand, WOOL).body_mm
    ring = forearm[2]  # before it the closed end and the bare forearm
    around = np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1).sum()
    assert around == pytest.approx(hand.wrist_circumference_mm, rel=0.01)
