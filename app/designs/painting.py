"""Strokes on a chart text."""

from __future__ import annotations

from collections.abc import Iterable

from app.designs.document import Run
from knitcore.errors import InputError


def paint(chart: str, rows: int, columns: int, runs: Iterable[Run]) -> str:
    """A canonical chart text with runs of stitches replaced, the later ones on top.

    Raises
    ------
    InputError
        If a run leaves the chart.
    """
    text = bytearray(chart, "ascii")
    for number, run in enumerate(runs):
        if run.row >= rows or run.column + len(run.stitches) > columns:
            raise InputError(
                f"runs.{number}",
                f"leaves the chart of {columns}x{rows} stitches.",
                "Paint within the chart.",
            )
        start = (rows - 1 - run.row) * (columns + 1) + run.column
        text[start : start + len(run.stitches)] = run.stitches.encode("ascii")
    return text.decode("ascii")
