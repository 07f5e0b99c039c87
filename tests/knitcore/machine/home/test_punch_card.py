"""Punch cards."""

import numpy as np
import pytest

from knitcore import InputError, StitchChart
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.home.punch_card import LEAST_ROWS, STITCHES, punch_card
from knitcore.machine.profile import profile

BROTHER, SILVER_REED = profile("brother"), profile("silver-reed")


@pytest.mark.parametrize("width", [2, 3, 4, 6, 8, 12, 24])
def test_repeats_that_divide_24_go_round(width: int) -> None:
    row = "P" + "K" * (width - 1) if width > 1 else "P"
    chart = StitchChart.parse(row + "\n" + "K" * width).resized(10, 5 * 24)
    card = punch_card(chart, BROTHER)
    assert card.holes.shape == (LEAST_ROWS, STITCHES)
    assert card.repeat_rows == 2
    assert not card.holes[0].any()
    marks = np.flatnonzero(card.holes[1])
    assert set(np.diff(marks)) <= {width}
    assert len(marks) == 24 // width


def test_the_card_lies_on_the_bed_as_its_middle_says() -> None:
    """A wide piece and the same piece of 24 stitches have one card."""
    chart = StitchChart.parse("KPPPKKKKPKKK\nPKKKKKKPPKKK")
    wide, narrow = (punch_card(chart.resized(6, width), BROTHER) for width in (72, 24))
    assert np.array_equal(wide.holes, narrow.holes)
    away = chart.resized(6, 24).purl[0, ::-1]
    assert np.array_equal(narrow.holes[0], away)


def test_a_piece_of_up_to_24_stitches_needs_no_repeat() -> None:
    card = punch_card(StitchChart.parse("KPKKKPK"), BROTHER)
    assert np.flatnonzero(card.holes[0]).tolist() == [9, 13]
    assert any("L4 to R3" in note for note in card.notes)


@pytest.mark.parametrize(
    ("width", "nearest"), [(5, "of 4 or 6 stitches"), (10, "of 8 or 12"), (30, "of 24 stitches")]
)
def test_other_repeats_are_refused_with_the_nearest_that_fit(width: int, nearest: str) -> None:
    chart = StitchChart.parse("P" + "K" * (width - 1)).resized(4, 2 * width + 30)
    with pytest.raises(InputError, match=nearest):
        punch_card(chart, BROTHER)


def test_the_ends_have_full_rows_for_the_joint() -> None:
    card = punch_card(StitchChart.of_fabric("rib", rows=4, columns=24), BROTHER)
    assert card.lines[:2] == card.lines[-2:] == ("x" * 24,) * 2
    assert len(card.lines) == LEAST_ROWS + 4
    assert card.text.splitlines()[2].endswith("36")


def test_a_silver_reed_takes_colours_only() -> None:
    with pytest.raises(InputError, match="inside its carriage"):
        punch_card(StitchChart.of_fabric("rib", rows=4, columns=24), SILVER_REED)
    yarns = (PieceYarn("wool", "#ffffff"), PieceYarn("silk", "#ff0000"))
    chart = ShapedChart.rectangle(StitchChart(np.zeros((1, 24), dtype=bool)))
    piece = Piece(chart, yarns, (np.arange(24) % 3 == 0).astype(int)[None])
    card = punch_card(piece, SILVER_REED)
    assert (card.reads_below, card.holes[0].sum()) == (5, 8)


def test_an_outline_leaves_the_pattern_whole() -> None:
    purl = StitchChart.parse("PKK").resized(9, 48)
    stitch = np.ones(purl.purl.shape, dtype=bool)
    stitch[4:, :5] = stitch[6:, -7:] = False
    shaped = punch_card(Piece.plain(ShapedChart(purl, stitch)), BROTHER)
    assert np.array_equal(shaped.holes, punch_card(purl, BROTHER).holes)


def test_machines_without_cards_are_refused() -> None:
    with pytest.raises(InputError, match="reads no punch cards"):
        punch_card(StitchChart.of_fabric("rib", rows=4, columns=24), profile("ayab"))
