"""Stitches of a design that are neither knit nor purl, beside its chart of knits and purls.

A design keeps both: its ``chart`` is the purl map, and runs of other stitches lie on top. So what
takes knits and purls alone still works. A design whose rows do not balance is kept like any other;
composing its chart says what is wrong.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.chart.stitch_kinds import BY_CODE, STITCHES, StitchType
from knitcore.chart.symbol_chart import CODE, CONTINUED, SymbolChart

MAX_STITCH_RUNS = 200_000
_PLAIN = BY_CODE["P"]
Index = Annotated[
    int,
    Field(ge=0, lt=MAX_STITCHES_PER_SIDE, description="From 0, the bottom row or the left column."),
]


def _known(codes: str) -> str:
    for code in CODE.findall(codes):
        if BY_CODE.get(code, 0) <= _PLAIN:
            raise ValueError(f"{code} is no stitch other than knit and purl; use the list's codes")
    return codes


class StitchRun(BaseModel):
    """Neighbouring stitches of a row that are neither knit nor purl."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    row: Index
    column: Index
    codes: Annotated[
        str,
        Field(
            pattern=r"^(\[[^\]\s]{1,10}\]|[^\s,;\[\]])+$",
            max_length=10 * MAX_STITCHES_PER_SIDE,
            description="Their codes from the left of the face, such as O/ or [2/2R].",
            examples=["O/"],
        ),
        AfterValidator(_known),
    ]

    @property
    def stitches(self) -> list[StitchType]:
        """The stitches from the left."""
        return [STITCHES[BY_CODE[code]] for code in CODE.findall(self.codes)]


def composed(chart: StitchChart, runs: Sequence[StitchRun]) -> StitchChart | SymbolChart:
    """Lay other stitches on a chart of knits and purls.

    Raises
    ------
    InputError
        If a run leaves the chart or lies on another, or as :class:`SymbolChart`: a row does not
        balance, or a stitch is never knitted.

    Examples
    --------
    >>> plain = StitchChart.parse("KKKP/KKKP")
    >>> print(composed(plain, [StitchRun(row=1, column=0, codes="O/")]))
    O/KP
    KKKP
    """
    if not runs:
        return chart
    cells = SymbolChart.of(chart).cells.copy()
    for row, column, stitch in placed(runs, chart.rows, chart.columns):
        cells[row, column : column + stitch.width] = CONTINUED
        cells[row, column] = BY_CODE[stitch.code]
    return SymbolChart(cells)


def taken_apart(chart: SymbolChart) -> tuple[StitchChart, list[StitchRun]]:
    """The purl map of a chart and its other stitches; the inverse of :func:`composed`."""
    runs = []
    for row, line in enumerate(chart.cells):
        codes, start, end = "", 0, 0
        for column in np.flatnonzero(line > _PLAIN).tolist():
            if codes and column > end:
                runs.append(StitchRun(row=row, column=start, codes=codes))
                codes = ""
            start = start if codes else column
            codes += STITCHES[line[column]].code
            end = column + STITCHES[line[column]].width
        if codes:
            runs.append(StitchRun(row=row, column=start, codes=codes))
    return chart.plain, runs


def placed(
    runs: Iterable[StitchRun], rows: int, columns: int
) -> Iterator[tuple[int, int, StitchType]]:
    """Rows, left columns and stitches of runs.

    Raises
    ------
    InputError
        If a run leaves the chart or lies on another.
    """
    taken: dict[int, set[int]] = {}
    for run in runs:
        column = run.column
        for stitch in run.stitches:
            under = set(range(column, column + stitch.width))
            if run.row >= rows or column + stitch.width > columns:
                raise InputError(
                    "other_stitches",
                    f"{stitch.name} in row {run.row + 1}, stitch {column + 1} leaves the chart of "
                    f"{columns}x{rows} stitches.",
                    "Move it into the chart.",
                )
            row = taken.setdefault(run.row, set())
            if row & under:
                raise InputError(
                    "other_stitches",
                    f"{stitch.name} in row {run.row + 1}, stitch {column + 1} lies on another one.",
                    "Give every place one stitch.",
                )
            row |= under
            yield run.row, column, stitch
            column += stitch.width


def painted_over(runs: Sequence[StitchRun], painted: set[tuple[int, int]]) -> list[StitchRun]:
    """Take away what knits and purls are painted over; a wide stitch that is hit goes whole.

    Parameters
    ----------
    painted : rows and columns.
    """
    left = []
    for run in runs:
        codes, start, column = "", run.column, run.column
        for stitch in run.stitches:
            hit = any((run.row, column + k) in painted for k in range(stitch.width))
            if hit and codes:
                left.append(StitchRun(row=run.row, column=start, codes=codes))
            codes = "" if hit else codes + stitch.code
            column += stitch.width
            start = column if hit else start
        if codes:
            left.append(StitchRun(row=run.row, column=start, codes=codes))
    return left
