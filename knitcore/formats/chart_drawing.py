"""A chart drawn for knitters: symbols, row and stitch numbers, sides, the repeat and a key.

Stitches of several yarns have their yarn's colour, lightened so that the symbols are seen; "no
stitch" is grey.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.formats.drawing import Box, Dots, Label, Page, Shape, Strokes, to_pdf, to_svg
from knitcore.garment.piece import Piece, yarn_name
from knitcore.worked import Construction, Side, side_of_row

CELL_MM = 5.0
SMALLEST_CELL_MM = 3.0
MARGIN_MM = 12.0
HEADER_MM = 14.0
KEY_MM = 24.0
KEY_LINE_MM = 5.0
NOTE_CHARACTERS, NOTE_LINES = 110, 14
TINT = 0.55
"""Share of a yarn's colour in its stitches; the rest is white."""
A4_MM = (210.0, 297.0)
NUMBERED_UP_TO = 40
"""Longer rows get every fifth number."""
_INK, _GRID, _HEAVY, _NO_STITCH = "#222222", "#b5b0a8", "#b3322b", "#d9d5ce"


@dataclass(frozen=True)
class ChartStyle:
    """How a chart is drawn.

    Attributes
    ----------
    construction : flat (numbers on both sides) or round (numbers at the right).
    first_side : the side of row 1 in flat knitting.
    aspect : height over width of a stitch, from the gauge.
    yarn_facts : of each yarn, what the key says beside its name, such as its length.
    note : printed below the key.
    """

    construction: Construction = Construction.FLAT
    first_side: Side = Side.RS
    aspect: float = 0.75
    yarn_facts: tuple[str, ...] = ()
    note: str = ""

    def __post_init__(self) -> None:
        if not (math.isfinite(self.aspect) and 0.2 <= self.aspect <= 5):
            raise InputError(
                "aspect", f"{self.aspect:g} is no shape of a stitch.", "Give 0.2 to 5."
            )


def chart_svg(chart: StitchChart | Piece, style: ChartStyle | None = None) -> str:
    """The whole chart as one SVG drawing."""
    piece = _piece(chart)
    size = range(piece.chart.rows), range(piece.chart.columns)
    return to_svg(_Part(piece, style or ChartStyle(), *size, CELL_MM).page(), _title(piece.chart))


def chart_pdf(chart: StitchChart | Piece, style: ChartStyle | None = None) -> bytes:
    """The chart as a PDF of :func:`chart_pages`."""
    return to_pdf(chart_pages(chart, style), _title(_piece(chart).chart))


def chart_pages(chart: StitchChart | Piece, style: ChartStyle | None = None) -> tuple[Page, ...]:
    """The chart as A4 pages: one if it fits with cells of at least 3 mm, otherwise several.

    Every page has its numbers and the key; pages go from the bottom right, where flat knitting
    begins, to the left and then up.
    """
    style, piece = style or ChartStyle(), _piece(chart)
    chart = piece.chart
    room_x = A4_MM[0] - 2 * MARGIN_MM - 12.0
    room_y = A4_MM[1] - HEADER_MM - _key_height(piece, style) - 2 * MARGIN_MM
    cell = min(CELL_MM, room_x / chart.columns, room_y / (chart.rows * style.aspect))
    cell = max(cell, SMALLEST_CELL_MM)
    across, up = int(room_x / cell), int(room_y / (cell * style.aspect))
    parts = [
        _Part(piece, style, rows, columns, cell)
        for rows in _pieces(chart.rows, up)
        for columns in reversed(_pieces(chart.columns, across))
    ]
    return tuple(part.page(paper=A4_MM) for part in parts)


def _piece(chart: StitchChart | Piece) -> Piece:
    return chart if isinstance(chart, Piece) else Piece.plain(chart)


def _coloured(piece: Piece) -> bool:
    return len(piece.yarns) > 1


def _key_height(piece: Piece, style: ChartStyle) -> float:
    yarns = len(piece.yarns) if _coloured(piece) else 0
    return KEY_MM + KEY_LINE_MM * (yarns + len(_note_lines(style)))


def _note_lines(style: ChartStyle) -> list[str]:
    wrapped = [
        line for part in style.note.splitlines() for line in textwrap.wrap(part, NOTE_CHARACTERS)
    ]
    return wrapped[:NOTE_LINES]


def tinted(colour: str) -> str:
    """A yarn's colour as its stitches are printed."""
    channels = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    mixed = (round(255 - (255 - channel) * TINT) for channel in channels)
    return "#{:02x}{:02x}{:02x}".format(*mixed)


def _pieces(count: int, most: int) -> list[range]:
    pieces = math.ceil(count / most)
    edges = np.linspace(0, count, pieces + 1).round().astype(int).tolist()
    return [range(a, b) for a, b in pairwise(edges)]


def _title(chart: StitchChart) -> str:
    return f"{chart.columns} stitches × {chart.rows} rows"


@dataclass(frozen=True)
class _Part:
    """A window of a chart on a page."""

    piece: Piece
    style: ChartStyle
    rows: range
    columns: range
    cell: float

    def page(self, paper: tuple[float, float] | None = None) -> Page:
        width = 2 * MARGIN_MM + 12.0 + self._width
        height = HEADER_MM + 2 * MARGIN_MM + _key_height(self.piece, self.style) + self._height
        if paper is not None:
            width, height = paper
        else:
            width = max(width, 120.0)
        return Page(width, height, tuple(self._shapes()))

    @property
    def chart(self) -> StitchChart:
        return self.piece.chart

    @property
    def _is_shaped(self) -> bool:
        return not self.piece.is_rectangle

    @property
    def _row_height(self) -> float:
        return self.cell * self.style.aspect

    @property
    def _width(self) -> float:
        return self.cell * len(self.columns)

    @property
    def _height(self) -> float:
        return self._row_height * len(self.rows)

    @property
    def _left(self) -> float:
        return MARGIN_MM + 6.0

    @property
    def _top(self) -> float:
        return HEADER_MM + MARGIN_MM

    def _x(self, column: int) -> float:
        return self._left + self.cell * (column - self.columns.start)

    def _y(self, row: int) -> float:
        """Upper edge of a row (rows count from the bottom)."""
        return self._top + self._row_height * (self.rows.stop - 1 - row)

    def _shapes(self) -> Iterator[Shape]:
        yield from self._header()
        yield Box(self._left, self._top, self._width, self._height, fill="#ffffff")
        yield from self._colours()
        yield self._grid()
        yield self._purls()
        yield from self._no_stitches()
        if not self._is_shaped:
            yield from self._repeat()
        yield from self._row_numbers()
        yield from self._stitch_numbers()
        yield from self._key()

    def _header(self) -> Iterator[Shape]:
        part = ""
        if len(self.rows) < self.chart.rows or len(self.columns) < self.chart.columns:
            first, last = _stitch_number(self.chart, self.columns)
            part = f"rows {self.rows.start + 1}–{self.rows.stop}, stitches {first}–{last} of "
        yield Label(MARGIN_MM, MARGIN_MM, part + _title(self.chart), 4.0)
        flat = self.style.construction is Construction.FLAT
        how = "worked flat" if flat else "worked in the round"
        about = (
            f"{self.piece.shaped.stitches} stitches inside the outline"
            if self._is_shaped
            else _multiple(self.chart)
        )
        yield Label(MARGIN_MM, MARGIN_MM + 5.5, f"{how}; {about}", 3.0)

    def _colours(self) -> Iterator[Shape]:
        if not _coloured(self.piece):
            return
        for row in self.rows:
            for stretch in self.piece.stretches(row):
                first = max(stretch.start, self.columns.start)
                last = min(stretch.stop, self.columns.stop)
                if first < last:
                    fill = tinted(self.piece.yarns[stretch.yarn].colour)
                    width = self.cell * (last - first)
                    yield Box(self._x(first), self._y(row), width, self._row_height, fill=fill)

    def _grid(self) -> Strokes:
        right, bottom = self._left + self._width, self._top + self._height
        upright = [
            (self._x(c), self._top, self._x(c), bottom)
            for c in range(self.columns.start, self.columns.stop + 1)
        ]
        level = [
            (self._left, self._y(r), right, self._y(r))
            for r in range(self.rows.start - 1, self.rows.stop)
        ]
        return Strokes(tuple(upright + level), _GRID, 0.15)

    def _purls(self) -> Dots:
        window = (self.chart.purl & self.piece.shaped.stitch)[
            self.rows.start : self.rows.stop, self.columns.start : self.columns.stop
        ]
        rows, columns = np.nonzero(window)
        x = self._left + self.cell * (columns + 0.5)
        y = self._top + self._row_height * (len(self.rows) - 0.5 - rows)
        radius = round(0.22 * min(self.cell, self._row_height), 3)
        return Dots(tuple(zip(x.tolist(), y.tolist(), strict=True)), radius, _INK)

    def _no_stitches(self) -> Iterator[Shape]:
        """Grey boxes before and after the stitches of each row."""
        spans = self.piece.shaped.spans
        for row in self.rows:
            for start, stop in ((0, spans[row][0]), (spans[row][1], self.chart.columns)):
                first, last = max(start, self.columns.start), min(stop, self.columns.stop)
                if first < last:
                    width = self.cell * (last - first)
                    x, y = self._x(first), self._y(row)
                    yield Box(x, y, width, self._row_height, fill=_NO_STITCH)

    def _repeat(self) -> Iterator[Shape]:
        """A heavy border around the repeat at the bottom right, where row 1 begins."""
        repeat = self.chart.repeat_cut()
        if repeat == self.chart:
            return
        start = max(self.chart.columns - repeat.columns, self.columns.start)
        if self.rows.start >= repeat.rows or start >= self.columns.stop:
            return
        top = min(repeat.rows, self.rows.stop) - 1
        yield Box(
            self._x(start),
            self._y(top),
            self.cell * (self.columns.stop - start),
            self._row_height * (top + 1 - self.rows.start),
            stroke=_HEAVY,
            line_width=0.7,
        )

    def _row_numbers(self) -> Iterator[Shape]:
        size = min(2.6, 0.85 * self._row_height)
        step = 1 if self._row_height > 2.2 else 2
        for row in self.rows:
            number = row + 1
            if number % step and number != 1:
                continue
            side = side_of_row(row, self.style.construction, self.style.first_side)
            y = self._y(row) + self._row_height / 2 + size * 0.35
            if side is Side.RS:
                x = self._left + self._width + 1.2
                yield Label(x, y, str(number), size)
            else:
                yield Label(self._left - 1.2, y, str(number), size, "end")

    def _stitch_numbers(self) -> Iterator[Shape]:
        y = self._top + self._height + 3.4
        every = 1 if self.chart.columns <= NUMBERED_UP_TO and self.cell >= 4 else 5
        for column in self.columns:
            number = self.chart.columns - column
            if number % every == 0 or number == 1:
                yield Label(self._x(column) + self.cell / 2, y, str(number), 2.4, "middle")

    def _key(self) -> Iterator[Shape]:
        y = self._top + self._height + 10.0
        flat = self.style.construction is Construction.FLAT
        knit = "knit on RS, purl on WS" if flat else "knit"
        purl = "purl on RS, knit on WS" if flat else "purl"
        for index, (dot, words) in enumerate(((False, knit), (True, purl))):
            top = y + 5.5 * index
            yield Box(MARGIN_MM, top - 3.0, 4.0, 4.0, fill="#ffffff", stroke=_GRID)
            if dot:
                yield Dots(((MARGIN_MM + 2.0, top - 1.0),), 0.9, _INK)
            yield Label(MARGIN_MM + 6.0, top, words)
        x = MARGIN_MM + 50.0
        if self._is_shaped:
            yield Box(x, y - 3.0, 4.0, 4.0, fill=_NO_STITCH)
            yield Label(x + 6.0, y, "no stitch")
        elif self.chart.repeat_cut() != self.chart:
            yield Box(x, y - 3.0, 4.0, 4.0, stroke=_HEAVY, line_width=0.7)
            yield Label(x + 6.0, y, "repeat")
        reading = (
            "odd rows from right to left, even rows from left to right"
            if flat and self.style.first_side is Side.RS
            else "even rows from right to left, odd rows from left to right"
            if flat
            else "every round from right to left"
        )
        yield Label(MARGIN_MM, y + 11.0, f"Seen from the right side; read {reading}.", 2.6)
        y += 17.0
        if _coloured(self.piece):
            for index, yarn in enumerate(self.piece.yarns):
                yield Box(MARGIN_MM, y - 3.0, 4.0, 4.0, fill=tinted(yarn.colour), stroke=_GRID)
                facts = self.style.yarn_facts[index : index + 1]
                said = f"{yarn_name(index)}: {yarn.name} ({yarn.colour})"
                yield Label(MARGIN_MM + 6.0, y, ", ".join([said, *facts]))
                y += KEY_LINE_MM
        for line in _note_lines(self.style):
            yield Label(MARGIN_MM, y, line, 2.8)
            y += KEY_LINE_MM


def _stitch_number(chart: StitchChart, columns: range) -> tuple[int, int]:
    return chart.columns - columns.stop + 1, chart.columns - columns.start


def _multiple(chart: StitchChart) -> str:
    repeat = chart.repeat_cut()
    if repeat == chart:
        return "no repeat"
    extra_stitches = chart.columns % repeat.columns
    extra_rows = chart.rows % repeat.rows
    stitches = f"multiple of {repeat.columns}" + (f" + {extra_stitches}" if extra_stitches else "")
    rows = f"multiple of {repeat.rows}" + (f" + {extra_rows}" if extra_rows else "")
    return f"{stitches} sts, {rows} rows"
