"""Borders that keep a curling piece flat on a table.

Held flat, a piece turns the line beside its border with its moment m₀ per width. To tip a border
of width b and weight w per area about that line takes w b²/2, so one narrower than √(2 m₀/w) is
tipped over. A wider one does not always hold: cloth that bends easily rises beside the line in a
ridge instead. Turning it by θ costs a heavy beam of rigidity D only (w D²)^(1/3) θ^(5/3) and gains
m₀ θ, so where D is small the ridge becomes a scroll. A strip of piece and borders on a smooth table
shows which of the two happens.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled
from knitcore.cloth.space.even_cloth import EvenCloth
from knitcore.cloth.space.sheet_shape import Shape, settle
from knitcore.cloth.space.stitch_sheet import StitchSheet

RULE_STITCHES, RULE_ROWS = (3, 5), 4
"""Knitters' rule for the width of a border at the sides, and at top and bottom."""
SAFETY = 1.2
"""Width of the border tested on the table, over the width that just does not tip."""
INNER_MM = 100.0
"""Width of the piece between the tested borders."""
MAX_WIDTH_MM = 500.0
_RECTANGLE_MM = 2.5


@dataclass(frozen=True, eq=False)
class BorderAdvice:
    """A border along one pair of edges.

    Parameters
    ----------
    moment_n : per width, with which the piece curls there; 0 if it does not.
    width_mm : of the border that its weight just keeps from being tipped over; 0 for none.
    stitches : the same in stitches, or rows, of the border.
    rule_share : share of the moment that the weight of a border by the knitters' rule holds.
    holds : whether a border of 1.2 times this width keeps a smooth strip from rolling up.
    ridge_mm : how high this strip rises beside its borders.
    line_mm : (n, 2) the strip in cross-section, along the table and up.
    """

    moment_n: float
    width_mm: float
    stitches: int
    rule_share: float
    holds: bool
    ridge_mm: float
    line_mm: Array


def advice(
    inner: EvenCloth,
    border: EvenCloth,
    axis: int,
    *,
    time_limit_s: float = 20.0,
    cancelled: Cancelled | None = None,
) -> BorderAdvice:
    """How wide a border must be.

    Parameters
    ----------
    inner, border : the piece and its border.
    axis : 0 for the sides, 1 for top and bottom.
    time_limit_s : CPU time on the table; a strip not at rest by then does not hold.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    moment, weight = inner.moment_n[axis], border.weight_n_per_mm2
    size = border.stitch_mm[axis]
    width = math.sqrt(2.0 * moment / weight)
    ruled = size * (RULE_ROWS if axis else max(RULE_STITCHES))
    if moment == 0.0:
        return BorderAdvice(0.0, 0.0, 0, 1.0, True, 0.0, np.zeros((0, 2)))
    sheet, shape = on_table(
        inner, border, axis, min(SAFETY * width, MAX_WIDTH_MM), time_limit_s=time_limit_s,
        cancelled=cancelled,
    )  # fmt: skip
    line = shape.x.reshape(2, sheet.columns + 1, 3).mean(axis=0)[:, ::2]
    return BorderAdvice(
        moment_n=moment,
        width_mm=width,
        stitches=math.ceil(width / size),
        rule_share=min(0.5 * weight * ruled**2 / moment, 1.0),
        holds=bool(shape.converged and (np.diff(line[:, 0]) > 0.0).all()),
        ridge_mm=float(np.ptp(line[:, 1])),
        line_mm=line,
    )


def on_table(
    inner: EvenCloth,
    border: EvenCloth,
    axis: int,
    border_mm: float,
    *,
    time_limit_s: float = 20.0,
    cancelled: Cancelled | None = None,
) -> tuple[StitchSheet, Shape]:
    """A strip across the piece with a border at both ends, from the flat state to rest.

    It lies on a smooth table with the side up to which it curls.
    """
    piece, edge = (cloth.turned() if axis else cloth for cloth in (inner, border))
    piece = replace(piece, curvature_per_mm=(-abs(piece.curvature_per_mm[0]), 0.0))
    edge = replace(edge.flat(), thickness_mm=piece.thickness_mm)
    wide = round(border_mm / _RECTANGLE_MM)
    of_border = np.repeat([1.0, 0.0, 1.0], [wide, round(INNER_MM / _RECTANGLE_MM), wide])
    size = _RECTANGLE_MM, _RECTANGLE_MM
    own, other = (cloth.sheet(1, len(of_border), size) for cloth in (piece, edge))
    share = 0.5 * (of_border[1:] + of_border[:-1])[:, None]
    sheet = replace(
        own,
        turning=(1.0 - share) * own.turning + share * other.turning,
        membrane=np.where(of_border.repeat(4)[:, None] > 0.0, other.membrane, own.membrane),
    )
    weight = np.where(of_border > 0.0, edge.weight_n_per_mm2, piece.weight_n_per_mm2)
    load = np.zeros_like(sheet.flat_mm)
    load[:, 2] = -sheet.shared(weight * _RECTANGLE_MM**2)
    held = np.zeros((2, len(of_border) + 1, 3), dtype=bool)
    held[..., 1] = True  # a strip would roll up into a helix
    held[:, len(of_border) // 2, 0] = True
    return sheet, settle(
        sheet, sheet.flat_mm, held=held.reshape(-1, 3), load_n=load, floor_mm=0.0,
        time_limit_s=time_limit_s, cancelled=cancelled,
    )  # fmt: skip
