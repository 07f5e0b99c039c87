"""A chart drawn for knitters: symbols, row and stitch numbers, sides, the repeat and a key.

Stitches of several yarns have their yarn's colour, lightened so that the symbols stay visible; "no
stitch" is grey.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import groupby, pairwise

import numpy as np

from knitcore.base.arrays import Mask
from knitcore.chart.row_sides import Construction, Side, side_of_row
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import STITCHES
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.write.chart_key import (
    FAINT,
    GRID,
    HEAVY,
    INK,
    MARGIN_MM,
    NO_STITCH,
    SMALL_MM,
    TENTH,
    ChartStyle,
    Points,
    has_repeat,
    is_coloured,
    key_height,
    key_shapes,
    multiple_words,
    stitch_shapes,
    symbol_shapes,
    tinted,
)
from knitcore.formats.write.drawn_page import Label, Lines, Page, Rectangle, Shape, to_pdf, to_svg
from knitcore.garment.piece import Piece

CELL_MM = 5.0
MIN_CELL_MM = 3.0
OVERLAP = 2
"""Rows and stitches at the edge of a page that are repeated from the page before."""
TENTHS = 10
LINE = 1.15
"""Distance of lines of numbers over the size of their type."""
OVERVIEW_CELL_MM = 2.0
HEADER_MM = 14.0
LEFT_MM, TOP_MM = MARGIN_MM + 6.0, HEADER_MM + MARGIN_MM
"""Place of a chart on its page."""
A4_MM = (210.0, 297.0)
NUMBERED_UP_TO = 40
"""Most stitches of a row that are all numbered; longer rows get every fifth number."""


def chart_svg(chart: StitchChart | Piece | SymbolChart, style: ChartStyle | None = None) -> str:
    """The whole chart as one SVG drawing."""
    piece, style = _drawn(chart, style)
    size = range(piece.chart.rows), range(piece.chart.columns)
    return to_svg(_Part(piece, style, *size, CELL_MM).page(), _title(piece.chart))


def chart_pdf(chart: StitchChart | Piece | SymbolChart, style: ChartStyle | None = None) -> bytes:
    """The chart as a PDF of :func:`chart_pages`."""
    return to_pdf(chart_pages(chart, style), _title(_drawn(chart, style)[0].chart))


def _drawn(
    chart: StitchChart | Piece | SymbolChart, style: ChartStyle | None
) -> tuple[Piece, ChartStyle]:
    """The piece that is drawn, and the style with all stitches of a chart that has others."""
    style = style or ChartStyle()
    if isinstance(chart, SymbolChart) and not chart.is_plain:
        return Piece.plain(chart.plain), replace(style, stitches=chart)
    return Piece.of(chart), style


def chart_pages(
    chart: StitchChart | Piece | SymbolChart, style: ChartStyle | None = None, *, first: int = 1
) -> tuple[Page, ...]:
    """The chart as A4 pages: one if it fits with cells of at least 3 mm, otherwise several.

    Every page has its numbers and the key, and two stitches of the pages beside it; pages go from
    the bottom right, where flat knitting begins, to the left and then up. Several pages begin with
    an overview, which has the names of the regions, the notes, and the numbers of the pages; that
    of the overview itself is ``first``.
    """
    piece, style = _drawn(chart, style)
    chart = piece.chart
    room_x = A4_MM[0] - 2 * MARGIN_MM - 12.0
    room_y = A4_MM[1] - HEADER_MM - key_height(piece, style) - 2 * MARGIN_MM
    cell = min(CELL_MM, room_x / chart.columns, room_y / (chart.rows * style.aspect))
    cell = max(cell, MIN_CELL_MM)
    if chart.columns * cell <= room_x + 1e-9 and chart.rows * cell * style.aspect <= room_y + 1e-9:
        whole = _Part(piece, style, range(chart.rows), range(chart.columns), cell)
        return (whole.page(paper=A4_MM),)
    bare = replace(style, note="")
    room_y = A4_MM[1] - HEADER_MM - key_height(piece, bare) - 2 * MARGIN_MM
    across, up = int(room_x / cell), int(room_y / (cell * style.aspect))
    places = [
        (rows, columns)
        for rows in _pieces(chart.rows, up)
        for columns in reversed(_pieces(chart.columns, across))
    ]
    most_rows, most_columns = (max(map(len, part)) for part in zip(*places, strict=True))
    cell = min(CELL_MM, room_x / most_columns, room_y / (most_rows * style.aspect))
    parts = [_Part(piece, bare, rows, columns, cell) for rows, columns in places]
    overview = Page(*A4_MM, tuple(_overview(piece, style, parts, first)))
    return (overview, *(part.page(paper=A4_MM) for part in parts))


def _pieces(count: int, most: int) -> list[range]:
    pieces = 1 if count <= most else math.ceil(count / (most - OVERLAP))
    edges = np.linspace(0, count, pieces + 1).round().astype(int).tolist()
    return [range(max(0, a - OVERLAP) if a else 0, b) for a, b in pairwise(edges)]


def _title(chart: StitchChart) -> str:
    return f"{chart.columns} stitches × {chart.rows} rows"


def _overview(piece: Piece, style: ChartStyle, parts: list[_Part], first: int) -> Iterator[Shape]:
    """The overview: the parts of the chart on each page, the regions by name, and the notes."""
    chart = piece.chart
    room_y = A4_MM[1] - HEADER_MM - key_height(piece, style) - 2 * MARGIN_MM
    room_x = A4_MM[0] - 2 * MARGIN_MM - 12.0
    cell = min(OVERVIEW_CELL_MM, room_x / chart.columns, room_y / (chart.rows * style.aspect))
    whole = _Part(piece, style, range(chart.rows), range(chart.columns), cell)
    yield from whole.header()
    yield from whole.silhouette()
    yield from whole.symbols(FAINT)
    yield from whole.region_borders()
    for number, part in enumerate(parts, start=first + 1):
        left, top = whole.x(part.columns.start), whole.y(part.rows.stop - 1)
        width, height = cell * len(part.columns), cell * style.aspect * len(part.rows)
        yield Rectangle(left, top, width, height, stroke=HEAVY, line_width=0.3)
        middle = left + width / 2
        yield from _on_a_plate(middle, top + height / 2 + 1.0, f"page {number}", 4.0)
    for region in style.regions:
        rows, columns = np.nonzero(region.cells)
        if len(rows):
            x = whole.x(int(columns.min())) + 1.0
            top = whole.y(int(rows.max()))
            yield from _on_a_plate(x, top + 3.6, region.name, SMALL_MM, "start")
    yield from key_shapes(piece, style, whole.bottom + 10.0)


def _on_a_plate(
    x: float, y: float, text: str, size: float, anchor: str = "middle"
) -> Iterator[Shape]:
    """A label that can be read above lines and dots."""
    width = 0.55 * size * len(text) + size / 2
    left = x - width / 2 if anchor == "middle" else x - size / 4
    yield Rectangle(left, y - 0.95 * size, width, 1.3 * size, fill="#ffffff")
    yield Label(x, y, text, size, anchor)


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
        height = HEADER_MM + 2 * MARGIN_MM + key_height(self.piece, self.style) + self._height
        if paper is not None:
            width, height = paper
        else:
            width = max(width, 120.0 if self.style.stitches is None else 190.0)
        return Page(width, height, tuple(self._shapes()))

    @property
    def chart(self) -> StitchChart:
        return self.piece.chart

    @property
    def _whole(self) -> StitchChart | SymbolChart:
        """The chart with all its stitches."""
        return self.style.stitches or self.chart

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
    def bottom(self) -> float:
        return TOP_MM + self._height

    def x(self, column: int) -> float:
        return LEFT_MM + self.cell * (column - self.columns.start)

    def y(self, row: int) -> float:
        """Upper edge of a row (rows count from the bottom)."""
        return TOP_MM + self._row_height * (self.rows.stop - 1 - row)

    def _shapes(self) -> Iterator[Shape]:
        yield from self.header()
        yield Rectangle(LEFT_MM, TOP_MM, self._width, self._height, fill="#ffffff")
        yield from self._colours()
        yield from self._grid()
        yield from self.symbols(INK)
        yield from self._no_stitches()
        yield from self.region_borders()
        if self.style.repeats:
            yield from self._placements()
        elif self.piece.is_rectangle:
            yield from self._repeat()
        yield from self._row_numbers()
        yield from self._stitch_numbers()
        yield from key_shapes(self.piece, self.style, self.bottom + 10.0)

    def header(self) -> Iterator[Shape]:
        part = ""
        if len(self.rows) < self.chart.rows or len(self.columns) < self.chart.columns:
            first, last = (self.chart.columns - self.columns[end] for end in (-1, 0))
            part = f"rows {self.rows.start + 1}–{self.rows.stop}, stitches {first}–{last} of "
        name = f"{self.style.title}: " if self.style.title else ""
        yield Label(MARGIN_MM, MARGIN_MM, name + part + _title(self.chart), 4.0)
        flat = self.style.construction is Construction.FLAT
        how = "worked flat" if flat else "worked in the round"
        about = (
            f"{self.piece.shaped.stitches} stitches inside the outline"
            if not self.piece.is_rectangle
            else _multiple(self._whole)
        )
        yield Label(MARGIN_MM, MARGIN_MM + 5.5, f"{how}; {about}", 3.0)

    def _boxes(
        self,
        rows: range,
        columns: range,
        fill: str | None = None,
        stroke: str | None = None,
        *,
        line_width: float = 0.7,
    ) -> Iterator[Rectangle]:
        """A box on these stitches, as far as they are in the window."""
        left, right = (max(columns.start, self.columns.start), min(columns.stop, self.columns.stop))
        low, high = max(rows.start, self.rows.start), min(rows.stop, self.rows.stop)
        if left < right and low < high:
            width, height = self.cell * (right - left), self._row_height * (high - low)
            yield Rectangle(
                self.x(left), self.y(high - 1), width, height, fill, stroke, line_width=line_width
            )

    def _colours(self) -> Iterator[Shape]:
        for row in self.rows if is_coloured(self.piece) else ():
            for run in self.piece.runs(row):
                fill = tinted(self.piece.yarns[run.yarn].colour)
                yield from self._boxes(range(row, row + 1), range(run.start, run.stop), fill)

    def _grid(self) -> Iterator[Lines]:
        """Fine lines, heavier every ten stitches from the right and every ten rows."""
        right, total = LEFT_MM + self._width, self.chart.columns
        fine: list[tuple[float, float, float, float]] = []
        tenth: list[tuple[float, float, float, float]] = []
        for column in range(self.columns.start, self.columns.stop + 1):
            line = (self.x(column), TOP_MM, self.x(column), self.bottom)
            (fine if (total - column) % TENTHS else tenth).append(line)
        for row in range(self.rows.start - 1, self.rows.stop):
            line = (LEFT_MM, self.y(row), right, self.y(row))
            (fine if (row + 1) % TENTHS else tenth).append(line)
        yield Lines(tuple(fine), GRID, 0.15)
        yield Lines(tuple(tenth), TENTH, 0.3)

    def symbols(self, colour: str) -> Iterator[Shape]:
        """The symbols of the stitches."""
        if self.style.stitches is not None:
            yield from self._stitches(self.style.stitches, colour)
            return
        window = np.s_[self.rows.start : self.rows.stop, self.columns.start : self.columns.stop]
        purl, stitch = self.chart.purl[window], self.piece.shaped.stitch[window]
        knits, purls = self._middles(stitch & ~purl), self._middles(stitch & purl)
        cell = (self.cell, self._row_height)
        yield from symbol_shapes(self.style.symbols, knits, purls, cell, colour)

    def _stitches(self, chart: SymbolChart, colour: str) -> Iterator[Shape]:
        """Symbols of any stitches; those that the window cuts are drawn as far as it reaches."""
        cell, within = (self.cell, self._row_height), (LEFT_MM, LEFT_MM + self._width)
        for place in np.unique(chart.cells):
            stitch = STITCHES[place]
            rows, columns = np.nonzero(chart.cells == place)
            inside = (columns + stitch.width > self.columns.start) & (columns < self.columns.stop)
            inside &= (rows >= self.rows.start) & (rows < self.rows.stop) & (place >= 0)
            cells = list(zip(rows[inside].tolist(), columns[inside].tolist(), strict=True))
            if stitch.width > 1:
                for row, column in cells:
                    box = range(row, row + 1), range(column, column + stitch.width)
                    yield from self._boxes(*box, "#ffffff", GRID, line_width=0.15)
            corners = tuple((self.x(column), self.y(row - 1)) for row, column in cells)
            yield from stitch_shapes(stitch, self.style.symbols, corners, cell, colour, within)

    def _middles(self, cells: Mask) -> Points:
        rows, columns = np.nonzero(cells)
        x = LEFT_MM + self.cell * (columns + 0.5)
        y = TOP_MM + self._row_height * (len(self.rows) - 0.5 - rows)
        return tuple(zip(x.tolist(), y.tolist(), strict=True))

    def silhouette(self) -> Iterator[Shape]:
        """The piece as one tone."""
        row = 0
        for (start, stop), alike in groupby(self.piece.shaped.spans):
            rows = len(list(alike))
            width, height = self.cell * (stop - start), self._row_height * rows
            row += rows
            yield Rectangle(self.x(start), self.y(row - 1), width, height, fill="#efece6")

    def region_borders(self) -> Iterator[Lines]:
        """Borders of the regions in their colours."""
        for region in self.style.regions:
            window = np.s_[self.rows.start : self.rows.stop, self.columns.start : self.columns.stop]
            cells = np.pad(region.cells[window], 1)
            lines = [
                (self.x(c), self.y(r), self.x(c), self.y(r - 1))
                for r, c in self._edges(cells[1:-1, 1:] != cells[1:-1, :-1])
            ] + [
                (self.x(c), self.y(r - 1), self.x(c + 1), self.y(r - 1))
                for r, c in self._edges(cells[1:, 1:-1] != cells[:-1, 1:-1])
            ]
            if lines:
                yield Lines(tuple(lines), region.colour, 0.6)

    def _edges(self, changes: Mask) -> list[tuple[int, int]]:
        """Rows and columns of the chart at which something changes."""
        first = np.array([self.rows.start, self.columns.start])
        return [(int(r), int(c)) for r, c in np.argwhere(changes) + first]

    def _no_stitches(self) -> Iterator[Shape]:
        """Grey boxes before and after the stitches of each row."""
        for row in self.rows:
            start, stop = self.piece.shaped.spans[row]
            for outside in (range(start), range(stop, self.chart.columns)):
                yield from self._boxes(range(row, row + 1), outside, NO_STITCH)

    def _repeat(self) -> Iterator[Shape]:
        """A heavy border around the repeat at the bottom right, where row 1 begins."""
        repeat, columns = self._whole.repeat_cut(), self.chart.columns
        if has_repeat(self._whole):
            right = range(columns - repeat.columns, columns)
            yield from self._boxes(range(repeat.rows), right, stroke=HEAVY)

    def _placements(self) -> Iterator[Shape]:
        """A heavy border around every copy of a linked repeat, as far as it is on this page."""
        for mark in self.style.repeats:
            for row, column, rows, columns in mark.places:
                yield from self._boxes(
                    range(row, row + rows), range(column, column + columns), stroke=HEAVY
                )

    def _row_numbers(self) -> Iterator[Shape]:
        """Right-side rows at the right, wrong-side rows at the left: as many as leave room."""
        flat = self.style.construction is Construction.FLAT
        apart = self._row_height * (2 if flat else 1)
        step = next((n for n in (1, 2, 5) if n * apart >= LINE * SMALL_MM), 10)
        for row in self.rows:
            if (row // 2 if flat else row) % step:
                continue
            side = side_of_row(row, self.style.construction, self.style.first_side)
            y = self.y(row) + self._row_height / 2 + SMALL_MM * 0.35
            if side is Side.RS:
                yield Label(LEFT_MM + self._width + 1.2, y, str(row + 1), SMALL_MM)
            else:
                yield Label(LEFT_MM - 1.2, y, str(row + 1), SMALL_MM, "end")

    def _stitch_numbers(self) -> Iterator[Shape]:
        y = self.bottom + 3.4
        every = 1 if self.chart.columns <= NUMBERED_UP_TO and self.cell >= 4 else 5
        for column in self.columns:
            number = self.chart.columns - column
            if number % every == 0 or number == 1:
                yield Label(self.x(column) + self.cell / 2, y, str(number), SMALL_MM, "middle")


def _multiple(chart: StitchChart | SymbolChart) -> str:
    repeat = chart.repeat_cut()
    if repeat == chart:
        return "no repeat"
    return multiple_words(repeat, chart.columns % repeat.columns, chart.rows % repeat.rows)
