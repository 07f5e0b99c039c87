"""Stitch numbers from loop lengths."""

import pytest

from knitcore.base.errors import InputError
from knitcore.machine.dial import Dial, DialSwatch
from knitcore.machine.profile import profile

KNITERATE = profile("kniterate")
TWO = (DialSwatch(5, 9.2), DialSwatch(7, 11.6))


def test_two_swatches_give_the_line_between_them() -> None:
    dial = Dial(KNITERATE, "wool", TWO)
    assert dial.loop_length_mm(5)[0] == pytest.approx(9.2, rel=0.02)
    assert dial.loop_length_mm(7)[0] == pytest.approx(11.6, rel=0.02)
    setting = dial.setting(10.4)
    assert setting.number == 6
    assert not setting.guessed
    low, high = setting.loop_length_interval_mm
    assert low < 10.4 < high


def test_swatches_narrow_the_guess() -> None:
    def width(*swatches: DialSwatch) -> float:
        low, high = Dial(KNITERATE, "wool", swatches).loop_length_mm(6)[1]
        return high - low

    assert width() > width(TWO[0]) > width(*TWO) > width(*TWO, DialSwatch(6, 10.4))


def test_a_guess_grows_with_the_distance_of_the_needles() -> None:
    coarse = Dial(KNITERATE).setting(11.0)
    assert coarse.guessed
    assert "guess" in str(coarse)
    fine, default = Dial(profile("brother")), profile("brother").stitch_number.default
    ratio = fine.loop_length_mm(default)[0] / Dial(KNITERATE).loop_length_mm(6)[0]
    assert ratio == pytest.approx(profile("brother").pitch_mm / KNITERATE.pitch_mm)


def test_numbers_that_are_places_in_a_table_need_two_swatches() -> None:
    with pytest.raises(InputError, match="two numbers"):
        Dial(profile("swg091n2"))
    swatches = DialSwatch(40, 5.2), DialSwatch(50, 6.4)
    assert Dial(profile("swg091n2"), "lace", swatches).setting(5.8).number == 45


def test_a_swatch_is_weighed_or_unravelled() -> None:
    assert DialSwatch.unravelled(6, 104, 10) == DialSwatch(6, 10.4)
    assert DialSwatch.weighed(6, 2.6, 250, 1000) == DialSwatch(6, 10.4)


@pytest.mark.parametrize(
    ("swatches", "problem"),
    [
        ((DialSwatch(12, 9.0),), "no stitch number 12"),
        ((DialSwatch(5, 920.0),), "do not fit"),
        ((DialSwatch(3, 16.0), DialSwatch(8, 8.0)), "shorter loops"),
    ],
)
def test_swatches_that_cannot_be_right_are_refused(
    swatches: tuple[DialSwatch, ...], problem: str
) -> None:
    with pytest.raises(InputError, match=problem):
        Dial(KNITERATE, "wool", swatches)


def test_a_loop_that_no_number_makes_is_refused_with_those_that_are_made() -> None:
    with pytest.raises(InputError, match="makes loops of about"):
        Dial(KNITERATE, "wool", TWO).setting(30)


def test_a_dial_is_kept_in_a_file() -> None:
    dial = Dial(KNITERATE, "laine", TWO)
    assert Dial.read(dial.to_json().encode()) == dial
    assert Dial.read(dial.to_json(), [KNITERATE]).setting(10.4).to_dict()["number"] == 6
    with pytest.raises(InputError, match="no file of stitch numbers"):
        Dial.read(b"{}")
