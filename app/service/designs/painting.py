"""Strokes on a chart text."""

from collections.abc import Iterable, Sequence

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.phases import surroundings
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.layout import DesignLayout
from knitcore.formats.designs.other_stitches import painted_over

from .document import Run, StitchKinds

OTHERS = "other_stitches"


def paint(chart: str, rows: int, columns: int, runs: Iterable[Run]) -> str:
    """A canonical chart text with runs of stitches replaced, the later ones on top.

    Raises
    ------
    InputError
        If a run reaches beyond the chart.
    """
    text = bytearray(chart, "ascii")
    for number, run in enumerate(runs):
        if run.row >= rows or run.column + len(run.stitches) > columns:
            raise InputError(
                f"runs.{number}",
                f"reaches beyond the chart of {columns}x{rows} stitches.",
                "Paint within the chart.",
            )
        start = (rows - 1 - run.row) * (columns + 1) + run.column
        text[start : start + len(run.stitches)] = run.stitches.encode("ascii")
    return text.decode("ascii")


def clear_painted(layout: str, runs: Iterable[Run]) -> str:
    """A stored layout without the other stitches that runs of knits and purls paint over."""
    if f'"{OTHERS}":[{{' not in layout:
        return layout
    parts = DesignLayout.model_validate_json(layout)
    painted = {(run.row, run.column + k) for run in runs for k in range(len(run.stitches))}
    left = painted_over(parts.other_stitches, painted)
    return parts.model_copy(update={OTHERS: left}).model_dump_json()


def kinds_around(chart: str, rows: int, columns: int, runs: Sequence[Run]) -> StitchKinds:
    """The kinds of the stitches in runs and of their neighbours, which the change may affect."""
    bottom = max(min(run.row for run in runs) - 1, 0)
    top = min(max(run.row for run in runs) + 2, rows)
    left = max(min(run.column for run in runs) - 1, 0)
    right = min(max(run.column + len(run.stitches) for run in runs) + 1, columns)
    # one stitch more on each side, because the kind of a stitch depends on its neighbours
    low, high = max(bottom - 1, 0), min(top + 1, rows)
    first, last = max(left - 1, 0), min(right + 1, columns)
    lines = np.frombuffer(f"{chart}\n".encode("ascii"), np.uint8).reshape(rows, columns + 1)
    box = StitchChart(lines[rows - high : rows - low, first:last][::-1] == ord("P"))
    codes = surroundings(box)[bottom - low : top - low, left - first : right - first]
    digits = np.frombuffer(b"0123456789abcdef", np.uint8)[codes]
    return StitchKinds(
        row=bottom, column=left, kinds=[line.tobytes().decode("ascii") for line in digits]
    )
