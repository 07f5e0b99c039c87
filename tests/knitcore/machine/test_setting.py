"""Machines set for the loops of a piece."""

import re
from dataclasses import replace

import pytest

from knitcore import InputError, StitchChart, material
from knitcore.garment.piece import Piece
from knitcore.machine.dial import with_swatches
from knitcore.machine.profile import DialSwatch, profile
from knitcore.machine.setting import setting_of
from knitcore.materials.yarn_per_stitch import MeasuredYarn

KNITERATE = profile("kniterate")
RIB = Piece.of(StitchChart.of_fabric("rib", rows=4, columns=8))
WOOL = material("glove-wool")
TWO = DialSwatch(5, 9.2, "glove-wool"), DialSwatch(8, 12.8, "glove-wool")


def test_swatches_set_the_number_and_its_loops() -> None:
    setting = setting_of(RIB, with_swatches(KNITERATE, TWO), WOOL, measured=MeasuredYarn(10.4))
    assert setting.number == 6
    assert setting.yarn is not None
    assert setting.yarn.loop_length_mm == pytest.approx(10.4, rel=0.02)
    assert "by your swatches" in setting.note


def test_swatches_of_another_yarn_say_nothing() -> None:
    other = with_swatches(KNITERATE, [replace(swatch, yarn="silk") for swatch in TWO])
    assert setting_of(RIB, other, WOOL) == setting_of(RIB, KNITERATE, WOOL)


def test_without_swatches_the_number_is_a_guess() -> None:
    assert "a guess from the gauge" in setting_of(RIB, KNITERATE, WOOL).note


def test_numbers_of_a_table_start_with_the_machines_own() -> None:
    shima = profile("swg091n2")
    setting = setting_of(RIB, shima, WOOL)
    assert setting.number == shima.stitch_number.default
    assert "a start" in setting.note


def test_a_number_that_is_given_gives_the_loops() -> None:
    few, many = (setting_of(RIB, KNITERATE, WOOL, stitch_number=n) for n in (3, 8))
    assert few.yarn is not None
    assert many.yarn is not None
    assert few.yarn.loop_length_mm < many.yarn.loop_length_mm
    assert few.note == "Stitch number 3, as given."


def test_loops_that_no_number_gives_have_the_nearest() -> None:
    setting = setting_of(RIB, KNITERATE, WOOL, measured=MeasuredYarn(30))
    assert setting.number == KNITERATE.stitch_number.most
    assert "nearest to the 30.0 mm" in setting.note


def test_swatches_that_cannot_be_right_are_refused() -> None:
    wrong = replace(KNITERATE, swatches=(DialSwatch(5, 900, "glove-wool"),))
    with pytest.raises(InputError, match="do not fit"):
        setting_of(RIB, wrong, WOOL)


def test_dials_of_home_machines_have_thirds() -> None:
    note = setting_of(RIB, profile("brother"), WOOL).note
    match = re.match(r"Stitch number (\S+) \(dial at (\d+)(•*)\)", note)
    assert match is not None
    assert abs(float(match[1]) - int(match[2]) - len(match[3]) / 3) < 1 / 6 + 1e-9
