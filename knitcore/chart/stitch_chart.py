"""The chart: a grid of knit and purl stitches seen from the face (right) side."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from numbers import Integral

import numpy as np
from numpy.typing import NDArray

from knitcore.base import showing
from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_mask, check_kind
from knitcore.chart.fabric import Fabric

MAX_STITCHES_PER_SIDE = 1000
"""Largest number of rows or columns of a chart."""

KNIT_SYMBOLS = frozenset("Kk|")
PURL_SYMBOLS = frozenset("Pp•–-")
_CANONICAL = str.maketrans(
    dict.fromkeys(KNIT_SYMBOLS, "K")
    | dict.fromkeys(PURL_SYMBOLS, "P")
    | dict.fromkeys(" \t,", None)
)
_APART = re.compile(r"\S(?:[ \t,]+\S)*")
_SPACE = re.compile(r"[ \t]")
_EMPTY_CELL = re.compile(r"^,|,\s*,|\t\s*\t")


@dataclass(frozen=True, eq=False)
class StitchChart:
    """A rectangular chart of knits and purls, immutable.

    Parameters
    ----------
    purl : bool array (rows, columns)
        True where the stitch is a purl on the face side. Row 0 is the bottom row (row 1 of a
        knitter's chart), column 0 the leftmost wale of the face. x runs along a row (course), y
        up a column (wale).

    Raises
    ------
    InputError
        If the grid is empty, not two-dimensional or over-large.

    Examples
    --------
    >>> chart = StitchChart.parse("KP\\nPK")
    >>> chart.rows, chart.columns
    (2, 2)
    >>> print(chart)
    KP
    PK
    >>> chart == chart.turn_over().turn_over()
    True
    """

    purl: Mask

    def __post_init__(self) -> None:
        grid = as_mask("chart", self.purl, "Give rows of True (purl) and False (knit).")
        if 0 in grid.shape:
            raise InputError("chart", "the chart has no stitches.", "Give at least one row of K/P.")
        check_chart_size(*grid.shape)
        grid.setflags(write=False)
        object.__setattr__(self, "purl", grid)

    @classmethod
    def parse(cls, text: str) -> StitchChart:
        """Read K/P lines, the top row first, as on paper.

        K, k or ``|`` is a knit; P, p, ``•``, ``–`` or ``-`` is a purl. Blanks and commas between
        stitches, blank lines around the chart and lines that begin with ``#`` are passed over. A
        ``/`` also ends a line, as in :attr:`key`.
        :func:`knitcore.formats.read.text_chart.read_text_chart` reads other signs, and blanks.

        Raises
        ------
        InputError
            Unknown symbols, ragged rows, and blanks that may be knits are named with their line
            and column.
        """
        check_kind("chart", text, str, "Give rows of K and P such as 'KP/PK'.")
        rows: list[str] = []
        drawn: list[tuple[int, str]] = []
        first_line = 0
        lines = (
            (number, part)
            for number, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1)
            if not line.lstrip().startswith("#")
            for part in ([line] if "/" not in line else map(str.strip, line.split("/")))
        )
        for number, line in lines:
            row = line.strip().translate(_CANONICAL)
            drawn.append((number, line.rstrip()))
            if not row:
                continue
            if row.count("K") + row.count("P") < len(row):
                column, symbol = next((i, s) for i, s in enumerate(row, start=1) if s not in "KP")
                problem = f"line {number}, stitch {column} is {symbol!r}, which is neither K nor P."
                raise InputError("chart", problem, "Write every stitch as K or P.")
            if not rows:
                first_line = number
            elif len(row) != len(rows[0]):
                raise InputError(
                    "chart",
                    f"line {number} has {len(row)} stitches, line {first_line} has {len(rows[0])}.",
                    "Give every row the same number of stitches.",
                )
            rows.append(row)
            check_chart_size(len(rows), len(row))
        if not rows:
            raise InputError("chart", "the chart has no stitches.", "Give at least one row of K/P.")
        _check_blanks(drawn, purls_only=all(set(row) == {"P"} for row in rows))
        symbols = np.frombuffer("".join(rows).encode("ascii"), dtype=np.uint8)
        return cls(symbols.reshape(len(rows), -1)[::-1] == ord("P"))

    @classmethod
    def of_fabric(cls, fabric: Fabric | str, rows: int = 2, columns: int = 2) -> StitchChart:
        """A pure fabric of the given size.

        Rows 1, 3, 5 … and columns 1, 3, 5 … begin with a knit at the bottom left.
        """
        kind = Fabric.parse(fabric)
        check_chart_size(rows, columns)
        row = np.arange(rows)[:, None] * kind.wale_odd
        column = np.arange(columns)[None, :] * kind.course_odd
        return cls((row + column) % 2 == 1)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rows and of columns."""
        return self.rows, self.columns

    def __len__(self) -> int:
        """Number of rows, as of an array."""
        return self.rows

    @property
    def rows(self) -> int:
        """Number of courses."""
        return int(self.purl.shape[0])

    @property
    def columns(self) -> int:
        """Number of wales."""
        return int(self.purl.shape[1])

    @property
    def stitches(self) -> int:
        """Number of stitches."""
        return self.purl.size

    @property
    def text(self) -> str:
        """The chart as K/P lines, top row first; :meth:`parse` reads it back."""
        symbols = np.full((self.rows, self.columns + 1), ord("\n"), dtype=np.uint8)
        symbols[:, :-1] = np.frombuffer(b"KP", dtype=np.uint8).take(self.purl[::-1])
        return symbols.tobytes()[:-1].decode("ascii")

    @property
    def key(self) -> str:
        """The chart in one line, rows from the top separated by ``/``: a short name for it.

        Examples
        --------
        >>> StitchChart.parse("KP/PK").key
        'KP/PK'
        """
        return self.text.replace("\n", "/")

    def tile(self, down: int, across: int) -> StitchChart:
        """The chart repeated ``down`` times along the wales and ``across`` times along courses."""
        if down < 1 or across < 1:
            raise InputError("tile", "the counts must be positive.", "Use whole numbers from 1.")
        check_chart_size(self.rows * down, self.columns * across)
        return StitchChart(np.tile(self.purl, (down, across)))

    def resized(self, rows: int, columns: int) -> StitchChart:
        """The chart continued periodically, from its bottom left, to the given size."""
        check_chart_size(rows, columns)
        return StitchChart(
            self.purl[np.ix_(np.arange(rows) % self.rows, np.arange(columns) % self.columns)]
        )

    def mirror(self) -> StitchChart:
        """The chart reflected left to right (knits stay knits)."""
        return StitchChart(self.purl[:, ::-1])

    def swap(self) -> StitchChart:
        """Every knit becomes a purl and every purl a knit, in place."""
        return StitchChart(~self.purl)

    def turn_over(self) -> StitchChart:
        """The back of the same cloth: columns mirrored and K/P swapped."""
        return StitchChart(~self.purl[:, ::-1])

    def region(self, rows: slice, columns: slice) -> StitchChart:
        """A rectangular part, as a chart of its own."""
        return StitchChart(self.purl[rows, columns])

    def repeat(self) -> StitchChart:
        """The smallest chart that tiles this one exactly.

        Examples
        --------
        >>> StitchChart.of_fabric("rib", rows=6, columns=8).repeat().text
        'KP'
        """
        return StitchChart(self.purl[: period(self.purl), : period(self.purl.T)])

    def canonical(self) -> StitchChart:
        """One repeat for all charts of the same fabric: shifted, mirrored, or seen from the back.

        Upside down is another fabric: loops point upwards. Of all these repeats it is the first in
        the order of their rows from the bottom, knits before purls.

        Examples
        --------
        >>> StitchChart.parse("PPKK").canonical().text
        'KKPP'
        """
        purl = self.repeat().purl
        images = (
            np.roll(image, (up, right), axis=(0, 1))
            for image in (purl, purl[:, ::-1], ~purl, ~purl[:, ::-1])
            for up in range(purl.shape[0])
            for right in range(purl.shape[1])
        )
        return StitchChart(min(images, key=lambda image: image.tobytes()))

    def repeat_cut(self) -> StitchChart:
        """The smallest repeat whose periodic continuation, cut anywhere, gives this chart.

        Unlike :meth:`repeat` the last copy may be cut off, as in a swatch of 31 x 31 rib. A
        repeat is seen only if it occurs twice; otherwise that direction keeps its full length.
        """
        return StitchChart(
            self.purl[: period(self.purl, cut=True), : period(self.purl.T, cut=True)]
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, StitchChart) and np.array_equal(self.purl, other.purl)

    def __hash__(self) -> int:
        return hash((self.purl.shape, self.purl.tobytes()))

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"StitchChart({self.rows} rows, {self.columns} columns)"

    def _repr_html_(self) -> str:
        most = showing.MAX_CELLS
        size = f"{self.columns} columns × {self.rows} rows, the face side"
        cut = f"; the lower left {most} × {most}" if max(self.purl.shape) > most else ""
        return showing.captioned(showing.stitches(self.purl), size + cut)


def _check_blanks(lines: list[tuple[int, str]], *, purls_only: bool) -> None:
    """Refuse a blank that may be a knit, as it is in printed charts, rather than a space."""
    if not purls_only and not any(gap in line.strip() for _, line in lines for gap in " \t,"):
        return
    blank = next(_doubtful_blanks(lines, purls_only=purls_only), None)
    if blank is not None:
        problem = f"line {blank[0]}, column {blank[1]} is blank: a knit, or only space."
        remedy = "Write every stitch as K or P; the import of a file reads blank squares as knits."
        raise InputError("chart", problem, remedy)


def _doubtful_blanks(
    lines: list[tuple[int, str]], *, purls_only: bool
) -> Iterator[tuple[int, int]]:
    """Line and column of blanks that may be knits.

    Blanks are only space if they stand between all stitches of a line, or in the same columns of
    all other lines. Where purls are signs and no knit is written, they are not.
    """
    texts = [(number, line.strip()) for number, line in lines if line.strip()]
    for number, text in texts:
        if (cell := _EMPTY_CELL.search(text)) is not None:
            yield number, cell.end()
    if purls_only:
        indents = [(len(line) - len(line.lstrip()), n) for n, line in lines if line.strip()]
        if min(indents)[0] < max(indents)[0]:
            yield max(indents)[1], 1
    signs = purls_only and not all(set(text) <= set("Pp ,\t") for _, text in texts)
    if signs:
        drawn = {number for number, _ in texts}
        yield from ((n, 1) for n, _ in lines if min(drawn) < n < max(drawn) and n not in drawn)
    mixed = texts if signs else [text for text in texts if not _APART.fullmatch(text[1])]
    spaces = [(number, {m.start() for m in _SPACE.finditer(text)}) for number, text in mixed]
    common = set.intersection(*(gaps for _, gaps in spaces)) if spaces and not signs else set()
    for number, gaps in spaces:
        yield from ((number, at + 1) for at in sorted(gaps - common)[:1])


def check_stitches(stitches: int, most: int, what: str = "it", instead: str = "") -> None:
    """Refuse more stitches than a computation takes.

    Parameters
    ----------
    what : has the stitches, such as "its repeat".
    instead : another way, which ends the remedy.

    Raises
    ------
    InputError
    """
    if stitches > most:
        remedy = f"Use at most {most}{instead}."
        raise InputError("chart", f"{what} has {stitches} stitches.", remedy, most=most)


def check_chart_size(rows: int, columns: int) -> None:
    """Refuse a chart that is empty or over-large.

    Raises
    ------
    InputError
        Naming the size that would be accepted.
    """
    for lines in (rows, columns):
        check_kind("chart", lines, Integral, "Give whole numbers of rows and columns.")
    if rows < 1 or columns < 1:
        raise InputError(
            "chart", f"{columns}x{rows} has no stitches.", "Give at least 1 column and 1 row."
        )
    if max(rows, columns) > MAX_STITCHES_PER_SIDE:
        remedy = f"Use at most {MAX_STITCHES_PER_SIDE} rows and {MAX_STITCHES_PER_SIDE} columns."
        raise InputError("chart", f"{size_in_words(columns, rows)} is too large.", remedy)


def size_in_words(columns: int, rows: int) -> str:
    """Write a size in words, such as ``1 column x 12 rows``."""
    counts = (columns, "column"), (rows, "row")
    return " x ".join(f"{count} {name}{'' if count == 1 else 's'}" for count, name in counts)


def period(grid: Mask | NDArray[np.int16], *, cut: bool = False) -> int:
    """Smallest period along axis 0 (one that occurs twice, if it may be cut; else a divisor)."""
    n = int(grid.shape[0])
    periods = (p for p in range(1, n // 2 + 1) if cut or n % p == 0)
    return next((p for p in periods if np.array_equal(grid[p:], grid[: n - p])), n)


def as_chart(chart: StitchChart | str) -> StitchChart:
    """Take a chart as it is, or read its text: K and P, or the name of a pure fabric.

    Raises
    ------
    InputError
        If it is neither, or its text is no chart.

    Examples
    --------
    >>> as_chart("KP/PK").rows, as_chart("seed").rows
    (2, 2)
    """
    if isinstance(chart, StitchChart):
        return chart
    remedy = "Give a StitchChart, rows of K and P such as 'KP/PK', or a fabric such as 'garter'."
    check_kind("chart", chart, str, remedy)
    if is_name_of_fabric(chart):
        return StitchChart.of_fabric(chart.strip().lower())
    return StitchChart.parse(chart)


def is_name_of_fabric(text: str) -> bool:
    """Say whether a text is the name of a pure fabric."""
    return text.strip().lower() in tuple(Fabric)
