"""Written rows and KnitSpeak of any stitches: there and back, and as others write them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.written_reader import read_noted_rows, read_rows, read_stitch_rows
from knitcore.formats.write.knitspeak import write_knitspeak
from knitcore.formats.write.written_pattern import write_rows
from tests.knitcore.symbol_charts import EVERY, chart_with, symbol_charts

ways = st.sampled_from(
    [(Construction.FLAT, Side.RS), (Construction.FLAT, Side.WS), (Construction.ROUND, Side.RS)]
)


@given(symbol_charts(), st.integers(1, 2), st.integers(1, 3), ways)
def test_rows_are_read_back(
    chart: SymbolChart, down: int, across: int, way: tuple[Construction, Side]
) -> None:
    tiled = chart.tile(down, across)
    for write in (write_rows, write_knitspeak):
        assert read_stitch_rows(write(tiled, way[0], first_side=way[1])) == tiled


def test_every_stitch_has_words_that_are_read_back_on_both_sides() -> None:
    for chart in map(chart_with, EVERY):
        for side in Side:
            assert read_stitch_rows(write_rows(chart, first_side=side)) == chart


@given(symbol_charts())
def test_the_back_is_worked_by_the_same_words(chart: SymbolChart) -> None:
    front, back = (
        [line.partition(":")[2] for line in write_rows(side, first_side=first).splitlines()]
        for side, first in ((chart, Side.RS), (chart.turn_over(), Side.WS))
    )
    assert front == back


@pytest.mark.parametrize(
    ("words", "face"),
    [
        ("k1, yo, sl1, k1, psso, k1", "K\\OK"),
        ("k1, yfwd, skp, k1", "K\\OK"),
        ("k1 yrn k2tog p1", "P/OK"),
        ("yo, sl 2 tog kwise, k1, p2sso, yo", "O^O"),
        ("yo, CDD, yo", "O^O"),
        ("yo, sl1, k2tog, psso, yo", "OLO"),
        ("yo, sk2p, yo", "OLO"),
        ("yo twice, k3tog", "ROO"),
        ("p1, C4B, p1", "P[2/2R]P"),
        ("p1, c6f, p1", "P[3/3L]P"),
        ("T3B, T3F", "[2/1LP][2/1RP]"),
        ("2/1 RPC, 2/1 LPC", "[2/1LP][2/1RP]"),
        ("(2/2 RC, k1) twice", "K[2/2R]K[2/2R]"),
        ("k1, RT, LT", "[1/1L][1/1R]K"),
        ("k1 tbl, p1, ktbl, p1", "PBPB"),
        ("*k1tbl, p1; rep from * once more", "PBPB"),
        ("k2 tbl, knit 1 through back loop, p1b", "bBBB"),
        ("k1, sl1 wyif, sl 1 purlwise with yarn in back", "VvK"),
        ("k1, slip 2 sts wyib", "VVK"),
        ("sl1p yf, k1", "Kv"),
        ("tuck, k1, tuck wyif", "tKT"),
        ("k2tog tbl, yo", "O[K10']"),
        ("p2tog, yo, ssp, yo", "O(O)"),
    ],
)
def test_words_of_other_hands(words: str, face: str) -> None:
    top = "k" if "V" in face or "v" in face or "T" in face else ""
    rows = f"Row 1 (RS): {words}.\n" + ("Row 2: Purl." if top else "")
    chart = read_stitch_rows(rows)
    assert str(chart).splitlines()[-1] == face


def test_a_wrong_side_row_works_the_back() -> None:
    lace = read_stitch_rows("Row 1 (WS): P2tog, yo, p1, C4B, ssp, yo, p1 tbl.\nRow 2 (RS): Knit.")
    assert str(lace).splitlines()[-1] == "/OK[2/2RPP]\\OB"


def test_open_words_are_noted() -> None:
    chart, notes = read_noted_rows("Row 1: K3, sl1.\nRow 2: P3, sl1.\nRow 3: C4B.\nRow 4: P4.")
    assert str(chart) == "KKKK\n[2/2R]\nKKKV\nVKKK"
    assert any("C6B is 3/3 RC" in note for note in notes)
    assert any("wrong side" in note for note in notes)


def test_an_elastic_row_counts_loops_that_are_taken() -> None:
    text = "Cast on 11 sts.\nRow 1: K1, *yo, ssk, k2; rep from * to last 2 sts, k2.\nRow 2: Purl."
    assert str(read_stitch_rows(text)).splitlines()[-1] == "KKKK\\OKK\\OK"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Row 1: k3, yo, k1.", "row 1: yo is stitch 4 of 5: the row takes 4 stitches and leaves 5"),
        ("Row 1: k3, k2tog, k1.", "k2tog is stitch 4 of 5: the row takes 6 stitches and leaves 5"),
        ("Row 1: k3, kfb, yo, k2tog.", "stitch 4, 'kfb', an increase, is no stitch of a chart"),
        ("Row 1: k3, w&t.", "stitch 4, 'w&t', a short row, is no stitch of a chart"),
        ("Row 1: k3, 7/7 RC.", "stitch 4, '7/7 RC', a crossing that charts do not know"),
        ("Row 1: k1, k1 below.", "a stitch knitted into the row below"),
        ("CO 6\nRow 1: *k2, yo; rep from * to end", "a repeat to the end increases or decreases"),
        ("CO 5\nRow 1: k3, yo, k2tog.\nRow 2: p3, p2tog.", "row 2: it changes the number of"),
        (
            "Yarn A: red (#ff0000)\nYarn B: blue (#0000ff)\nRow 1: with A yo, k2tog, with B k1.",
            "colours and other stitches than k and p are mixed",
        ),
        ("Row 1: sl1, sl1.", "row 1 slips every stitch"),
    ],
)
def test_what_changes_the_count_is_refused_by_row_and_stitch(text: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        read_noted_rows(text)
    assert message in str(refusal.value)


def test_knits_and_purls_alone_are_asked_for_by_name() -> None:
    with pytest.raises(InputError, match="yarn over and knit 2 together; this takes knits and pu"):
        read_rows("Row 1: K1, k2tog, yo.")
