"""Needles that a patterning machine selects."""

import numpy as np
import pytest

from knitcore import InputError, StitchChart
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.home.needle_selection import Selected, needle_selection
from knitcore.machine.profile import profile

YARNS = tuple(PieceYarn(name, "#ffffff") for name in ("wool", "silk", "linen"))


def coloured(yarn_of: list[list[int]], *, purls: bool = False) -> Piece:
    index = np.array(yarn_of)
    chart = StitchChart(np.full(index.shape, purls))
    return Piece(ShapedChart.rectangle(chart), YARNS, index)


def test_a_face_turned_away_is_mirrored_and_a_face_turned_to_the_knitter_is_not() -> None:
    away, toward = (
        needle_selection(Piece.plain(StitchChart.parse(text)), profile("ayab"))
        for text in ("PKKK", "KPPP")
    )
    assert away.levels.tolist() == [[0, 0, 0, 1]]
    assert toward.levels.tolist() == [[1, 0, 0, 0]]
    assert away.selected is Selected.HAND


def test_the_yarn_of_most_stitches_is_the_background() -> None:
    selection = needle_selection(coloured([[1, 1, 1, 0]]), profile("ayab"))
    assert selection.yarns == ("silk", "wool")
    assert selection.levels.tolist() == [[1, 0, 0, 0]]


def test_long_floats_are_announced() -> None:
    notes = needle_selection(coloured([[0] * 9 + [1] * 8]), profile("ayab")).notes
    assert any("passes 9 needles" in note for note in notes)
    notes = needle_selection(coloured([[0] * 2 + [1] * 3]), profile("ayab")).notes
    assert not any("float passes" in note for note in notes)


@pytest.mark.parametrize(
    ("piece", "machine", "problem"),
    [
        (Piece.plain(StitchChart.parse("KK\nKK")), "ayab", "nothing to select"),
        (Piece.plain(StitchChart.parse("PP\nPP")), "ayab", "nothing to select"),
        (coloured([[0, 1, 2, 0]]), "ayab", "one bed selects between two"),
        (
            Piece(
                ShapedChart.rectangle(StitchChart.parse("KPKK")), YARNS, np.array([[0, 0, 1, 1]])
            ),
            "ayab",
            "can mean only one",
        ),
        (coloured([[0, 1]]), "kniterate", "not worked by hand"),
    ],
)
def test_what_no_selection_can_knit_is_refused(piece: Piece, machine: str, problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        needle_selection(piece, profile(machine))


def test_a_ribber_takes_more_yarns() -> None:
    selection = needle_selection(coloured([[0, 1, 2, 0]]), profile("brother-ribber"))
    assert sorted(selection.levels[0].tolist()) == [0, 0, 1, 2]
