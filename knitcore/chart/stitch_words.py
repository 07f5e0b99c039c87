"""Words of stitches as patterns of others write them: US and UK, with and without blanks.

Adding a spelling is adding it to a line here; the words of the registry itself are always read.
Words say what the knitter does on the side that faces: ``k2tog`` on the wrong side makes the back
of a ``p2tog``.
"""

from __future__ import annotations

import re
from functools import cache
from typing import NamedTuple

from knitcore.chart.stitch_kinds import BY_CODE, MAX_CABLE_STITCHES, STITCHES

SLIP = "slip"
"""The code of a slipped stitch that does not say where its yarn is."""

_N = r"\s?(?P<n>\d*)\s?(?:sts?\s)?"
_TBL = r"(?:tbl|tb|(?:through|in)\s(?:the\s)?back(?:\s(?:of\s(?:the\s)?)?(?:loops?|st))?)"
_SL = rf"(?:sl|slip){_N}"
_PW = r"(?:p|,?\s?-?(?:pwise|p-?wise|pw|purlwise|as\sif\sto\spurl))?"
_YARN = r"(?:yarn\s|y)?(?:held\s)?(?:to|at|in)?\s?(?:the\s)?"
_KW = r"(?:,?\s?-?(?:kwise|k-?wise|kw|knitwise|as\sif\sto\sknit))?"
_AND = r"(?:,?\s(?:and\s)?|-|,\s?)?"
_OVER = r"(?:psso|pass\s(?:the\s)?(?:slipped\sst(?:itch)?|sl\sst)\sover)"

_SPELLINGS = {
    "B": (rf"k(?:nit)?{_N}-?{_TBL}", r"k(?P<n>\d*)b"),
    "b": (rf"p(?:url)?{_N}-?{_TBL}", r"p(?P<n>\d*)b"),
    "O": (
        r"yo(?P<n>[234])",
        r"yarn\s?-?over|y/o|yfwd|yfd|yrn|yon|yo|yarn\s(?:forward|round\sneedle)|wfd|wrn",
    ),
    "V": (rf"{_SL}{_PW}\s?(?:wyib|wyb|yb|with\syarn\s(?:held\s)?(?:in|at|to)\s(?:the\s)?back)",),
    "v": (rf"{_SL}{_PW}\s?(?:wyif|wyf|yf|with\syarn\s(?:held\s)?(?:in|at|to)\s(?:the\s)?front)",),
    SLIP: (rf"{_SL}{_PW}",),
    "T": (r"tuck|(?:yf\s?)?sl1yo",),
    "/": (r"k(?:nit)?\s?2\s?(?:sts?\s)?tog(?:ether)?|knit\stwo\stogether",),
    "\\": (
        r"ssk|skpo?|s1kp|slip,?\sslip,?\sknit",
        rf"(?:sl|slip|s)\s?1{_KW}{_AND}k(?:nit)?\s?1{_AND}{_OVER}",
    ),
    "[K10']": (rf"k\s?2\s?tog\s?-?{_TBL}",),
    "[P10']": (rf"p\s?2\s?tog\s?-?{_TBL}",),
    ")": (r"p(?:url)?\s?2\s?(?:sts?\s)?tog(?:ether)?|purl\stwo\stogether",),
    "^": (
        r"s2kp2?|cdd|sl2-?k1-?p2sso|s2k1p2?(?:sso)?",
        rf"(?:sl|slip|s)\s?2(?:\s(?:sts\s)?tog(?:ether)?)?{_KW}{_AND}k\s?1{_AND}p2sso",
    ),
    "L": (rf"sk2po?|(?:sl|slip|s)\s?1{_KW}{_AND}k\s?2\s?tog{_AND}{_OVER}",),
    "R": (r"k\s?3\s?tog",),
    "J": (r"p\s?3\s?tog",),
    "[P201]": (r"s2pp2?",),
    "[1/1R]": (r"rt|tw2r|1/1\srt",),
    "[1/1L]": (r"lt|tw2l|1/1\slt",),
}

OPEN_TO_READING = {
    r"\b[kp]1b\b": "K1b and p1b are read as through the back loop, not as into the stitch below.",
    r"\b(?:c|t|cr)\d+[bfrl]\b": (
        "C, T and Cr cross halves, in front the larger one: C6B is 3/3 RC, T3F is 2/1 LPC."
    ),
    rf"\b{_SL}(?!.{{0,60}}\b(?:wyi|yarn\s(?:in|held)|psso|p2sso|wy[bf]|y[bf]\b))": (
        "The yarn of a slipped stitch passes on the wrong side where the row does not say."
    ),
}
"""Words that patterns use in several ways, and how they are read."""

_CABLE = re.compile(r"(\d)/(\d)\s?(r|l)(|p|pp|pk)c(?![a-z])")
_CABLE_NEEDLE = re.compile(r"(c|t|cr)(\d{1,2})\s?([bfrl])(?![a-z\d])")


class StitchInWords(NamedTuple):
    """A stitch at the beginning of some words: its code, how often, and the words' length."""

    code: str
    often: int
    length: int


def stitch_in(words: str) -> StitchInWords | None:
    """Read the stitch with which words in small letters begin; None if it is a knit, or unknown.

    Examples
    --------
    >>> stitch_in("sl 1, k1, psso, k3")
    StitchInWords(code='\\\\', often=1, length=14)
    >>> stitch_in("c4f, k2").code
    '[2/2L]'
    """
    cable = _CABLE.match(words)
    if cable is not None:
        over, under, side, purls = cable.groups()
        return _known(f"[{over}/{under}{side}{purls}]".upper(), cable.end())
    cable = _CABLE_NEEDLE.match(words)
    if cable is not None:
        kind, number, side = cable.groups()
        over = (int(number) + 1) // 2
        purled = "" if kind == "c" else "P"
        way = "R" if side in "br" else "L"
        return _known(f"[{over}/{int(number) - over}{way}{purled}]", cable.end())
    longest: StitchInWords | None = None
    for code, spelling in _spellings():
        match = spelling.match(words)
        if match is not None and (longest is None or match.end() > longest.length):
            longest = StitchInWords(code, int(match.groupdict().get("n") or 1), match.end())
    return longest


def _known(code: str, length: int) -> StitchInWords | None:
    return StitchInWords(code, 1, length) if code in BY_CODE else None


@cache
def _spellings() -> tuple[tuple[str, re.Pattern[str]], ...]:
    own = [
        (s.code, _NUMBERED.sub(lambda words: words[1] + _N, s.words))
        for s in STITCHES[BY_CODE["P"] + 1 :]
        if s.code[1:2] not in _DIGITS
    ]
    others = [(code, spelling) for code, forms in _SPELLINGS.items() for spelling in forms]
    return tuple(
        (code, re.compile(rf"(?:{spelling})(?![\w/])")) for code, spelling in (*own, *others)
    )


_NUMBERED = re.compile(r"^(k|p|sl)1? ")
_DIGITS = {str(count) for count in range(1, MAX_CABLE_STITCHES + 1)}
