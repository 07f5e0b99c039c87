"""Stitch numbers from loop lengths."""

import pytest

from knitcore.base.errors import InputError
from knitcore.machine.dial import Dial, with_swatches
from knitcore.machine.profile import DialSwatch, MachineProfile, profile

KNITERATE = profile("kniterate")
TWO = (DialSwatch(5, 9.2, "wool"), DialSwatch(7, 11.6, "wool"))


def dial_of(*swatches: DialSwatch, machine: MachineProfile = KNITERATE) -> Dial:
    return Dial(with_swatches(machine, swatches), "wool")


def test_two_swatches_give_the_line_between_them() -> None:
    dial = dial_of(*TWO)
    assert dial.loop_length_mm(5)[0] == pytest.approx(9.2, rel=0.02)
    assert dial.loop_length_mm(7)[0] == pytest.approx(11.6, rel=0.02)
    setting = dial.setting(10.4)
    assert setting.number == 6
    assert not setting.guessed
    low, high = setting.loop_length_interval_mm
    assert low < 10.4 < high


def test_swatches_narrow_the_guess() -> None:
    def width(*swatches: DialSwatch) -> float:
        low, high = dial_of(*swatches).loop_length_mm(6)[1]
        return high - low

    assert width() > width(TWO[0]) > width(*TWO) > width(*TWO, DialSwatch(6, 10.4, "wool"))


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
    swatches = DialSwatch(40, 5.2, "wool"), DialSwatch(50, 6.4, "wool")
    assert dial_of(*swatches, machine=profile("swg091n2")).setting(5.8).number == 45
    with pytest.raises(InputError, match="two numbers"):
        with_swatches(profile("swg091n2"), swatches[:1])


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
        with_swatches(KNITERATE, swatches)


def test_a_loop_that_no_number_makes_is_refused_with_those_that_are_made() -> None:
    with pytest.raises(InputError, match="makes loops of about"):
        dial_of(*TWO).setting(30)


def test_swatches_are_kept_in_the_profile_with_what_they_say() -> None:
    machine = with_swatches(KNITERATE, [*TWO, DialSwatch(6, 12.0, "cotton")])
    again = MachineProfile.read(machine.to_json())
    assert again == machine
    assert Dial(again, "wool").setting(10.4).number == 6
    assert len(Dial(again, "cotton").swatches) == 1
    assert Dial(again, "silk").setting(11.0).guessed
    words = again.source("swatches")
    assert "wool: stitch number 6 gives loops of 10.4 mm (9." in words
    assert "by 2 swatches" in words
    assert with_swatches(machine, TWO) == machine


def test_a_loop_out_of_reach_has_a_nearest_number() -> None:
    assert dial_of(*TWO).nearest(30).number == KNITERATE.stitch_number.most
