"""Targets for parts of a chart, as maps of moduli."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import check_chart_size

Parts = Indices


@dataclass(frozen=True)
class PartTarget:
    """Target stiffness of one part of a chart.

    Attributes
    ----------
    name : for messages.
    runs : (row, first column, length) of its stitches, row 0 at the bottom; of any shape.
    course_n_per_mm, wale_n_per_mm : target moduli; None where any value will do.
    """

    name: str
    runs: tuple[tuple[int, int, int], ...]
    course_n_per_mm: float | None
    wale_n_per_mm: float | None


def target_maps(targets: Sequence[PartTarget], rows: int, columns: int) -> tuple[Array, Array]:
    """Maps (rows, columns) of the target moduli, NaN where there is none.

    Raises
    ------
    InputError
        If a part lies outside the chart, or contradicts another.
    """
    check_chart_size(rows, columns)
    maps = np.full((2, rows, columns), np.nan)
    owner = np.full((2, rows, columns), -1)
    for number, target in enumerate(targets):
        cells = _cells(target, rows, columns)
        for axis, value in enumerate((target.course_n_per_mm, target.wale_n_per_mm)):
            if value is None:
                continue
            other = cells & (owner[axis] >= 0) & ~np.isclose(maps[axis], value, rtol=1e-9)
            if other.any():
                _refuse(target, targets[int(owner[axis][other][0])], other, axis)
            maps[axis][cells] = value
            owner[axis][cells] = number
    return maps[0], maps[1]


def target_parts(targets: Sequence[PartTarget], rows: int, columns: int) -> Parts:
    """(rows, columns) numbers from 0, equal where the same targets apply.

    Raises
    ------
    InputError
        If a part lies outside the chart.
    """
    check_chart_size(rows, columns)
    parts = np.zeros((rows, columns), dtype=np.intp)
    for target in targets:
        numbers = np.unique(2 * parts + _cells(target, rows, columns), return_inverse=True)[1]
        parts = numbers.reshape(rows, columns)
    return parts


def _cells(target: PartTarget, rows: int, columns: int) -> Mask:
    cells = np.zeros((rows, columns), dtype=bool)
    for row, first, length in target.runs:
        if not (0 <= row < rows and first >= 0 and length >= 1 and first + length <= columns):
            raise InputError(
                "wishes",
                f"“{target.name}” reaches row {row + 1}, columns {first + 1} to {first + length}: "
                f"the chart has {columns} columns and {rows} rows.",
                "Draw it inside the chart.",
            )
        cells[row, first : first + length] = True
    if not cells.any():
        raise InputError(
            "wishes", f"“{target.name}” covers no stitch.", "Draw it, or leave it out."
        )
    values = (target.course_n_per_mm, target.wale_n_per_mm)
    if any(v is not None and not (math.isfinite(v) and v > 0) for v in values):
        problem = f"“{target.name}” has a target stiffness that is not positive."
        raise InputError("wishes", problem, "Give N/mm above 0.")
    return cells


def _refuse(target: PartTarget, other: PartTarget, cells: Mask, axis: int) -> None:
    row, column = np.argwhere(cells)[0] + 1
    values = [(w.course_n_per_mm, w.wale_n_per_mm)[axis] for w in (other, target)]
    raise InputError(
        "wishes",
        f"“{other.name}” and “{target.name}” contradict each other in {int(cells.sum())} stitches "
        f"(the first in row {row}, column {column}): {values[0]:g} and {values[1]:g} N/mm "
        f"{('course', 'wale')[axis]}-wise.",
        "Take these stitches out of one of them, or give both the same value.",
    )
