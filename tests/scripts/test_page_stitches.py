"""The stitches as the page has them."""

import pytest

from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.stitch_symbols import symbol_of
from knitcore.chart.symbol_chart import SymbolChart
from scripts.page_stitches import (
    GROUPS,
    deed_of,
    drawn,
    group_of,
    names_module,
    signs_module,
    stitches_module,
)


@pytest.mark.parametrize(
    ("code", "group", "deed"),
    [
        ("/", "lace", "leans right, 1 stitch fewer"),
        ("\\", "lace", "leans left, 1 stitch fewer"),
        ("^", "lace", "stands upright, 2 stitches fewer"),
        ("O", "lace", "makes a hole, 1 stitch more"),
        ("[2/1LP]", "cables", "2 move to the left in front of 1"),
        ("[1/2R]", "cables", "1 moves to the right in front of 2"),
        ("v", "slips", "keeps the stitch below, the yarn passes in front of it"),
        ("T", "tucks", "keeps the stitch below, the yarn is laid over it behind"),
        ("b", "twisted", "twists the stitch below"),
        ("K", "plain", "smooth on the face"),
    ],
)
def test_words_say_what_a_stitch_does(code: str, group: str, deed: str) -> None:
    stitch = STITCHES[BY_CODE[code]]
    assert (group_of(stitch), deed_of(stitch)) == (group, deed)


def test_every_stitch_has_its_group_words_and_symbol() -> None:
    for stitch in STITCHES:
        assert group_of(stitch) in GROUPS
        assert deed_of(stitch)
        assert stitch.code == "K" or drawn(symbol_of(stitch)) != "|", stitch.code
    assert stitches_module().count("~") == 5 * len(STITCHES)
    assert "export const SIGNS" in signs_module()
    assert '"yarn over"' in names_module()


def test_a_held_stitch_is_marked_as_such() -> None:
    assert " V~H~~0~1~3 " in stitches_module()
    assert SymbolChart.parse("KV;KP").purl.tolist() == [[False, True], [False, True]]
