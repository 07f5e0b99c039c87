"""Charts of letters and signs, as people and programs draw them."""

import pytest

from knitcore import InputError, StitchChart
from knitcore.formats.read.text_chart import read_text_chart


@pytest.mark.parametrize(
    ("text", "key", "note"),
    [
        # blank squares
        ("- - -\n - - -\n", "PKPKPK/KPKPKP", "The 6 blank squares are read as knits"),
        ("--\n  --", "PPKK/KKPP", "The 4 blank squares"),
        ("●\u3000●\n\u3000●", "PKP/KPK", "The 3 blank squares"),
        ("-,,-\n,-,", "PKP/KPK", "The 3 blank squares"),
        ("-\t\t-\n-\t-\t-", "PKP/PPP", "The blank square is read as a knit"),
        ("ー|ー\n| |", "PKP/KKK", "The blank square"),
        # signs of the Craft Yarn Council, of JIS, squares
        ("|ー|\nー|ー", "KPK/PKP", "ー as purl"),
        ("□■□\n■□■", "KPK/PKP", "■ as purl, □ as knit"),
        ("□·\n·□", "KP/PK", "· as purl"),
        ("○●○\n●○●", "KPK/PKP", "○ as knit, ● as purl"),
        ("x.x.\n.x.x", "PKPK/KPKP", ". as knit, x as purl"),
        ("K.K\n.K.", "KPK/PKP", ". as purl"),
        ("#.#\n.#.", "PKP/KPK", "# as purl"),
        ("01\n10", "KP/PK", "1 as purl"),
        ("ＫＰ\nＰＫ", "KP/PK", ""),
        ("K-P", "KPP", "- is read as purl, like P"),
        # numbers, borders, tables, legends, titles
        ("2 KPKP 2\n1 PKPK 1", "KPKP/PKPK", "numbers beside the rows"),
        ("2 KPKP\n  PKPK 1\n  4321", "KPKP/PKPK", "line of column numbers"),
        ("10 - -\n 9  - -", "PKPK/KPKP", "blank squares"),
        ("1 KPKP\n2 PKPK", "PKPK/KPKP", "row 1 at the bottom"),
        ("|KPK|\n|PKP|", "KPK/PKP", "border"),
        ("+---+\n|- -|\n| - |\n+---+", "PKP/KPK", "border"),
        ("┌──┐\n│●○│\n│○●│\n└──┘", "PK/KP", "border"),
        ("| K | P |\n| P | K |", "KP/PK", "lines of the grid"),
        ("| K | P |\n|---|---|\n| P | K |", "KP/PK", "lines of the grid"),
        ("| - |   |\n|   | - |", "PK/KP", "lines of the grid"),
        ("|:-:|:--|\n| Row | 1 | 2 |\n| 2 | K | P |\n| 1 | P | K |", "KP/PK", "beside the rows"),
        ("┌───┬───┐\n│ K │ P │ 2\n├───┼───┤\n│ P │ K │ 1\n└───┴───┘\n  2   1", "KP/PK", "grid"),
        ("┏━┳━┓\n2 ┃-┃ ┃\n┣━╋━┫\n1 ┃ ┃-┃\n┗━┻━┛", "PK/KP", "lines of the grid"),
        ("+----+\n|.x.x|\n|x.x.|\n+----+", "KPKP/PKPK", "border"),
        (",3,2,1\n2,K,P,K\n1,P,K,P\n", "KPK/PKP", "line of column numbers"),
        ("K\tP\tK\t2\nP\tK\tP\t1\n3\t2\t1\t", "KPK/PKP", "beside the rows"),
        ("2,0,1\n1,1,0", "KP/PK", "1 as purl"),
        ("x\t\tx\n\tx\t\nx\t\tx", "PKP/KPK/PKP", "The 4 blank squares"),
        ('"x","","x"\n"","x",""', "PKP/KPK", "The 3 blank squares"),
        ("□ = 表目\n－ = 裏目\n\n□－\n－□", "KP/PK", "by its legend"),
        ("Legend\n------\n. - knit\nx - purl\n\n.x\nx.", "KP/PK", "by its legend"),
        ("o = purl\n. = knit\n\no.o\n.o.", "PKP/KPK", "by its legend"),
        ("My rib\nKPKP\nPKPK", "KPKP/PKPK", "remarks: 'My rib'"),
    ],
)
def test_drawn_charts_are_read_and_noted(text: str, key: str, note: str) -> None:
    chart, notes = read_text_chart(text)
    assert chart.key == key
    assert note in " ".join(notes)


@pytest.mark.parametrize(
    "text", ["KKP\nPPK", "K K P\nP P K", "KP KP\nPK PK", "|-|\n-|-", "K,P\nP,K"]
)
def test_plain_charts_need_no_note(text: str) -> None:
    assert read_text_chart(text) == (StitchChart.parse(text), ())


def test_words_for_knit_and_purl_are_stitches() -> None:
    assert read_text_chart("knit\tpurl\nknit\tpurl")[0].key == "KP/KP"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("- - -\n- - -", "they are knits, or only spaces"),
        ("--\n\n--", "line 2 is blank: a row of knits, or a gap"),
        ("KP P\nP KP", "line 1, column 3 is blank: a knit, or only space"),
        ("|○|\n|-|", r"line 1, stitch 2 is '○' \(a yarn over\)"),
        ("|/|\n|--", r"is '/' \(k2tog, a decrease\)"),
        ("KX\nXK", "line 1, stitch 2 is 'X'"),
        ("K\nQ", r"line 2, stitch 1 is 'Q' \(a twisted stitch\)"),
        ("x = yarn over\nKx\nxK", r"'x' \(yarn over\)"),
        ("3 KP\n1 PK", "line 2 is numbered 1, which is out of order"),
        ("KP\nKPK", "line 2 has 3 stitches"),
        ("hello", "'h', which is neither K nor P"),
        ("", "no stitches"),
        ("K" * 1001, "too large"),
        ("-" * 4_000_001, "4000001 characters"),
    ],
)
def test_what_is_no_chart_is_refused_by_line_and_name(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_text_chart(text)


@pytest.mark.parametrize("text", ["- -\n - -", "-,,-", "--\n\n--", "--\n --", "KP P\nP KP"])
def test_blanks_that_may_be_knits_are_not_passed_over_in_a_request(text: str) -> None:
    with pytest.raises(InputError, match="a knit, or only space"):
        StitchChart.parse(text)
