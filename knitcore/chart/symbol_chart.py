"""The chart of any stitches: lace, cables, slipped, tucked and twisted ones among knit and purl."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.base.kinds import check_kind
from knitcore.chart.stitch_chart import (
    KNIT_SYMBOLS,
    PURL_SYMBOLS,
    StitchChart,
    as_chart,
    check_chart_size,
    is_name_of_fabric,
    period,
)
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.stitch_kinds import (
    BY_CODE,
    KNIT,
    PURL,
    STITCHES,
    Site,
    StitchType,
    YarnAct,
    place_of,
)

Cells = NDArray[np.int16]
CONTINUED = -1
"""The number of a cell that belongs to the stitch on its left."""

CODE = re.compile(r"\[[^\]\s]*\]|[^\s,]")
"""One stitch in a text."""
_PLAIN = KNIT_SYMBOLS | PURL_SYMBOLS | set("/ \t,\r\n\ufeff")
_ALIASES = dict.fromkeys(KNIT_SYMBOLS, "K") | dict.fromkeys(PURL_SYMBOLS, "P")


@dataclass(frozen=True, eq=False)
class SymbolChart:
    """A rectangular chart of stitches as the face shows them, immutable.

    Each row takes as many loops as the row below leaves, so that all rows have one width.

    Parameters
    ----------
    cells : int array (rows, columns)
        Places in :data:`knitcore.chart.stitch_kinds.STITCHES`; a stitch that is wider than one
        column stands in its leftmost cell and :data:`CONTINUED` in its others. Row 0 is the bottom
        row.

    Raises
    ------
    InputError
        If the chart is empty or over-large, a stitch reaches over its edge, a row does not
        balance or a stitch is never knitted; the row and the stitch are named.

    Examples
    --------
    >>> mesh = SymbolChart.parse("KKKK\\nO/\\\\O")
    >>> mesh.is_plain, mesh.columns
    (False, 4)
    >>> print(SymbolChart.parse("P[2/2R]P;PKKKKP").mirror())
    P[2/2L]P
    PKKKKP
    """

    cells: Cells

    def __post_init__(self) -> None:
        cells = _as_cells(self.cells)
        for row, line in enumerate(cells, start=1):
            _check_row(line, row)
        cells.setflags(write=False)
        object.__setattr__(self, "cells", cells)
        if not self.is_plain:
            _check_knitted(self)

    @classmethod
    def parse(cls, text: str) -> SymbolChart:
        """Read rows of codes, the top row first.

        Rows end with a line or with ``;``. A text of nothing but knits and purls is read as
        :meth:`StitchChart.parse` does, where ``/`` also ends a row; elsewhere ``/`` is knit 2
        together. Blanks and commas between stitches and lines that begin with ``#`` are passed
        over.

        Raises
        ------
        InputError
            As the class, and where a sign is no stitch.

        Examples
        --------
        >>> SymbolChart.parse("KP/PK").text
        'KP\\nPK'
        """
        check_kind("chart", text, str, "Give rows of stitches such as 'O/KK;KKKK'.")
        if _is_plain_text(text):
            return cls.of(StitchChart.parse(text))
        lines = _lines(text)
        rows = [row for line in lines for row in line.lstrip("\ufeff").split(";") if row.strip()]
        cells = [_read_row(row, len(rows) - above) for above, row in enumerate(rows)]
        widths = [len(row) for row in cells]
        if min(widths) < max(widths):
            row = next(row for row, width in enumerate(widths) if width != widths[0])
            raise InputError(
                "chart",
                f"row {len(rows) - row} is {widths[row]} wide, "
                f"row {len(rows)} is {widths[0]} wide.",
                "Give every row the same number of stitches.",
            )
        return cls(np.array(cells[::-1], dtype=np.int16))

    @classmethod
    def of(cls, chart: StitchChart) -> SymbolChart:
        """A chart of knits and purls as one of stitches."""
        return cls(np.where(chart.purl, BY_CODE["P"], BY_CODE["K"]).astype(np.int16))

    @classmethod
    def of_sites(cls, rows: Sequence[Sequence[Site]]) -> SymbolChart:
        """Find the stitches of sites.

        Parameters
        ----------
        rows : sites from the left, the bottom row first; their sources are columns of the row
            below.

        Raises
        ------
        InputError
            As the class, and where no stitch takes its loops as a site does.
        """
        return cls(
            np.array(
                [_stitches_of(sites, row) for row, sites in enumerate(rows, 1)], dtype=np.int16
            )
        )

    @property
    def rows(self) -> int:
        """Number of courses."""
        return int(self.cells.shape[0])

    @property
    def columns(self) -> int:
        """Number of wales."""
        return int(self.cells.shape[1])

    @cached_property
    def is_plain(self) -> bool:
        """True where the chart has knits and purls alone."""
        return bool((self.cells <= BY_CODE["P"]).all() and (self.cells != CONTINUED).all())

    @cached_property
    def purl(self) -> Mask:
        """The purl map, (rows, columns): what is a purl on the face.

        A slipped or tucked stitch is as the stitch that it holds; a yarn over is a knit.
        """
        graph = self.graph
        purl: Mask = graph.purl & (graph.act == YarnAct.THROUGH)
        holds = (graph.act != YarnAct.THROUGH) & (np.diff(graph.first, axis=1) > 0)
        for _ in range(self.rows if holds.any() else 0):
            for row, column in np.argwhere(holds):
                purl[row, column] = purl[row - 1, graph.sources(row, column)[0] % self.columns]
        return purl

    @property
    def plain(self) -> StitchChart:
        """The purl map as a chart of knits and purls: the chart itself where it is plain."""
        return StitchChart(self.cells == BY_CODE["P"] if self.is_plain else self.purl)

    @cached_property
    def graph(self) -> StitchGraph:
        """The graph of what every loop is pulled through, held by or laid over."""
        act = np.zeros(self.cells.shape, dtype=np.uint8)
        purl, front = np.zeros(self.cells.shape, dtype=bool), np.zeros(self.cells.shape, dtype=bool)
        turn = np.zeros(self.cells.shape, dtype=np.int8)
        first = np.zeros((self.rows, self.columns + 1), dtype=np.intp)
        source: list[int] = []
        layer: list[int] = []
        for row, line in enumerate(self.cells):
            taken = 0
            for column in np.flatnonzero(line != CONTINUED):
                stitch = STITCHES[line[column]]
                for at, site in enumerate(stitch.sites, start=int(column)):
                    act[row, at], turn[row, at] = site.act, site.turn
                    purl[row, at], front[row, at] = site.purl, site.front
                    first[row, at] = len(source)
                    source += [taken + i for i in site.sources]
                    layer += [site.layer] * len(site.sources)
                taken += stitch.takes
            first[row, -1] = len(source)
        return StitchGraph(
            act, purl, front, turn, first, np.array(source, np.intp), np.array(layer, np.int8)
        )

    def stitch(self, row: int, column: int) -> StitchType:
        """Look up the stitch that a cell belongs to."""
        while self.cells[row, column] == CONTINUED:
            column -= 1
        return STITCHES[int(self.cells[row, column])]

    @property
    def text(self) -> str:
        """The chart as lines of codes, top row first; :meth:`parse` reads it back."""
        return "\n".join(
            "".join(STITCHES[place].code for place in row if place != CONTINUED)
            for row in self.cells[::-1]
        )

    @property
    def key(self) -> str:
        """The chart in one line: rows from the top between ``;``, or ``/`` where it is plain."""
        return self.text.replace("\n", "/" if self.is_plain else ";")

    def tile(self, down: int, across: int) -> SymbolChart:
        """The chart repeated ``down`` times along the wales and ``across`` times along courses."""
        if down < 1 or across < 1:
            raise InputError("tile", "the counts must be positive.", "Use whole numbers from 1.")
        check_chart_size(self.rows * down, self.columns * across)
        return SymbolChart(np.tile(self.cells, (down, across)))

    def repeat(self) -> SymbolChart:
        """The smallest repeat of which this chart has whole ones."""
        rows, columns = (period(grid) for grid in (self.cells, self.cells.T))
        return SymbolChart(self.cells[:rows, :columns])

    def repeat_cut(self) -> SymbolChart:
        """The smallest repeat whose periodic continuation, cut anywhere, gives this chart.

        As :meth:`StitchChart.repeat_cut`; it begins and ends between stitches.
        """
        rows, columns = (period(grid, cut=True) for grid in (self.cells, self.cells.T))
        return SymbolChart(self.cells[:rows, :columns])

    def mirror(self) -> SymbolChart:
        """The chart reflected left to right: a right cross becomes a left one."""
        return self._reflected({place: s.mirrored for place, s in self._kinds().items()})

    def turn_over(self) -> SymbolChart:
        """The back of the same cloth."""
        return self._reflected({place: s.turned_over for place, s in self._kinds().items()})

    def _kinds(self) -> dict[int, StitchType]:
        return {int(place): STITCHES[place] for place in np.unique(self.cells) if place >= 0}

    def _reflected(self, images: dict[int, StitchType]) -> SymbolChart:
        """The chart from right to left, each stitch replaced by its image."""
        cells = np.full_like(self.cells, CONTINUED)
        for place, image in images.items():
            row, column = np.nonzero(self.cells == place)
            cells[row, self.columns - column - image.width] = BY_CODE[image.code]
        return SymbolChart(cells)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SymbolChart) and np.array_equal(self.cells, other.cells)

    def __hash__(self) -> int:
        return hash((self.cells.shape, self.cells.tobytes()))

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"SymbolChart({self.rows} rows, {self.columns} columns)"


def as_stitches(chart: StitchChart | SymbolChart | str) -> StitchChart | SymbolChart:
    """Take a chart as it is, or read its text; one of knits and purls alone is a StitchChart.

    Raises
    ------
    InputError
        If it is neither, or its text is no chart.

    Examples
    --------
    >>> as_stitches("KP/PK"), as_stitches("KK;O/")
    (StitchChart(2 rows, 2 columns), SymbolChart(2 rows, 2 columns))
    """
    if isinstance(chart, StitchChart):
        return chart
    if isinstance(chart, str) and (is_name_of_fabric(chart) or _is_plain_text(chart)):
        return as_chart(chart)
    symbols = chart if isinstance(chart, SymbolChart) else SymbolChart.parse(chart)
    return symbols.plain if symbols.is_plain else symbols


def _lines(text: str) -> list[str]:
    return [line for line in text.splitlines() if not line.lstrip().startswith("#")]


def knits_and_purls(chart: StitchChart | SymbolChart) -> StitchChart:
    """Take a chart of knits and purls.

    Raises
    ------
    InputError
        If it has other stitches, which the message names.
    """
    if isinstance(chart, StitchChart):
        return chart
    if chart.is_plain:
        return chart.plain
    names = [STITCHES[place].name for place in np.unique(chart.cells) if place > BY_CODE["P"]]
    more = f" and {len(names) - 1} other kinds" if len(names) > 2 else ""
    raise InputError(
        "chart",
        f"the chart has {names[0]}{more or ''.join(f' and {name}' for name in names[1:])}; this "
        "takes knits and purls only.",
        "Use knit and purl, or `predict`, which takes every stitch.",
    )


def plain_chart(text: str) -> StitchChart:
    """Read rows of K and P, and refuse other stitches by their names.

    Raises
    ------
    InputError
        As :meth:`StitchChart.parse` and :func:`knits_and_purls`.
    """
    try:
        return StitchChart.parse(text)
    except InputError:
        stitches = stitches_in_text(text)
        if stitches is None:
            raise
    return knits_and_purls(stitches)


def stitches_in_text(text: str) -> SymbolChart | None:
    """The chart of a text of codes of stitches; None if it has other signs, or only K, P and /.

    Raises
    ------
    InputError
        As :meth:`SymbolChart.parse`, where rows of such codes make no chart.
    """
    codes = {_ALIASES.get(code, code) for code in CODE.findall("".join(_lines(text)))} - {
        ";",
        "\ufeff",
    }
    has_others = bool(codes - {"K", "P", "/"})
    return SymbolChart.parse(text) if has_others and codes <= BY_CODE.keys() else None


def _is_plain_text(text: str) -> bool:
    """Say whether a text has the signs of knits and purls alone, and those between them."""
    return set("".join(_lines(text))) <= _PLAIN


def _as_cells(cells: ArrayLike) -> Cells:
    grid = np.array(cells)
    if grid.ndim != 2 or grid.dtype.kind not in "iu":
        remedy = "Give rows of whole numbers: places in STITCHES, -1 where a stitch goes on."
        raise InputError("chart", "its cells are not rows of whole numbers.", remedy)
    check_chart_size(*grid.shape)
    if grid.min() < CONTINUED or grid.max() >= len(STITCHES):
        remedy = f"Use numbers from -1 to {len(STITCHES) - 1}."
        raise InputError("chart", "a cell holds no stitch.", remedy)
    return grid.astype(np.int16)


def _check_row(line: Cells, row: int) -> None:
    """Refuse a row whose stitches overlap or reach over its edge, or that does not balance."""
    starts = np.flatnonzero(line != CONTINUED)
    ends = np.append(starts[1:], len(line))
    if len(starts) == 0 or starts[0] > 0:
        remedy = "Begin the row with a stitch, or move the cable into the chart."
        raise InputError("chart", f"row {row} begins within a stitch.", remedy)
    for start, end in zip(starts, ends, strict=True):
        stitch = STITCHES[line[start]]
        if stitch.width != end - start:
            raise InputError(
                "chart",
                f"row {row}, stitch {start + 1}: {stitch.name} needs {stitch.width} columns and "
                f"has {end - start}.",
                "Move it so that it lies inside the chart, or choose a narrower one.",
            )
    takes = sum(STITCHES[place].takes for place in line[starts])
    if takes != len(line):
        more = takes > len(line)
        count = abs(takes - len(line))
        raise InputError(
            "chart",
            f"row {row} takes {takes} stitches of the row below, which has {len(line)}.",
            f"Add {count} yarn over{'s' if count > 1 else ''} or undo as many decreases."
            if more
            else f"Add {count} decrease{'s' if count > 1 else ''} or undo as many yarn overs.",
        )


def _check_knitted(chart: SymbolChart) -> None:
    """Refuse a stitch that no row ever knits."""
    graph = chart.graph
    idle = np.flatnonzero((graph.act == YarnAct.MISS).all(axis=1))
    if len(idle):
        remedy = "Knit, purl or tuck at least one stitch of every row."
        raise InputError("chart", f"row {idle[0] + 1} slips every stitch.", remedy)
    held = np.argwhere(graph.rows_held() < 0)
    if len(held):
        row, column = held[0]
        raise InputError(
            "chart",
            f"row {row + 1}, stitch {column + 1} is held for ever: every row above slips or tucks "
            "it.",
            "Knit or purl it in one of the rows.",
        )


def _stitches_of(sites: Sequence[Site], row: int) -> list[int]:
    """Cells of a row: the narrowest stitches that take neighbouring loops."""
    cells: list[int] = []
    taken = 0
    while (start := len(cells)) < len(sites):
        sources: list[int] = []
        for end in range(start, len(sites)):
            sources += sites[end].sources
            if sorted(sources) == list(range(taken, taken + len(sources))):
                break
        own = tuple(
            replace(site, sources=tuple(source - taken for source in site.sources))
            for site in sites[start : end + 1]
        )
        place = place_of(own)
        if place is None:
            raise InputError(
                "chart",
                f"row {row}, stitch {start + 1} takes stitches {_in_words(sites[start].sources)} "
                "of the row below in an order that no stitch of the list has.",
                "Use stitches of the list, with at most 6 on each side of a cable.",
            )
        cells += [place] + [CONTINUED] * (len(own) - 1)
        taken += len(sources)
    return cells


def _in_words(columns: Sequence[int]) -> str:
    return " and ".join(str(column + 1) for column in columns) or "none"


def _read_row(text: str, row: int) -> list[int]:
    cells: list[int] = []
    for code in CODE.findall(text):
        place = BY_CODE.get(_ALIASES.get(code, code))
        if place is None:
            raise InputError(
                "chart",
                f"row {row}, stitch {len(cells) + 1} is {code!r}, which is no stitch.",
                f"Write {KNIT.code} and {PURL.code}, or another code of the list of stitches.",
            )
        cells += [place] + [CONTINUED] * (STITCHES[place].width - 1)
    return cells
