"""KnitSpeak: written, read back, and read as others write it."""

import pytest
from hypothesis import given

from knitcore import InputError, StitchChart
from knitcore.chart.row_sides import Construction, Side
from knitcore.formats.read.written_reader import looks_written, read_rows
from knitcore.formats.write.knitspeak import write_knitspeak
from tests.knitcore.charts import WAYS_TO_WORK, stitch_charts


@given(chart=stitch_charts(), way=WAYS_TO_WORK)
def test_written_text_is_read_back(chart: StitchChart, way: tuple[Construction, Side]) -> None:
    text = write_knitspeak(chart, way[0], first_side=way[1])
    assert looks_written(text)
    assert read_rows(text) == chart


def test_garter_and_stockinette_are_written_as_knitters_do() -> None:
    garter = StitchChart.of_fabric("garter", rows=6, columns=4)
    assert write_knitspeak(garter) == (
        "Row 1 (RS): K4.\nRows 2, 4 and 6 (WS): Knit.\nRows 3 and 5 (RS): Knit.\n"
    )
    stockinette = StitchChart.of_fabric("stockinette", rows=4, columns=4)
    assert write_knitspeak(stockinette, Construction.ROUND) == "Round 1: K4.\nRounds 2-4: Knit.\n"


@pytest.mark.parametrize(
    ("text", "chart"),
    [
        (
            "Row 1 (RS): *k2, p2, repeat from *.\nRow 2 (WS): *k2, p2; rep from * to end.",
            "PPKK\nPPKK",
        ),
        (
            "Rows 1 and 3 (RS): Knit.\nRow 2 (WS): k2, purl to last 2 sts, k2.",
            "KKKKK\nPPKPP\nKKKKK",
        ),
        ("Rounds 1-2: [k1, [p1, k1] twice, p1] twice.", "PKPKPKPKPKPK\nPKPKPKPKPKPK"),
        ("ROW 1 (ws): p.\nrow 2 (rs): k.", "K\nK"),
    ],
)
def test_patterns_of_other_hands(text: str, chart: str) -> None:
    assert read_rows(text) == StitchChart.parse(chart)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("Row 1: k1, yo, k2tog.", "yarn over and knit 2 together; this takes knits and purls only"),
        ("Row 2: k1.", "row 1 is missing"),
        ("Row 1: k1.\nRow 1: p1.", "is given twice"),
        (
            "Row 1: k3.\nRow 2: *k2, repeat from *.",
            "row 2: the 2 stitches that are repeated do not fit 3",
        ),
        ("Row 1 (RS): k1.\nRow 2 (RS): k1.", "do not alternate"),
        ("Row 1: k1.\nRound 2: k1.", "mixed"),
        ("Row 1: [k1.", "not closed"),
        ("Row 1: *k1, repeat from * to last 2 sts, p1.", "it says 2"),
        ("Row 1: *k2, repeat from * to last st, k1.\nRow 2: *k2, repeat from *.", "no number"),
        ("Row 1: [k999] 999 times.", "too many"),
        ("Row 9999: k1.", "cannot be made"),
        ("Row 1: " + "[" * 1_000_000, "characters"),
        ("k1, p1", "is not a row"),
    ],
)
def test_mistakes_are_named(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_rows(text)
