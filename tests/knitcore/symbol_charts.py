"""Random charts of any stitches whose rows balance, for property tests."""

import numpy as np
from hypothesis import strategies as st

from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.symbol_chart import CONTINUED, SymbolChart

YARN_OVER = BY_CODE["O"]
ONE_FOR_ONE = [p for p, s in enumerate(STITCHES) if s.takes == s.width == 1]
DECREASES = [p for p, s in enumerate(STITCHES) if s.takes > s.width]
CROSSINGS = [p for p, s in enumerate(STITCHES) if s.width > 1]
KINDS = [ONE_FOR_ONE, DECREASES, CROSSINGS]
EVERY = [place for place in range(len(STITCHES)) if place != YARN_OVER]


def cells_of(place: int) -> list[int]:
    """Cells of one stitch."""
    return [place] + [CONTINUED] * (STITCHES[place].width - 1)


def chart_with(place: int) -> SymbolChart:
    """A small chart with one stitch, its yarn overs, and a row that knits all."""
    stitch = STITCHES[place]
    row = [*cells_of(place), *[YARN_OVER] * (stitch.takes - stitch.width), BY_CODE["P"]]
    return SymbolChart(np.array([row, [BY_CODE["K"]] * len(row)], dtype=np.int16))


@st.composite
def _rows(draw: st.DrawFn, columns: int, allowed: list[int]) -> list[int]:
    """A row that takes as many loops as it leaves, and ends in a knit or a purl."""
    row: list[int] = []
    while (room := columns - 1 - len(row)) > 0:
        fitting = [place for place in allowed if STITCHES[place].takes <= room]
        kinds = [fit for kind in KINDS if (fit := [place for place in fitting if place in kind])]
        place = draw(st.sampled_from(draw(st.sampled_from(kinds))))
        group = [place, *[YARN_OVER] * (STITCHES[place].takes - STITCHES[place].width)]
        row += [cell for part in draw(st.permutations(group)) for cell in cells_of(part)]
    return [*row, draw(st.sampled_from([0, 1]))]


@st.composite
def symbol_charts(
    draw: st.DrawFn,
    *,
    most_rows: int = 4,
    most_columns: int = 9,
    turned: bool = True,
    drawn: bool = False,
) -> SymbolChart:
    """Charts of any stitches.

    Parameters
    ----------
    turned : without it none is twisted.
    drawn : only stitches whose yarn is drawn: none is twisted and knitted together with others.
    """
    allowed = [
        place
        for place in EVERY
        if not any(
            site.turn and (not turned or (drawn and len(site.sources) > 1))
            for site in STITCHES[place].sites
        )
    ]
    columns = draw(st.integers(1, most_columns))
    rows = [draw(_rows(columns, allowed)) for _ in range(draw(st.integers(1, most_rows)))]
    top = draw(st.lists(st.sampled_from([0, 1]), min_size=columns, max_size=columns))
    return SymbolChart(np.array([*rows, top], dtype=np.int16))
