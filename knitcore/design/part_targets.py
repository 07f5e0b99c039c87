"""Targets for parts of a chart: as maps of moduli, and beside what the parts do now."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart, check_chart_size
from knitcore.design.atlas import Atlas
from knitcore.design.explain import OFF, Nearest, nearest_repeat
from knitcore.garment.shaped import largest_rectangle
from knitcore.materials import Material
from knitcore.prediction.predict import predict
from knitcore.prediction.size import RelaxedSize

_WORTH = 0.9
"""A part is repainted if at most this share of its distance from the target remains."""


@dataclass(frozen=True)
class PartTarget:
    """Target stiffness of one part of a chart.

    Attributes
    ----------
    name : for messages.
    runs : (row, first column, length) of its stitches, row 0 at the bottom; of any shape.
    course_n_per_mm, wale_n_per_mm : target moduli; None where any value will do.
    size : relaxed size of its mean stitch in the chart as it is, if known.
    """

    name: str
    runs: tuple[tuple[int, int, int], ...]
    course_n_per_mm: float | None
    wale_n_per_mm: float | None
    size: RelaxedSize | None = None


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


def target_parts(targets: Sequence[PartTarget], rows: int, columns: int) -> Indices:
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


@dataclass(frozen=True)
class FilledPart:
    """Moduli of a part in a filled chart, beside those that it had.

    Attributes
    ----------
    name : of the target.
    stitches : number of its stitches.
    repainted : False for a part that stays as it was: no repeat that was tried came nearer.
    nearest : to the target, of all repeats; tried are only those that may suit the part.
    course_before_n_per_mm, wale_before_n_per_mm : moduli of the part in the chart as it was,
        predicted for the largest rectangle inside; NaN without such a chart.
    course_n_per_mm, wale_n_per_mm : the same in the filled chart.
    """

    name: str
    stitches: int
    repainted: bool
    nearest: Nearest
    course_before_n_per_mm: float
    wale_before_n_per_mm: float
    course_n_per_mm: float
    wale_n_per_mm: float


@dataclass(frozen=True, eq=False)
class PartsNow:
    """Parts of a chart with their targets, and what they do before they are filled.

    A part may only be given stitches that are nearer to its target: over both directions, and in
    neither of them farther, unless within :data:`~knitcore.design.explain.OFF`. So a part that
    should be softer never becomes stiffer.

    Parameters
    ----------
    targets : of the parts.
    stitch : bool (rows, columns), where there are stitches.
    kept : the chart as it is; None if nothing of it is to be kept.
    material : of the chart.
    """

    targets: Sequence[PartTarget]
    stitch: Mask
    kept: StitchChart | None
    material: Material

    @cached_property
    def cells(self) -> tuple[Mask, ...]:
        """Stitches (rows, columns) of each part, inside the piece."""
        return tuple(_cells(t, *self.stitch.shape) & self.stitch for t in self.targets)

    def check_inside(self) -> None:
        """Refuse a part without a stitch.

        Raises
        ------
        InputError
            If all of a part lies outside the piece.
        """
        for target, cells in zip(self.targets, self.cells, strict=True):
            if not cells.any():
                raise InputError(
                    "targets",
                    f"“{target.name}” lies outside the outline.",
                    "Draw it inside, or leave it out.",
                )

    def of(self, row: int, column: int) -> list[int]:
        """The parts that a stitch belongs to."""
        return [part for part, cells in enumerate(self.cells) if cells[row, column]]

    @cached_property
    def log_target(self) -> Array:
        """(parts, 2) logarithms of the target moduli; NaN where any value will do."""
        moduli = [(t.course_n_per_mm, t.wale_n_per_mm) for t in self.targets]
        logarithms: Array = np.log(np.array(moduli, dtype=float))
        return logarithms

    @cached_property
    def log_now(self) -> Array:
        """(parts, 2) logarithms of the moduli of the chart as it is; NaN without it."""
        if self.kept is None:
            return np.full(self.log_target.shape, np.nan)
        return self.log_moduli(self.kept, [target.size for target in self.targets])

    def log_moduli(
        self, chart: StitchChart, sizes: Sequence[RelaxedSize | None] | None = None
    ) -> Array:
        """(parts, 2) logarithms of the moduli of a chart's parts, by their largest rectangles.

        Parameters
        ----------
        sizes : of the parts' mean stitches, where known; a filled part has none.
        """
        moduli = np.full((len(self.cells), 2), np.nan)
        for part, cells in enumerate(self.cells):
            if cells.any():
                inside = StitchChart(chart.purl[largest_rectangle(cells)])
                predicted = predict(inside, self.material, sizes[part] if sizes else None)
                moduli[part] = [predicted.modulus_n_per_mm(direction) for direction in Direction]
        logarithms: Array = np.log(moduli)
        return logarithms

    def nearer(self, part: int, log_moduli: Array) -> Mask:
        """Tell which moduli (..., 2), as logarithms, are nearer to the target than those now."""
        target = self.log_target[part]
        before = np.nan_to_num(np.abs(self.log_now[part] - target), nan=0.0)
        after = np.nan_to_num(np.abs(log_moduli - target), nan=0.0)
        if self.kept is None:
            return np.ones(after.shape[:-1], dtype=bool)
        limit = np.maximum(before, np.log1p(OFF))
        nearer: Mask = (after <= limit).all(axis=-1) & (
            np.hypot(*np.moveaxis(after, -1, 0)) < _WORTH * np.hypot(*before)
        )
        return nearer

    def filled(self, log_moduli: Array, repainted: Mask, atlas: Atlas) -> tuple[FilledPart, ...]:
        """Compare each part of a filled chart with what it was.

        Parameters
        ----------
        log_moduli : (parts, 2) logarithms of its moduli (:meth:`log_moduli`).
        repainted : (parts,) which of them are filled.
        atlas : repeats to fill them with.
        """
        before, after = np.exp(self.log_now).tolist(), np.exp(log_moduli).tolist()
        nearest = [nearest_repeat(target, atlas) for target in self.log_target]
        return tuple(
            FilledPart(target.name, int(cells.sum()), bool(is_new), near, *then, *now)
            for target, cells, is_new, then, now, near in zip(
                self.targets, self.cells, repainted, before, after, nearest, strict=True
            )
        )


def _cells(target: PartTarget, rows: int, columns: int) -> Mask:
    cells = np.zeros((rows, columns), dtype=bool)
    for row, first, length in target.runs:
        if not (0 <= row < rows and first >= 0 and length >= 1 and first + length <= columns):
            raise InputError(
                "targets",
                f"“{target.name}” reaches row {row + 1}, columns {first + 1} to {first + length}: "
                f"the chart has {columns} columns and {rows} rows.",
                "Draw it inside the chart.",
            )
        cells[row, first : first + length] = True
    if not cells.any():
        raise InputError(
            "targets", f"“{target.name}” covers no stitch.", "Draw it, or leave it out."
        )
    values = (target.course_n_per_mm, target.wale_n_per_mm)
    if any(v is not None and not (math.isfinite(v) and v > 0) for v in values):
        problem = f"“{target.name}” has a target stiffness that is not positive."
        raise InputError("targets", problem, "Give N/mm above 0.")
    return cells


def _refuse(target: PartTarget, other: PartTarget, cells: Mask, axis: int) -> None:
    row, column = np.argwhere(cells)[0] + 1
    values = [(w.course_n_per_mm, w.wale_n_per_mm)[axis] for w in (other, target)]
    raise InputError(
        "targets",
        f"“{other.name}” and “{target.name}” contradict each other in {int(cells.sum())} stitches "
        f"(the first in row {row}, column {column}): {values[0]:g} and {values[1]:g} N/mm "
        f"{('course', 'wale')[axis]}-wise.",
        "Take these stitches out of one of them, or give both the same value.",
    )
