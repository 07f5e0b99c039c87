"""The key of a drawn chart (symbols, yarns, repeats, a note), and the style of the drawing."""

import math
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from knitcore.base.arrays import Mask
from knitcore.base.bounds import check_range
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import STITCHES, StitchType
from knitcore.chart.stitch_symbols import symbol_of
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.write.drawn_page import Dots, Label, Lines, Rectangle, Shape
from knitcore.garment.piece import Piece, yarn_name

MARGIN_MM = 12.0
KEY_MM = 24.0
KEY_LINE_MM = 5.0
STITCH_LINE_MM = 5.5
KINDS_WITH_NAMES, MAX_KINDS = 12, 40
"""Most kinds of stitches in the key that are named in full, and at all."""
NOTE_CHARACTERS, NOTE_LINES = 110, 14
REGIONS_IN_A_LINE, REGION_MM = 4, 46.0
TINT = 0.55
"""Share of a yarn's colour in its stitches; the rest is white."""
INK, TENTH, GRID, FAINT = "#222222", "#55504a", "#b5b0a8", "#cfc9c0"
HEAVY, NO_STITCH = "#b3322b", "#d9d5ce"
SMALL_MM = 2.5
"""Smallest type: 7 pt, readable at arm's length."""


class Symbols(StrEnum):
    """How printed charts tell stitches apart: purls by a dot or a dash, with the symbols of the
    Craft Yarn Council; as Japanese charts do; or by the codes of text files."""

    DOTS = "dots"
    DASHES = "dashes"
    JAPANESE = "japanese"
    CODES = "codes"


@dataclass(frozen=True)
class RepeatMark:
    """A linked repeat: its entry in the key, and its copies as (row, column, rows, columns)."""

    words: str
    places: tuple[tuple[int, int, int, int], ...]


@dataclass(frozen=True, eq=False)
class RegionMark:
    """A named part of a chart: ``cells`` are True (rows, columns) where a stitch belongs to it."""

    name: str
    colour: str
    cells: Mask


@dataclass(frozen=True)
class ChartStyle:
    """How a chart is drawn.

    Attributes
    ----------
    construction : flat (numbers on both sides) or round (numbers at the right).
    first_side : the side of row 1 in flat knitting.
    aspect : height over width of a stitch, from the gauge.
    yarn_facts : of each yarn, printed after its name in the key, such as its length.
    repeats : linked repeats of the chart; without them the chart's own smallest repeat is marked.
    note : printed below the key.
    title : name of the design, printed above the chart.
    regions : named parts, whose borders are drawn in their colours.
    symbols : of the stitches.
    stitches : the chart with all its stitches, where the piece that is drawn is its purl map.
    """

    construction: Construction = Construction.FLAT
    first_side: Side = Side.RS
    aspect: float = 0.75
    yarn_facts: tuple[str, ...] = ()
    repeats: tuple[RepeatMark, ...] = ()
    note: str = ""
    title: str = ""
    regions: tuple[RegionMark, ...] = ()
    symbols: Symbols = Symbols.DOTS
    stitches: SymbolChart | None = None

    def __post_init__(self) -> None:
        check_range("aspect", self.aspect, 0.2, 5, what="the aspect ratio of a stitch")


Points = tuple[tuple[float, float], ...]
Span = tuple[float, float]


def symbol_shapes(
    symbols: Symbols, knits: Points, purls: Points, cell: tuple[float, float], colour: str
) -> Iterator[Shape]:
    """Symbols of stitches by the middles of their cells, whose width and height are given."""
    small = min(cell)
    if symbols is Symbols.CODES:
        for code, middles in (("K", knits), ("P", purls)):
            for x, y in middles:
                yield Label(x, y + 0.2 * small, code, 0.6 * small, "middle")
    elif symbols is Symbols.DOTS:
        yield Dots(purls, round(0.22 * small, 3), colour)
    if symbols in (Symbols.CODES, Symbols.DOTS):
        return
    half = 0.28 * cell[0]
    dashes = [(x - half, y, x + half, y) for x, y in purls]
    if symbols is Symbols.JAPANESE:
        half = 0.28 * cell[1]
        dashes += [(x, y - half, x, y + half) for x, y in knits]
    yield Lines(tuple(dashes), colour, round(0.12 * small, 3))


def stitch_shapes(
    stitch: StitchType,
    symbols: Symbols,
    corners: Points,
    cell: tuple[float, float],
    colour: str,
    within: Span = (-math.inf, math.inf),
) -> Iterator[Shape]:
    """The symbol of a stitch in boxes by their lower left corners, cut at the ends of a span."""
    small, (width, height) = min(cell), cell
    if symbols is Symbols.CODES:
        size = 0.6 * small if stitch.width == 1 and len(stitch.code) == 1 else 0.4 * small
        for x, y in corners:
            middle = x + width * stitch.width / 2
            if within[0] <= middle <= within[1]:
                label = stitch.code.strip("[]")
                yield Label(middle, y - height / 2 + 0.35 * size, label, size, "middle")
        return
    dashes, japanese = symbols is Symbols.DASHES, symbols is Symbols.JAPANESE
    symbol = symbol_of(stitch, dashes=dashes, japanese=japanese)
    lines = [
        cut
        for x, y in corners
        for stroke in symbol.strokes
        for (a, b), (c, d) in pairwise(stroke)
        if (cut := _cut((x + width * a, y - height * b, x + width * c, y - height * d), within))
    ]
    if lines:
        yield Lines(tuple(lines), colour, round(0.09 * small, 3))
    dots = [(x + width * a, y - height * b) for x, y in corners for a, b in symbol.dots]
    if dots := [dot for dot in dots if within[0] <= dot[0] <= within[1]]:
        is_alone = not symbol.strokes
        yield Dots(tuple(dots), round((0.22 if is_alone else 0.11) * small, 3), colour)


def _cut(
    line: tuple[float, float, float, float], within: Span
) -> tuple[float, float, float, float] | None:
    """The part of a line between two uprights."""
    (x, y, far, beyond), (low, high) = line, within
    if low <= min(x, far) and max(x, far) <= high:
        return line
    if max(x, far) <= low or min(x, far) >= high:
        return None
    ends = [min(max(end, low), high) for end in (x, far)]
    heights = [y + (beyond - y) * (end - x) / (far - x) for end in ends]
    return ends[0], heights[0], ends[1], heights[1]


def is_coloured(piece: Piece) -> bool:
    """Say whether the piece has several yarns, which its drawing tells apart by colour."""
    return len(piece.yarns) > 1


def key_height(piece: Piece, style: ChartStyle) -> float:
    """Room that the key takes below a chart."""
    yarns = len(piece.yarns) if is_coloured(piece) else 0
    lines = yarns + len(style.repeats) + len(_region_lines(style)) + len(_note_lines(style))
    return KEY_MM + KEY_LINE_MM * lines + _more_stitches(style)


def _more_stitches(style: ChartStyle) -> float:
    """Room that the stitches of the key take beyond two lines."""
    kinds = len(kinds_of(style)[:MAX_KINDS])
    return max((kinds if kinds <= KINDS_WITH_NAMES else -(-kinds // 2)) - 2, 0) * STITCH_LINE_MM


def kinds_of(style: ChartStyle) -> list[StitchType]:
    """Kinds of stitches of a chart that has others than knits and purls."""
    if style.stitches is None:
        return []
    return [STITCHES[place] for place in np.unique(style.stitches.cells) if place >= 0]


def _region_lines(style: ChartStyle) -> list[tuple[RegionMark, ...]]:
    """The regions, as many to a line as there is room for."""
    starts = range(0, len(style.regions), REGIONS_IN_A_LINE)
    return [style.regions[k : k + REGIONS_IN_A_LINE] for k in starts]


def _note_lines(style: ChartStyle) -> list[str]:
    wrapped = [
        line for part in style.note.splitlines() for line in textwrap.wrap(part, NOTE_CHARACTERS)
    ]
    return wrapped[:NOTE_LINES]


def has_repeat(chart: StitchChart | SymbolChart) -> bool:
    """Say whether a chart repeats a part of itself."""
    return chart.repeat_cut() != chart


def _stitch_lines(style: ChartStyle, y: float) -> Iterator[Shape]:
    """A line for each kind of stitch; many stand in two columns, without their names."""
    kinds = kinds_of(style)
    in_full = len(kinds) <= KINDS_WITH_NAMES
    for index, stitch in enumerate(kinds[:MAX_KINDS]):
        row, column = (index, 0) if in_full else divmod(index, 2)
        x, top, width = MARGIN_MM + 90.0 * column, y + STITCH_LINE_MM * row, 4.0 * stitch.width
        yield Rectangle(x, top - 3.0, width, 4.0, fill="#ffffff", stroke=GRID)
        yield from stitch_shapes(stitch, style.symbols, ((x, top + 1.0),), (4.0, 4.0), INK)
        words, back = stitch.words, stitch.turned_over.words
        if style.construction is Construction.FLAT and back != words:
            words = f"{words} on RS, {back} on WS"
        if index == MAX_KINDS - 1 and len(kinds) > MAX_KINDS:
            words = f"{words}; and {len(kinds) - MAX_KINDS} more kinds"
        yield Label(x + 2.0 + width, top, f"{stitch.name}: {words}" if in_full else words)


def multiple_words(repeat: StitchChart | SymbolChart, edge_columns: int, edge_rows: int) -> str:
    """How many stitches and rows a repeat takes, with those that are left at the edges.

    >>> multiple_words(StitchChart.parse("KKPP"), 2, 0)
    'multiple of 4 + 2 sts'
    """
    stitches = f"multiple of {repeat.columns}" + (f" + {edge_columns}" if edge_columns else "")
    if repeat.rows == 1:
        return f"{stitches} sts"
    rows = f"multiple of {repeat.rows}" + (f" + {edge_rows}" if edge_rows else "")
    return f"{stitches} sts, {rows} rows"


def shortened(name: str, most: int = 26) -> str:
    """A name as long as its place on paper; an ellipsis says that it goes on."""
    return name if len(name) <= most else f"{name[: most - 1]}…"


def tinted(colour: str) -> str:
    """A yarn's colour as its stitches are printed."""
    channels = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    mixed = (round(255 - (255 - channel) * TINT) for channel in channels)
    return "#{:02x}{:02x}{:02x}".format(*mixed)


def key_shapes(piece: Piece, style: ChartStyle, y: float) -> Iterator[Shape]:
    """The key, its first line at a height ``y`` on the page."""
    flat = style.construction is Construction.FLAT
    knit = "knit on RS, purl on WS" if flat else "knit"
    purl = "purl on RS, knit on WS" if flat else "purl"
    for index, words in enumerate((knit, purl) if style.stitches is None else ()):
        top = y + STITCH_LINE_MM * index
        yield Rectangle(MARGIN_MM, top - 3.0, 4.0, 4.0, fill="#ffffff", stroke=GRID)
        place = ((MARGIN_MM + 2.0, top - 1.0),)
        knits, purls = ((), place) if index else (place, ())
        yield from symbol_shapes(style.symbols, knits, purls, (4.0, 4.0), INK)
        yield Label(MARGIN_MM + 6.0, top, words)
    yield from _stitch_lines(style, y)
    x = MARGIN_MM + (50.0 if style.stitches is None else 140.0)
    if not piece.is_rectangle:
        yield Rectangle(x, y - 3.0, 4.0, 4.0, fill=NO_STITCH)
        yield Label(x + 6.0, y, "no stitch")
    elif not style.repeats and has_repeat(style.stitches or piece.chart):
        yield Rectangle(x, y - 3.0, 4.0, 4.0, stroke=HEAVY, line_width=0.7)
        yield Label(x + 6.0, y, "repeat")
    reading = (
        "odd rows from right to left, even rows from left to right"
        if flat and style.first_side is Side.RS
        else "even rows from right to left, odd rows from left to right"
        if flat
        else "every round from right to left"
    )
    y += _more_stitches(style)
    yield Label(MARGIN_MM, y + 11.0, f"Seen from the right side; read {reading}.", SMALL_MM)
    y += 17.0
    for index, yarn in enumerate(piece.yarns if is_coloured(piece) else ()):
        yield Rectangle(MARGIN_MM, y - 3.0, 4.0, 4.0, fill=tinted(yarn.colour), stroke=GRID)
        facts = style.yarn_facts[index : index + 1]
        said = f"{yarn_name(index)}: {yarn.name} ({yarn.colour})"
        yield Label(MARGIN_MM + 6.0, y, ", ".join([said, *facts]))
        y += KEY_LINE_MM
    for mark in style.repeats:
        yield Rectangle(MARGIN_MM, y - 3.0, 4.0, 4.0, stroke=HEAVY, line_width=0.7)
        yield Label(MARGIN_MM + 6.0, y, mark.words)
        y += KEY_LINE_MM
    for regions in _region_lines(style):
        for index, region in enumerate(regions):
            x = MARGIN_MM + index * REGION_MM
            yield Rectangle(x, y - 3.0, 4.0, 4.0, stroke=region.colour, line_width=0.6)
            yield Label(x + 6.0, y, textwrap.shorten(region.name, 22, placeholder="…"))
        y += KEY_LINE_MM
    for line in _note_lines(style):
        yield Label(MARGIN_MM, y, line, 2.8)
        y += KEY_LINE_MM
