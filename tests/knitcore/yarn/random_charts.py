"""Charts of any stitches for tests: examples, and random ones that balance; and a yarn."""

from hypothesis import strategies as st

from knitcore.chart.stitch_kinds import STITCHES, StitchType
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.model.yarn_model import YarnModel

ACRYLIC, LOOP_MM = YarnModel(0.046, 6e-4, 2.4, 0.74, 0.335), 11.3
"""The library's yarn of stockinette, and its loop length."""

EXAMPLES = {
    "stockinette": "KK;KK",
    "slip mosaic": "KKKK;VKVK;KKKK;KVKV",
    "slip, yarn in front": "KKKK;vKvK;KKKK;KvKv",
    "tuck every other": "KKKK;TKTK;KKKK;KTKT",
    "yo k2tog": "O/;KK",
    "ssk yo": "\\O;KK",
    "yo k2tog ssk yo": "O/\\O;KKKK",
    "cable 1/1": "[1/1R];KK",
    "cable 1/1, both ways": "[1/1R][1/1L];KKKK",
    "cable 2/2 between purls": "P[2/2R]P;PKKKKP;PKKKKP;PKKKKP",
    "cable 2/2": "[2/2L];KKKK;KKKK;KKKK",
    "rib 4x2": "KKKKPP",
    "twisted": "B",
    "twisted rib": "BP",
    "centred double": "KO^O;KKKK",
    "feather": "//OO;KKKK",
    "feather and fan": "//OOOO\\\\K;KKKKKKKKK",
    "cable 3/3": "[3/3R];KKKKKK",
    "held and twisted": "BKKK;TKKK;TKKK;KKKK",
}
"""Repeats of all kinds of stitches."""

_KINDS = [
    stitch
    for stitch in STITCHES
    if stitch.width <= 4 and not any(s.turn and len(s.sources) > 1 for s in stitch.sites)
]
_BY_CODE = {stitch.code: stitch for stitch in STITCHES}
_KNIT, _OVER, _TOGETHER = (_BY_CODE[code] for code in "KO/")


@st.composite
def _row(draw: st.DrawFn, width: int) -> str:
    chosen: list[StitchType] = []
    left = need = width  # columns to fill, loops to take
    for stitch in draw(st.lists(st.sampled_from(_KINDS), max_size=width)):
        columns, loops = left - stitch.width, need - stitch.takes
        if columns >= 0 and loops >= 0 and loops <= 2 * columns:
            chosen.append(stitch)
            left, need = columns, loops
    chosen += max(need - left, 0) * [_TOGETHER] + max(left - need, 0) * [_OVER]
    chosen += min(need, 2 * left - need) * [_KNIT]
    return "".join(stitch.code for stitch in draw(st.permutations(chosen)))


@st.composite
def balanced_charts(draw: st.DrawFn) -> SymbolChart:
    """A chart of up to two rows of any stitches below a plain one."""
    width = draw(st.integers(2, 6))
    rows = draw(st.lists(_row(width), min_size=1, max_size=2))
    return SymbolChart.parse(";".join(["K" * width, *rows]))
