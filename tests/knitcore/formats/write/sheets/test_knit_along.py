"""Rows for whoever knits them."""

import numpy as np
import pytest

from knitcore import InputError, StitchChart
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.write.sheets.knit_along import knit_along
from knitcore.formats.write.written_pattern import write_rows
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.profile import profile

CHART = StitchChart.parse("KPKK\nPPKP\nKKPP")


def test_rows_are_seen_as_they_hang_on_the_needles() -> None:
    first, second, third = knit_along(CHART).rows
    assert (first.stitches, third.stitches) == ("KKPP", "KPKK")
    assert second.stitches == "KPKK"  # PPKP from behind: mirrored, and each stitch the other one
    assert [row.heading for row in (first, second)] == ["right side", "wrong side"]


def test_rounds_are_all_seen_from_the_right_side() -> None:
    along = knit_along(CHART, Construction.ROUND)
    assert [row.stitches for row in along.rows] == ["KKPP", "PPKP", "KPKK"]
    assert along.round
    assert {row.heading for row in along.rows} == {""}


@pytest.mark.parametrize("construction", list(Construction))
@pytest.mark.parametrize("side", list(Side))
def test_words_are_those_of_the_written_rows(construction: Construction, side: Side) -> None:
    chart = StitchChart.parse("KKPK\nPPKP\nKKPP")  # no two rows alike
    written = write_rows(chart, construction, first_side=side).splitlines()
    along = knit_along(chart, construction, first_side=side)
    assert along.opening == (written[0],)
    for row, line in zip(along.rows, written[1:-1], strict=True):
        assert row.words[0].lower() in line.lower()


@pytest.mark.parametrize("construction", list(Construction))
def test_rows_of_any_stitches_have_their_words(construction: Construction) -> None:
    chart = SymbolChart.parse("P[2/2R]P\nPKKKKP\nKO/\\OK\nTKPKKK\nKKKKPP")
    along = knit_along(chart, construction)
    written = write_rows(chart, construction).splitlines()
    for row, line in zip(along.rows, written[1:-1], strict=True):
        assert row.words[0].lower() in line.lower()
    plain = knit_along(chart.plain, construction)
    assert [row.stitches for row in along.rows] == [row.stitches for row in plain.rows]
    assert not plain.rows[0].codes
    assert along.rows[4].codes == ("P", "[2/2R]", "P")
    lace = along.rows[2].codes
    assert lace == ("K", "O", "/", "\\", "O", "K")
    tucked = ("t", "P", "K", "P", "P", "P")  # TKPKKK as the back shows it
    assert along.rows[1].codes == (along.rows[1].codes if along.round else tucked[::-1])
    with pytest.raises(InputError, match="yarn over"):
        knit_along(chart, machine=profile("brother"))


def test_rows_of_a_piece_lie_where_its_outline_has_them() -> None:
    piece = Piece.plain(ShapedChart.parse("KKKK\nKKKK\nKKKK", ".xx.\nxxx.\nxxxx"))
    rows = knit_along(piece).rows
    assert [(row.first, len(row.stitches)) for row in rows] == [(0, 4), (1, 3), (1, 2)]


@pytest.mark.parametrize("machine", [None, "brother", "brother-ribber"])
def test_yarns_are_counted_from_the_knitters_left(machine: str | None) -> None:
    yarns = (PieceYarn("wool", "#ffffff"), PieceYarn("silk", "#ff0000"))
    chart = ShapedChart.rectangle(StitchChart(np.zeros((1, 4), dtype=bool)))
    piece = Piece(chart, yarns, np.array([[0, 0, 0, 1]]))
    along = knit_along(piece, machine=profile(machine) if machine else None)
    assert along.rows[0].yarns == (((1, 1), (3, 0)) if machine else ((3, 0), (1, 1)))


def test_a_machine_has_its_plan() -> None:
    along = knit_along(StitchChart.of_fabric("rib", rows=3, columns=4), machine=profile("brother"))
    assert [row.heading for row in along.rows] == [
        "carriage at the right",
        "carriage at the left",
        "carriage at the right",
    ]
    assert along.rows[2].words[0] == "Knit 1 row."
    assert "latch up" in along.rows[2].words[1]
    assert along.marked == "to be latched up"


def test_the_pattern_is_counted_by_its_repeat() -> None:
    assert knit_along(StitchChart.parse("KP\nPK\nKK").tile(4, 3)).repeat_rows == 3


def test_rows_go_on_after_a_break() -> None:
    assert [row.number for row in knit_along(CHART, from_row=2).rows] == [2, 3]
    with pytest.raises(InputError, match="no row 4"):
        knit_along(CHART, from_row=4)
