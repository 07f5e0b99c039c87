"""Peirce's bending length: a strip of cloth that hangs over the edge of a table.

Peirce, "The handle of cloth as a measurable quantity", J. Text. Inst. 21 (1930) T377: where the
line from the edge to the tip falls by θ, the bending length is L (cos(θ/2) / (8 tan θ))^(1/3), half
the overhang at θ = 41.5°.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, InputError
from knitcore.cloth.space.even_cloth import EvenCloth
from knitcore.cloth.space.sheet_shape import settle

WIDTH_MM = 25.0
MIN_BENDING_LENGTHS, MAX_BENDING_LENGTHS = 0.1, 5.0
"""Shortest and longest overhang, in bending lengths: a shorter strip hardly falls, a longer one
hangs straight down."""
_RECTANGLES = 40
"""Number of rectangles along the overhang."""
_CLAMPED = 2
_ACROSS = 2


@dataclass(frozen=True, eq=False)
class Overhang:
    """A strip at rest; x along it from the edge of the table, z up.

    Parameters
    ----------
    overhang_mm : length beyond the edge.
    angle_rad : of the line from the edge to the tip, below the horizontal.
    reach_mm, fall_mm : how far out and how far down the tip is.
    bending_length_mm : by Peirce's formula from overhang and angle.
    rigidity_n_mm : weight per area times the cube of the bending length.
    corners_mm : (lines along, lines across, 3) of the rectangles.
    rectangle_mm : their size, along and across.
    converged : whether the strip is in equilibrium.
    """

    overhang_mm: float
    angle_rad: float
    reach_mm: float
    fall_mm: float
    bending_length_mm: float
    rigidity_n_mm: float
    corners_mm: Array
    rectangle_mm: tuple[float, float]
    converged: bool


def overhang(
    cloth: EvenCloth,
    axis: int,
    overhang_mm: float | None = None,
    *,
    cancelled: Cancelled | None = None,
) -> Overhang:
    """A strip 25 mm wide, clamped flat on a table up to its edge.

    Parameters
    ----------
    cloth : taken as flat at rest: the test is not meant for strips that roll up.
    axis : 0 for a strip along the rows, 1 for one along the columns.
    overhang_mm : by default the length at which the strip falls by 41.5°.

    Raises
    ------
    InputError
        If the overhang is shorter than a tenth of the bending length or longer than five.
    CancelledError
        If ``cancelled`` returned True.
    """
    expected = cloth.bending_length_mm(axis)
    length = 2.0 * expected if overhang_mm is None else overhang_mm
    shortest, longest = MIN_BENDING_LENGTHS * expected, MAX_BENDING_LENGTHS * expected
    if not shortest <= length <= longest:
        falls = "do not bend" if length < shortest else "hang straight down"
        raise InputError(
            "overhang_mm",
            f"{length:g} mm {falls}: the bending length is {expected:.0f} mm.",
            f"Give {shortest:.1f} to {longest:.0f} mm.",
        )
    strip = cloth.turned() if axis else cloth
    size = length / _RECTANGLES, WIDTH_MM / _ACROSS
    columns = _RECTANGLES + _CLAMPED
    sheet = strip.flat().sheet(_ACROSS, columns, size)
    held = np.tile(np.arange(columns + 1) <= _CLAMPED, _ACROSS + 1)
    weight = np.full(len(sheet.quads), cloth.weight_n_per_mm2 * size[0] * size[1])
    load = np.zeros_like(sheet.flat_mm)
    load[:, 2] = -sheet.shared(weight)
    shape = settle(sheet.clamped(held), sheet.flat_mm, held=held, load_n=load, cancelled=cancelled)
    corners = shape.x.reshape(_ACROSS + 1, columns + 1, 3)
    corners = corners - corners[_ACROSS // 2, _CLAMPED]
    reach, _, height = corners[:, -1].mean(axis=0)
    angle = math.atan2(-height, reach)
    peirce = length * math.cbrt(math.cos(0.5 * angle) / (8.0 * math.tan(angle)))
    return Overhang(
        overhang_mm=length,
        angle_rad=angle,
        reach_mm=float(reach),
        fall_mm=float(-height),
        bending_length_mm=peirce,
        rigidity_n_mm=cloth.weight_n_per_mm2 * peirce**3,
        corners_mm=corners.transpose(1, 0, 2),
        rectangle_mm=size,
        converged=shape.converged,
    )
