"""Charts and yarns from which the behaviour of mixed charts is learned.

The packaged store (:mod:`knitcore.yarn.library.store`) holds every repeat of up to 8 stitches.
These are too small for textures side by side, isolated purls, long diagonals and wide blocks:
:func:`training_charts` lists such repeats of up to 25 stitches in a cell, in an order such that any
first part of the list is a fair sample of all kinds. :data:`YARN_POINTS` are yarns that span the
dimensionless numbers of the library's materials.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain, zip_longest

import numpy as np

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.yarn_model import YarnModel

MAX_STITCHES = 36
"""Largest repeat."""


@dataclass(frozen=True)
class YarnPoint:
    """One yarn at one setting, for every chart.

    Parameters
    ----------
    name : its name in results.
    yarn : the yarn.
    loop_length_mm : mm of yarn per stitch.
    """

    name: str
    yarn: YarnModel
    loop_length_mm: float


def _point(
    name: str, radius: float, core: float, contact: float, exponent: float, loop_length_mm: float
) -> YarnPoint:
    """A yarn from r/L, core/L and k r⁴ L/B, with B/L³ of 1.5e-5 N/mm as lace yarns have."""
    bending = 1.5e-5 * loop_length_mm**3
    r = radius * loop_length_mm
    stiffness = contact * bending / (r**4 * loop_length_mm)
    yarn = YarnModel(bending, stiffness, exponent, r, core * loop_length_mm)
    return YarnPoint(name, yarn, loop_length_mm)


YARN_POINTS = (
    _point("middle", 0.056, 0.0255, 0.25, 2.65, 6.6),
    _point("thick", 0.066, 0.0265, 0.25, 2.5, 6.6),
    _point("thin", 0.047, 0.0235, 0.6, 2.8, 6.6),
    _point("soft", 0.058, 0.023, 0.08, 2.4, 6.6),
    _point("hard", 0.052, 0.0265, 1.0, 2.9, 6.6),
    _point("thick soft", 0.072, 0.024, 0.12, 2.4, 6.6),
    _point("thin soft", 0.049, 0.0231, 0.03, 2.4, 6.6),
    _point("thick hard", 0.067, 0.0285, 0.6, 2.9, 6.6),
)
"""Single yarns; acrylic and cotton with the paper's own parameters (a yarn for each fabric) are
added by the build."""


def training_charts() -> dict[StitchChart, str]:
    """The charts with the kind of each, the kinds taken in turns."""
    kinds: dict[str, Iterator[StitchChart]] = {
        "sparse": _sparse(),
        "panel": _panels(),
        "basket": _baskets(),
        "twill": _twills(),
        "chevron": _chevrons(),
        "figure": _figures(),
        "random": _random(),
        "rib": _ribs(),
    }
    rounds = zip_longest(*([(kind, c) for c in charts] for kind, charts in kinds.items()))
    kind_of: dict[StitchChart, str] = {}
    for entry in chain.from_iterable(rounds):
        if entry is None:
            continue
        kind, chart = entry
        repeat = chart.canonical()
        if repeat.stitches <= MAX_STITCHES:
            kind_of.setdefault(repeat, kind)
    return kind_of


def drawn_charts() -> list[StitchChart]:
    """Further charts, which are only relaxed: how deep a chart folds is hardest to learn."""
    return list(dict.fromkeys(chart.canonical() for chart in _drawn()))


def anchor_charts() -> list[StitchChart]:
    """Small repeats for every new yarn: the pure fabrics, then some of each kind."""
    texts = [
        "K",
        "P/K",
        "KP",
        "KP/PK",
        "KKPP",
        "KKKPPP",
        "P/P/K/K",
        "KKP",
        "KP/KP/PK/PK",
        "KKPP/KKPP/PPKK/PPKK",
        "KK/KP",
        "KKK/PKK",
        "P/P/P/K/K/K",
        "KKKP",
        "KKK/KKP/KKK",
        "KPK/PKK/KKP",
        "KKPP/PKKP/PPKK/KPPK",
        "KKK/KKK/KKP/KKP",
        "KKPP/PPKK",
        "KK/KK/KP/KP",
        "KKKK/KKKK/KKKK/KKKP",
    ]
    return [StitchChart.parse(text) for text in texts]


def _sparse() -> Iterator[StitchChart]:
    """One purl in a field of knits, alone or in the order of bricks."""
    shapes = [(4, 4), (3, 4), (4, 3), (2, 6), (6, 2), (5, 5), (4, 6), (3, 5), (5, 3), (2, 8)]
    for rows, columns in [*shapes, (8, 2), (4, 5), (5, 4), (6, 4), (2, 10), (3, 8), (6, 6)]:
        grid = np.zeros((rows, columns), dtype=bool)
        grid[0, 0] = True
        yield StitchChart(grid)
        if rows % 2 == 0 and columns % 2 == 0:
            grid[rows // 2, columns // 2] = True
            yield StitchChart(grid)
        double = np.zeros((rows, columns), dtype=bool)
        double[0, :2] = True
        yield StitchChart(double)


_TEXTURES = {"K": "K", "P": "P", "garter": "K/P", "rib": "KP", "seed": "KP/PK", "rib 2": "KKPP"}


def _panels() -> Iterator[StitchChart]:
    """Two textures side by side, or one above the other."""
    pairs = [("K", "seed"), ("K", "garter"), ("K", "rib"), ("rib", "seed"), ("garter", "rib")]
    pairs += [("garter", "seed"), ("K", "rib 2"), ("P", "garter")]
    for wide in (6, 4, 5, 8, 3):
        for first, second in pairs:
            beside, above = (StitchChart.parse(_TEXTURES[name]) for name in (first, second))
            rows = max(beside.rows, above.rows)
            yield StitchChart(np.hstack([c.resized(rows, wide).purl for c in (beside, above)]))
            columns = max(beside.columns, above.columns)
            yield StitchChart(np.vstack([c.resized(wide, columns).purl for c in (beside, above)]))


def _baskets() -> Iterator[StitchChart]:
    """Blocks of knits and purls, as on a chessboard."""
    blocks = [(3, 3), (2, 4), (4, 2), (4, 4), (3, 2), (2, 3), (1, 4), (4, 1), (3, 4), (4, 3)]
    for rows, columns in [*blocks, (1, 5), (5, 1), (2, 5), (5, 2), (3, 5), (5, 3), (1, 6), (6, 1)]:
        block = np.zeros((rows, columns), dtype=bool)
        pair = np.hstack([block, ~block])
        if 4 * rows * columns <= MAX_STITCHES:
            yield StitchChart(np.vstack([pair, ~pair]))
            if columns % 2 == 0:  # bricks: the next rows moved by half a block
                yield StitchChart(np.vstack([pair, np.roll(pair, columns // 2, axis=1)]))


def _shifted(row: str, shifts: list[int], height: int = 1) -> StitchChart:
    line = StitchChart.parse(row).purl[0]
    return StitchChart(np.vstack([np.roll(line, s) for s in shifts for _ in range(height)]))


def _twills() -> Iterator[StitchChart]:
    """Diagonals: every row one stitch aside of the one below."""
    for row in ("KKPP", "KKKP", "KKKPPP", "KKKKP", "KKPPP", "KKPKPP", "KKKKPP", "KPKPP", "KKKKKP"):
        yield _shifted(row, list(range(len(row))))
        if len(row) <= 4:  # two rows a step
            yield _shifted(row, list(range(len(row))), 2)
        if len(row) == 5:  # two stitches a step
            yield _shifted(row, [2 * s for s in range(5)])


def _chevrons() -> Iterator[StitchChart]:
    """Zigzags upwards and, turned by a quarter, across."""
    for row, top in (
        ("KKPP", 2),
        ("KKKP", 2),
        ("KKP", 2),
        ("KKKPPP", 3),
        ("KKPP", 1),
        ("KKKPPP", 2),
    ):
        shifts = [*range(top + 1), *range(top - 1, 0, -1)]
        chart = _shifted(row, shifts)
        yield chart
        yield StitchChart(chart.purl.T)


def _figures() -> Iterator[StitchChart]:
    """Diamonds, waffles, broken ribs and others that stitch dictionaries show."""
    texts = (
        "KPPP/KPPP/KKKK/KKKK KKPK/KPKP/PKKK/KPKP KKPP/KKPP/KKKK/KKKK KPKK/KPKK/KKKP/KKKP "
        "KKKP/KKPP/KPPP/PPPP PPPP/PKKP/PKKP/PPPP KKKKK/KPPPK/KPKPK/KPPPK/KKKKK KPKK/KKKP "
        "KKKKKK/KPPPPK/KPPPPK/KPPPPK/KPPPPK/KKKKKK KKPK/KPPP/KKPK/KKKK KPKP/PKPK/KKPP/KKPP "
        "KKKPKK/KKPKPK/KPKKKP/KKPKPK KKKKP/KKKPP/KKPPP/KPPPP KPKPKK/KKKKKK KP/KP/KP/KK/KK/KK "
        "PPPKKK/KPPPKK/KKPPPK/KKKPPP PKKKP/KPKPK/KKPKK/KPKPK "
        "KPKPKP/PKPKPK/KPKPKP/KKKKKK/KKKKKK/KKKKKK KKKK/KPPK/KPPK/KKKK KPPK/PKKP "
        "KPPK/PKKP/PKKP/KPPK PKK/KKK/KPK/KKK KKKKPP/KKKKPP/PPKKKK/PPKKKK"
    )
    yield from map(StitchChart.parse, texts.split())


def _random() -> Iterator[StitchChart]:
    """Random stitches, from few purls to equal shares."""
    draw = np.random.default_rng(16)
    shapes = [(4, 4), (4, 3), (3, 4), (2, 6), (3, 5), (5, 3), (6, 2), (2, 7), (4, 5)]
    for turn in range(60):
        rows, columns = shapes[turn % len(shapes)]
        share = (0.5, 0.25, 0.375)[turn % 3]
        purls = max(2, round(share * rows * columns))
        grid = np.zeros(rows * columns, dtype=bool)
        grid[draw.choice(grid.size, purls, replace=False)] = True
        chart = StitchChart(grid.reshape(rows, columns))
        if chart.repeat() == chart:
            yield chart


def _drawn() -> Iterator[StitchChart]:
    """Repeats as designers draw them, at random: seven ways in turn."""
    draw = np.random.default_rng(4)
    fields = [StitchChart.parse(text) for text in ("K", "K", "K/P", "KP", "KP/PK", "KKPP")]
    for turn in range(1400):
        most = 6 if turn < 700 else 8
        rows, columns = (int(n) for n in draw.integers(3, most + 1, 2))
        row, side = draw.random(columns) < 0.5, draw.random(rows) < 0.5
        way = turn % 7
        if way == 0:  # stitches at random, few or many
            grid = draw.random((rows, columns)) < draw.choice([0.15, 0.3, 0.5])
        elif way == 1:  # blocks and baskets: one row or its opposite
            grid = side[:, None] ^ row
        elif way == 2:  # slopes and zigzags
            grid = np.array([np.roll(row, s) for s in np.cumsum(draw.integers(-1, 2, rows))])
        elif way == 3:  # a small figure in a field
            grid = draw.choice(np.array(fields, dtype=object)).resized(rows, columns).purl.copy()
            grid[:2, :3] = draw.random((2, 3)) < 0.5
        elif way == 4:  # patterned and plain rows
            grid = np.where(side[:, None], row, draw.random() < 0.5)
        elif way == 5:  # mirrored about a column
            grid = draw.random((rows, columns)) < 0.4
            grid |= grid[:, ::-1]
        else:  # the upper half is the lower one with K and P swapped
            grid = draw.random((rows // 2, columns)) < 0.5
            grid = np.vstack([grid, ~grid])
        chart = StitchChart(grid)
        if min(chart.repeat().purl.shape) > 1:
            yield chart


def _ribs() -> Iterator[StitchChart]:
    """Ribs and welts wider than those of the store."""
    counts = [(4, 4), (6, 6), (9, 1), (5, 5), (6, 2), (4, 5), (11, 1), (8, 4), (3, 7), (5, 1)]
    for knits, purls in [*counts, (6, 3), (7, 7), (10, 2)]:
        rib = StitchChart.parse("K" * knits + "P" * purls)
        yield rib
        yield StitchChart(rib.purl.T)
    for row in ("KKPKP", "KKKPKP", "KKPPKP", "KPKPKKPP", "KKKKPKP", "KKPKPPKP"):
        yield StitchChart.parse(row)
        yield StitchChart(StitchChart.parse(row).purl.T)
