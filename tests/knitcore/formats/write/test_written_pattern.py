"""Written rows are read back: of charts, of outlines and of several yarns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Fabric, InputError, StitchChart
from knitcore.chart.row_sides import Construction, Side
from knitcore.formats.read.written_reader import looks_written, read_piece_rows, read_rows
from knitcore.formats.write.written_pattern import row_words, write_rows
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from tests.knitcore.charts import WAYS_TO_WORK, stitch_charts
from tests.knitcore.pieces import pieces

YARNS = PieceYarn("cream", "#ffffee"), PieceYarn("blue", "#0000ff")
TWO_YARNS = "Yarn A: red (#ff0000)\nYarn B: blue (#0000ff)\n"


@given(chart=stitch_charts(), way=WAYS_TO_WORK)
def test_written_text_is_read_back(chart: StitchChart, way: tuple[Construction, Side]) -> None:
    assert read_rows(write_rows(chart, way[0], first_side=way[1])) == chart


@given(
    tile=stitch_charts(most=5), down=st.integers(1, 5), across=st.integers(1, 5), cut=st.integers(0)
)
def test_repeats_are_read_back(tile: StitchChart, down: int, across: int, cut: int) -> None:
    chart = tile.resized(tile.rows * down + cut % tile.rows, tile.columns * across)
    text = write_rows(chart)
    assert read_rows(text) == chart


@pytest.mark.parametrize(
    ("fabric", "construction", "rows"),
    [
        (Fabric.STOCKINETTE, Construction.ROUND, "Rnds 1-30: Knit. (20 sts)"),
        (Fabric.GARTER, Construction.FLAT, "Rows 1-30: Knit. (20 sts)"),
        (
            Fabric.STOCKINETTE,
            Construction.FLAT,
            "Row 1 (RS): Knit. (20 sts)\nRow 2 (WS): Purl. (20 sts)\nRows 3-30: Repeat rows 1-2.",
        ),
        (
            Fabric.GARTER,
            Construction.ROUND,
            "Rnd 1: Knit. (20 sts)\nRnd 2: Purl. (20 sts)\nRnds 3-30: Repeat rnds 1-2.",
        ),
        (Fabric.RIB, Construction.ROUND, "Rnds 1-30: *P1, k1; rep from * to end. (20 sts)"),
        (
            Fabric.SEED,
            Construction.FLAT,
            "Row 1 (RS): *P1, k1; rep from * to end. (20 sts)\n"
            "Row 2 (WS): *K1, p1; rep from * to end. (20 sts)\nRows 3-30: Repeat rows 1-2.",
        ),
    ],
)
def test_fabrics_come_out_as_knitters_write_them(
    fabric: Fabric, construction: Construction, rows: str
) -> None:
    text = write_rows(StitchChart.of_fabric(fabric, rows=30, columns=20), construction)
    assert "\n".join(text.splitlines()[1:-1]).lower() == rows.lower()


def test_a_cut_repeat_gives_the_remainder() -> None:
    assert row_words((False, False, True, True) * 3 + (False,)) == (
        "*k2, p2; rep from * to last st, k1"
    )


def test_brackets_and_words_of_other_hands() -> None:
    text = "Cast on 7 sts. Worked flat.\nRow 1 (RS): K1, (p1, k1) twice, purl. (7 sts)"
    assert read_rows(text) == StitchChart.parse("PPKPKPK")


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ("Row 2: Knit.", "row 1 is missing"),
        ("Row 1: K3.", "works 3 stitches, but 4 are on the needle"),
        ("Row 1: K4. (5 sts)", "says 5 sts"),
        ("Row 1 (WS): Knit.\nRow 2 (WS): Knit.", "do not alternate"),
        ("Rnd 1: Knit.", "mixed"),
        ("Row 1: *K3; rep from * to end.", "multiple of 3"),
        ("Row 1: *K1; rep from * to last 2 sts, k1.", "1 stitches follow"),
        ("Row 1: K2, yo, k2.", "row 1: yo is stitch 3 of 5: the row takes 4 stitches and leaves 5"),
        ("Row 1: K2 tbl, p2.", "knit through the back loop; this takes knits and purls only"),
        ("Row 1: (k99, p99) 9999 times.", "too many"),
        ("Rows 1-2: Repeat rows 1-2.", "not all written"),
        ("Rows 1-5000: Knit.", "rows 1-5000 cannot be made"),
        ("knit on", "is not a row"),
        ("Row 1: .", "empty"),
        ("Row 1: " + "k1, " * 100_000, "characters"),
        ("Bind off.", "there are no rows"),
        ("Row 1: K2, ssk.", "ssk is stitch 3 of 3"),
        ("Row 1: K1, m1, k3, m1.", "m1 is stitch 6 of 6"),
        ("Row 1: Bind off 4 sts, knit.", "leaves no stitch"),
        ("Row 1: Ssk, k2. (4 sts)", "says 4 sts, but 3 are"),
        ("Row 1: Cast on 2 sts, k4.", "works 4 stitches, but 6 are"),
        ("Rows 1-2: Bind off 1 st, k3.", "works 3 stitches, but 2 are"),
        ("Yarn B: red (#ff0000)\nRow 1: Knit.", "the next is A"),
        (f"{TWO_YARNS}Row 1: Knit.", "does not say with which yarn"),
        (f"{TWO_YARNS}Row 1: With C knit.", "no yarn C"),
    ],
)
def test_mistakes_are_named(rows: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_piece_rows(f"Cast on 4 sts. Worked flat.\n{rows}")


def test_written_rows_are_distinguished_from_charts() -> None:
    assert looks_written("\nCast on 4 sts.")
    assert not looks_written("KPKP")


@settings(max_examples=150)
@given(piece=pieces(), first_side=st.sampled_from(Side))
def test_outlines_and_yarns_are_read_back(piece: Piece, first_side: Side) -> None:
    text = write_rows(piece, first_side=first_side)
    assert read_piece_rows(text) == piece.cropped()


@settings(max_examples=60)
@given(piece=pieces(step=1, yarns=1))
def test_outlines_in_the_round_are_read_back(piece: Piece) -> None:
    assert read_piece_rows(write_rows(piece, Construction.ROUND)) == piece.cropped()


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
    chart = StitchChart.of_fabric("seed", rows=2, columns=6)
    text = write_rows(Piece(ShapedChart.rectangle(chart), YARNS, yarn_of))
    assert text.splitlines()[1:-1] == [
        "Yarn A: cream (#ffffee)",
        "Yarn B: blue (#0000ff)",
        "Row 1 (RS): With B p1, k1, p1, with A k1, p1, k1. (6 sts)",
        "Row 2 (WS): With A k1, p1, k1, with B p1, k1, p1. (6 sts)",
    ]


def test_pieces_that_cannot_be_worked_in_the_round_are_refused() -> None:
    with pytest.raises(InputError, match="round 2 gains or loses several"):
        write_rows(shaped("xx..\nxxxx"), Construction.ROUND)
    both = ShapedChart.rectangle(StitchChart.parse("KK"))
    two = Piece(both, YARNS, np.array([[0, 1]], dtype=np.intp))
    with pytest.raises(InputError, match="round 1 has several yarns"):
        write_rows(two, Construction.ROUND)


def test_an_outline_is_not_read_as_a_rectangle() -> None:
    with pytest.raises(InputError, match="not make a rectangle"):
        read_rows(write_rows(shaped("xx..\nxxxx")))
