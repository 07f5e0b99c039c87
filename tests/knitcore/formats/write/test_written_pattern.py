import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import InputError, StitchChart
from knitcore.chart.fabric import Fabric
from knitcore.chart.row_sides import Construction, Side
from knitcore.formats.read.written_reader import looks_written, read_rows
from knitcore.formats.write.written_pattern import row_words, write_rows
from tests.knitcore.charts import stitch_charts


@given(
    chart=stitch_charts(),
    construction=st.sampled_from(Construction),
    first_side=st.sampled_from(Side),
)
def test_written_text_is_read_back(
    chart: StitchChart, construction: Construction, first_side: Side
) -> None:
    assert read_rows(write_rows(chart, construction, first_side=first_side)) == chart


@given(
    tile=stitch_charts(most=5), down=st.integers(1, 5), across=st.integers(1, 5), cut=st.integers(0)
)
def test_repeats_are_read_back(tile: StitchChart, down: int, across: int, cut: int) -> None:
    chart = tile.resized(tile.rows * down + cut % tile.rows, tile.columns * across)
    text = write_rows(chart)
    assert read_rows(text) == chart


@settings(max_examples=2, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_200_x_200_is_read_back(seed: int) -> None:
    chart = StitchChart(np.random.default_rng(seed).random((200, 200)) < 0.5)
    assert read_rows(write_rows(chart)) == chart


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
        ("Row 2: Knit.", "row 1 comes next"),
        ("Row 1: K3.", "works 3 stitches, but 4 are on the needle"),
        ("Row 1: K4. (5 sts)", "says 5 sts"),
        ("Row 1 (WS): Knit.", "row 1 is a RS row"),
        ("Rnd 1: Knit.", "mixed"),
        ("Row 1: *K3; rep from * to end.", "multiple of 3"),
        ("Row 1: *K1; rep from * to last 2 sts, k1.", "1 stitches follow"),
        ("Row 1: K2, yo, k2.", "'yo, k2' cannot be read"),
        ("Row 1: K2 p2.", "without a comma"),
        ("Row 1: (k99, p99) 9999 times.", "too many"),
        ("Rows 1-2: Repeat rows 1-2.", "not all written"),
        ("Rows 1-5000: Knit.", "too large"),
        ("knit on", "is not a row"),
        ("Row 1: .", "empty"),
        ("Row 1: " + "k1, " * 100_000, "characters"),
        ("Bind off.", "there are no rows"),
    ],
)
def test_mistakes_are_named(rows: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_rows(f"Cast on 4 sts. Worked flat.\n{rows}")


def test_the_cast_on_must_be_given() -> None:
    with pytest.raises(InputError, match="how many stitches are cast on"):
        read_rows("Row 1: Knit.")


def test_written_rows_are_distinguished_from_charts() -> None:
    assert looks_written("\nCast on 4 sts.")
    assert not looks_written("KPKP")
