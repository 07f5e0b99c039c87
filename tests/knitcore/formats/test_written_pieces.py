"""Written rows of outlines and of several yarns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import InputError, StitchChart
from knitcore.chart.row_sides import Construction, Side
from knitcore.formats.designs.layout import layout_of, piece_of
from knitcore.formats.read.written_reader import read_piece_rows, read_rows
from knitcore.formats.write.written_pattern import write_rows
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from tests.knitcore.pieces import pieces


@settings(max_examples=150, deadline=None)
@given(piece=pieces(), first_side=st.sampled_from(Side))
def test_outlines_and_yarns_are_read_back(piece: Piece, first_side: Side) -> None:
    text = write_rows(piece, first_side=first_side)
    assert read_piece_rows(text) == piece.cropped()


@settings(max_examples=60, deadline=None)
@given(piece=pieces(step=1, yarns=1))
def test_outlines_in_the_round_are_read_back(piece: Piece) -> None:
    assert read_piece_rows(write_rows(piece, Construction.ROUND)) == piece.cropped()


@settings(max_examples=40, deadline=None)
@given(piece=pieces())
def test_a_layout_makes_the_piece_again(piece: Piece) -> None:
    assert piece_of(piece.chart, layout_of(piece)) == piece


@settings(max_examples=2, deadline=None)
@given(piece=pieces(most_rows=200, most_columns=150))
def test_large_pieces_are_read_back(piece: Piece) -> None:
    assert read_piece_rows(write_rows(piece)) == piece.cropped()


def shaped(outline: str) -> Piece:
    lines = outline.splitlines()
    return Piece.plain(ShapedChart.parse("\n".join("K" * len(lines[0]) for _ in lines), outline))


def test_edges_are_shaped_as_knitters_write_it() -> None:
    piece = shaped("xxxxxxx..\nxxxxxxxxx\nxxxxxx...\n.xxxxxxxx\n.xxxxxxxx\n..xxxxxx.\n..xxxxxx.")
    assert write_rows(piece).splitlines()[1:-1] == [
        "Row 1 (RS): Knit. (6 sts)",
        "Row 2 (WS): Purl. (6 sts)",
        "Row 3 (RS): K1, m1, k4, m1, k1. (8 sts)",
        "Row 4 (WS): Purl. (8 sts)",
        "Row 5 (RS): Bind off 3 sts, k4, m1, k1. (6 sts)",
        "Row 6 (WS): With a separate strand cast on 3 sts at the end, purl. (9 sts)",
        "Row 7 (RS): Bind off 2 sts, knit. (7 sts)",
    ]


def test_yarns_are_named() -> None:
    yarn_of = np.array([[0, 0, 0, 1, 1, 1]] * 2)
    yarns = (PieceYarn("cream", "#ffffee"), PieceYarn("blue", "#0000ff"))
    chart = StitchChart.of_fabric("seed", rows=2, columns=6)
    text = write_rows(Piece(ShapedChart.rectangle(chart), yarns, yarn_of))
    assert text.splitlines()[1:-1] == [
        "Yarn A: cream (#ffffee)",
        "Yarn B: blue (#0000ff)",
        "Row 1 (RS): With B p1, k1, p1, with A k1, p1, k1. (6 sts)",
        "Row 2 (WS): With A k1, p1, k1, with B p1, k1, p1. (6 sts)",
    ]


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ("Row 1: K2, ssk.", "ssk is stitch 3 of 3"),
        ("Row 1: K1, m1, k3, m1.", "m1 is stitch 6 of 6"),
        ("Row 1: Bind off 4 sts, knit.", "leaves no stitch"),
        ("Row 1: Ssk, k2. (4 sts)", "says 4 sts, but 3 are"),
        ("Row 1: Cast on 2 sts, k4.", "works 4 stitches, but 6 are"),
        ("Rows 1-2: Bind off 1 st, k3.", "does not fit the 3 stitches"),
        ("Yarn B: red (#ff0000)\nRow 1: Knit.", "the next is A"),
        (
            "Yarn A: red (#ff0000)\nYarn B: blue (#0000ff)\nRow 1: Knit.",
            "does not say with which yarn",
        ),
        ("Yarn A: red (#ff0000)\nYarn B: blue (#0000ff)\nRow 1: With C knit.", "no yarn C"),
    ],
)
def test_mistakes_are_named(rows: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_piece_rows(f"Cast on 4 sts. Worked flat.\n{rows}")


def test_pieces_that_cannot_be_worked_in_the_round_are_refused() -> None:
    with pytest.raises(InputError, match="round 2 gains or loses several"):
        write_rows(shaped("xx..\nxxxx"), Construction.ROUND)
    yarns = (PieceYarn("cream", "#ffffee"), PieceYarn("blue", "#0000ff"))
    two = Piece(
        ShapedChart.rectangle(StitchChart.parse("KK")), yarns, np.array([[0, 1]], dtype=np.intp)
    )
    with pytest.raises(InputError, match="round 1 has several yarns"):
        write_rows(two, Construction.ROUND)


def test_an_outline_is_not_read_as_a_rectangle() -> None:
    with pytest.raises(InputError, match="not make a rectangle"):
        read_rows(write_rows(shaped("xx..\nxxxx")))
