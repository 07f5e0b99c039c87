"""Pictures for AYAB."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore import InputError, StitchChart
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.home.ayab import NEEDLES, ayab_picture
from knitcore.machine.profile import profile

WIDE = replace(profile("ayab"), needles=300)
RIBBER = profile("brother-ribber")


def test_row_1_is_the_lowest_line_and_the_face_away_is_mirrored() -> None:
    picture = ayab_picture(StitchChart.parse("KKKK\nPKKK"), profile("ayab"))
    assert picture.grey.tolist() == [[255] * 4, [255, 255, 255, 0]]
    assert picture.mode == "Singlebed"
    assert any("needles L2 to R2" in note for note in picture.notes)


def test_yarns_are_told_apart_by_grey() -> None:
    yarns = tuple(PieceYarn(name, "#ffffff") for name in "abc")
    chart = ShapedChart.rectangle(StitchChart(np.zeros((1, 6), dtype=bool)))
    picture = ayab_picture(Piece(chart, yarns, np.array([[0, 0, 0, 1, 1, 2]])), RIBBER)
    assert picture.grey.tolist() == [[0, 128, 128, 255, 255, 255]]
    assert picture.mode == "Ribber: Classic"
    assert any("white a; grey b; black c" in note for note in picture.notes)


def test_what_ayab_would_cut_off_is_refused() -> None:
    ayab_picture(StitchChart.of_fabric("rib", rows=2, columns=NEEDLES), profile("ayab"))
    with pytest.raises(InputError, match="wider than the 200 needles"):
        ayab_picture(StitchChart.of_fabric("rib", rows=2, columns=NEEDLES + 1), WIDE)


def test_machines_that_ayab_does_not_drive_are_refused() -> None:
    with pytest.raises(InputError, match="not Silver Reed's"):
        ayab_picture(StitchChart.parse("PKKK"), profile("silver-reed"))


def test_more_yarns_than_ayab_takes_are_refused() -> None:
    yarns = tuple(PieceYarn(str(i), "#ffffff") for i in range(7))
    chart = ShapedChart.rectangle(StitchChart(np.zeros((1, 7), dtype=bool)))
    with pytest.raises(InputError, match="at most 6 yarns"):
        ayab_picture(Piece(chart, yarns, np.arange(7)[None]), RIBBER)
