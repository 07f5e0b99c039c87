"""Patterns as other people write them."""

import pytest

from knitcore import InputError, StitchChart
from knitcore.formats.read.written_reader import looks_written, read_noted_rows


@pytest.mark.parametrize(
    ("text", "chart"),
    [
        # casting on
        ("Cast on 4 stitches.\nRow 1: Knit.", "KKKK"),
        ("CO 4\nRow 1: k", "KKKK"),
        ("cast on four sts:\nR1: K across", "KKKK"),
        ("Scarf\nUsing 4 mm needles, cast on 4 sts.\nRow 1: knit all sts", "KKKK"),
        ("Round 0: CO 4 sts.\nRound 1: Knit.\nRound 2: BO 4 sts.", "KKKK"),
        ("Cast on 4 sts and join in the round, being careful not to twist.\nRnd 1: Purl.", "PPPP"),
        ("Multiple of 4 sts plus 2.\nRow 1: *K1, p1; rep from * to end.", "PKPKPK"),
        # rows and their numbers
        ("R1: k1, p1, k1, p1\nR2: k1, p1, k1, p1", "PKPK\nPKPK"),
        ("1. *k1, p1* twice\n2. *k1, p1* twice", "PKPK\nPKPK"),
        ("R1[WS] - K3, p1\nR2 - k4", "KKKK\nPPPK"),
        ("Row 1 : (RS) k 4 .\nRow 2 : p 4 .", "KKKK\nKKKK"),
        ("Rows 1, 3 (RS): k4.\nRow 2 and all even rows: p4.", "KKKK\nKKKK\nKKKK\nKKKK"),
        ("Row 1 (RS) (and all odd rows): Knit.\nRow 2: k4.\nRow 4: p4.", "KKKK\nKKKK\nPPPP\nKKKK"),
        ("RS rows: k4\nWS rows: k4", "PPPP\nKKKK"),
        ("RS: k4\nWS: k4\nRS: p4", "PPPP\nPPPP\nKKKK"),
        ("Next row: k4.\nNext row (WS): p4.", "KKKK\nKKKK"),
        ("Rnds 1 to 3: k2, p2.", "PPKK\nPPKK\nPPKK"),
        ("Row 2: p4. Row 1: k2,\n  p2.", "KKKK\nPPKK"),
        ("- Row 1: k2, p2\n• **Row 2:** p4", "KKKK\nPPKK"),
        ("First row (WS): k4\nRow Two | p4", "PPPP\nPPPP"),
        (
            "RS Row 1: k4\n(WS) Row 2: k4\nRow #3 = p4\n4th row: (WS) As 1st row.",
            "PPPP\nPPPP\nPPPP\nKKKK",
        ),
        ("Rows 1 + 2: k2, p2", "PPKK\nPPKK"),
        ("CO 4\nSet-up row (WS): knit\nRow 1: k2, p2\nRep row 1 twice.", "PPKK\nPPKK\nPPKK\nPPPP"),
        ("CO 4\nRow 0: knit\nRow 1: k2, p2", "PPKK\nPPPP"),
        ("CO 3\nEvery row: *k1, p1; rep from * to last st, k1", "PKP\nKPK"),
        ("CO 3\nAll rows: Knit.", "PPP\nKKK"),
        # rows of compilers, which repeat each row across the needle
        ("1st row k, p.\n2nd row k 2, p 2.", "PPKK\nPKPK"),
        ("1st and 3rd row k 4. from ws 2nd to 4th row p.", "KKKK\nKKKK\nKKKK\nKKKK"),
        ("all rs rows k. all ws rows k. 1st row p 4.", "PPPP\nPPPP"),
        ("1st row [[k,p] 2] to end.\nall ws rows p.", "KKKK\nPKPK"),
        ("1st row [k] to last 2 sts, p 2.\n2nd row p 4.", "KKKK\nPPKK"),
        # words of a row
        ("Row 1: [k1, p1] 2 times", "PKPK"),
        ("Row 1: (k1, p1) x 2", "PKPK"),
        ("Row 1: {k1, p1} x2", "PKPK"),
        ("Row 1: k1 p1 k1 and p1", "PKPK"),
        ("Row 1: knit 2 sts, purl two stitches", "PPKK"),
        ("CO 8\nRow 1: *k1, p1; rep from * to last 2 sts, k2", "KKPKPKPK"),
        ("CO 8\nRow 1: *k1, p1*; repeat from * to * until 2 sts remain, k2", "KKPKPKPK"),
        ("CO 4\nRow 1: *k1, p1, rep from * across the row", "PKPK"),
        ("CO 4\nRow 1: k1, p1 (repeat to end)", "PKPK"),
        ("CO 8\nRow 1: K to last 3 sts, purl to last st, k1", "KPPKKKKK"),
        ("CO 8\nRow 1: *k1, p1; rep from * 3 more times", "PKPKPKPK"),
        ("CO 8\nRow 1: *k1, p1; rep from * 3 times", "PKPKPKPK"),
        ("CO 8\nRow 1: *k1, p1; rep from * 4 times", "PKPKPKPK"),
        ("CO 8\nRow 1: *k1, p1; rep from * 4 times in all", "PKPKPKPK"),
        ("CO 5\nRow 1: *k1, p1; rep from *, end k1", "KPKPK"),
        ("CO 9\nRow 1: K to last 5 sts, *p1, k1; rep from *, end p1", "PKPKPKKKK"),
        ("CO 4\nRow 1: k1, p1 to end", "PKPK"),
        ("CO 4\nRow 1: *k1, p1*; rep *-* to end. (4)", "PKPK"),
        ("CO4 (multiple of 2)\nRow 1: *k1, p1, rep from *. 4 sts", "PKPK"),
        ("CO 6\nRow 1: k2, *p1, k1;\n  rep from * to end.", "KPKPKK"),
        ("CO 4\nRow 1: *k1, p1; repeat to end", "PKPK"),
        ("CO 5\nRow 1: *k1 p1* across to last st, k1", "KPKPK"),
        ("CO 6\nRow 1: *k1, p1; rep from * to last 2 sts, end k2", "KKPKPK"),
        ("CO 6\nRow 1: k2, p to 3 sts before the end, k3", "KKKPKK"),
        ("CO 4 (4 sts)\nRow 1: k2, pm, p2. Turn. [4]", "PPKK"),
        ("Row 1: 1k, p1 k1p1, turn <4 sts>", "PKPK"),
        ("Row 1: knit1, purl2 (3 sts)", "PPK"),
        ("Row 1: k2, p1, k2tog.\nRow 2: p4.", "KKKK\nKPKK"),
        # repeated rows, remarks and what follows the end
        ("Row 1: k4\nRow 2: k4\nRepeat rows 1-2 once more.", "PPPP\nKKKK\nPPPP\nKKKK"),
        ("Row 1: k2\nRow 2: k2\nRep R1-R2 once.", "PP\nKK\nPP\nKK"),
        ("Row 1: k2\nRow 2: k2\nRep rows 1 & 2 one more time.", "PP\nKK\nPP\nKK"),
        ("Row 1: k2\nRow 2: k2\nRepeat these two rows once more.", "PP\nKK\nPP\nKK"),
        ("Row 1: p2\nRow 2: k2\nRow 3: k2\nRep last 2 rows twice.", "KK\nPP\n" * 3 + "PP"),
        ("Row 1: k2, p2\nRep the last row once.", "PPKK\nPPKK"),
        ("Row 1: k2\nRow 2: k2\nWork rows 1 and 2 once more.", "PP\nKK\nPP\nKK"),
        ("Row 1: k2\nRow 2: k2\nRows 3-6: Rep rows 1 - 2 twice.", "PP\nKK\nPP\nKK\nPP\nKK"),
        ("Row 1: k4\nRow 2: As row 1.", "PPPP\nKKKK"),
        ("(A rib\nof mine)\n\nRow 1: k2 (as if), p2. (4 sts) // wide\n# end", "PPKK"),
        ("CO 4\nRow 1: knit\nBind off all sts loosely.\nWeave in ends.", "KKKK"),
    ],
)
def test_patterns_of_other_hands(text: str, chart: str) -> None:
    assert looks_written(text)
    assert read_noted_rows(text)[0].chart == StitchChart.parse(chart)


@pytest.mark.parametrize(
    ("text", "note"),
    [
        ("Row 1: *k2, p2; rep from * to end.", "4 stitches are the fewest"),
        ("(Rib)\nCO 4\nRow 1: k4", "remarks: '(Rib)'"),
        ("CO 4\nRow 1: k4\nBind off.\nWash it.", "remarks: 'Wash it.'"),
        ("CO 4\nRow 1: k4\nRepeat these rows for pattern.", "does not say how often"),
        ("CO 8\nRow 1: *k1, p1; rep from * 3 times", "once and then as often"),
        ("CO 8\nRow 1: *k1, p1; rep from * 4 times", "as often as it says in all"),
        ("Row 1: k2, k2tog.", "Row 1 makes 3 of the 4 stitches cast on"),
        ("CO 4\nAll RS rows: knit\nAll WS rows: purl", "up to row 2"),
    ],
)
def test_choices_and_omissions_are_noted(text: str, note: str) -> None:
    assert note in " ".join(read_noted_rows(text)[1])


def test_a_strict_text_needs_no_note() -> None:
    assert read_noted_rows("Cast on 4 sts. Worked flat.\nRow 1 (RS): Knit. (4 sts)")[1] == ()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("Row 1: [k1, k2tog] twice.", "k2tog is stitch 2 of 4"),
        ("CO 6\nRow 1: *k1, yo; rep from * to end", "a repeat to the end increases or decreases"),
        ("flipped 1st row k, p.", "no rows: 'flipped 1st row k, p.' is none"),
        ("Row 1: KPKP", "Separate stitches by commas"),
        ("Row 1: K2, (p2, k6), p2.", "does not say how often"),
        ("Cast on 20 (24, 28) sts.\nRow 1: knit", "several sizes"),
        ("CO 20\nRow 1: k2 (3, 4), p2", "several sizes"),
        ("CO 80/88/96 sts.\nRow 1: k", "several sizes"),
        ("CO 80, 88, 96 sts.\nRow 1: k", "several sizes"),
        ("CO 80[88:96] sts.\nRow 1: k", "several sizes"),
        ("Row 1: [k5] 0 times.", "0 times"),
        ("CO 4\nCO 6\nRow 1: knit", "6 stitches are cast on, 4 before"),
        ("CO 6\nRow 1: knit\nRow 2: BO 4 sts.", "binds off 4 stitches, but 6"),
        ("CO 6\nRow 1: knit\nRow 1: purl", "row 1 is given twice"),
        ("CO 6\nRow 1: knit.\nWork even until it is long enough.", "is not a row"),
        ("all rs rounds k. all ws rounds p.", "rounds have no wrong side"),
        ("Row 1: k2, [p1, [yo] twice] 3 times.", "yo is stitch 4 of 11: the row takes 5 stitches"),
        ("Row 1: k4 (never closed\nRow 2: p4", "bracket is not closed"),
        ("Row 1: k1\n" * 20_001, "20001 lines"),
        ("Row 1: " + "[" * 100, "too many brackets"),
        ("Row 1: [*k1; rep from * to end] twice", "stands inside another repeat"),
    ],
)
def test_what_cannot_be_charted_is_refused_by_line_and_name(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_noted_rows(text)
