"""Linear constraints on a cell's unknowns, besides the lengths of its yarn.

- The foot of every stitch: where each stitch has its own length, its yarn is measured between the
  lowest points of the feet before and after it, so these points are kept at whole t.
- The plane: a fabric laid flat has the middle of every stitch, the mean height of its control
  points, in one plane. It also keeps the feet: yarn that slid by half a stitch would fold as if
  nothing held it, its heads and feet in place of the middles.
- The posture: a fabric laid flat does not crumple. How far a stitch tips (its head over its feet)
  and leans (its right side over its left one) depends on the stitches around it, so stitches in
  like surroundings do both alike, and those with a mirror axis do not lean. Without this rule rows
  of rib tip to the front and to the back in turn.

Rules that symmetry already keeps are left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.linear.dense import norm, times
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.spline import SUPPORT, SplineGrid, quintic_basis

_Y, _Z = 1, 2
_AROUND = 2
"""Stitches each way that count as the surroundings of one."""
FOOT = -2
"""The first of the control points around a foot, from that at the foot."""
_SMALL = 1e-9
_INDEPENDENT = 1e-6


def middle_weights(grid: SplineGrid) -> Array:
    """(controls + 1,) weights of the control points from foot to foot in the mean height of a
    stitch; those at the feet count half."""
    return _stitch_weights(grid, np.ones(grid.controls + 1))


def tip_weights(grid: SplineGrid) -> Array:
    """Weights of half the height of a stitch's upper half over its lower half."""
    t = np.arange(grid.controls + 1) / grid.controls
    return _stitch_weights(grid, np.sign(0.25 - np.abs(t - 0.5)))


def lean_weights(grid: SplineGrid) -> Array:
    """Weights of half the height of a stitch's right half over its left half."""
    t = np.arange(grid.controls + 1) / grid.controls
    return _stitch_weights(grid, np.sign(t - 0.5))


def _stitch_weights(grid: SplineGrid, values: Array) -> Array:
    weights = values / grid.controls
    weights[[0, -1]] *= 0.5
    return weights


def foot_weights(grid: SplineGrid) -> Array:
    """(6,) weights of the control points around a foot in the slope there, per unit of t."""
    return np.asarray(quintic_basis(np.array([0.0]), 1)[0] * grid.controls)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """The surroundings of the stitches of a cell, up to two stitches each way.

    Attributes
    ----------
    kind : (rows, wales) equal where the surroundings are, but for an exchange of knits and purls or
        of left and right.
    side : (rows, wales) 1 for knits, -1 for purls.
    hand : (rows, wales) 1 or -1 where the surroundings differ from their mirror image, one for
        each of the two; 0 where they do not.
    """

    kind: NDArray[np.int64]
    side: Array
    hand: Array

    @classmethod
    def of(cls, cell: YarnCell) -> Surroundings:
        """The surroundings of every stitch of a cell."""
        purl = np.array([
            [cell.purl_at(row, wale) for wale in range(-_AROUND, cell.wales + _AROUND)]
            for row in range(-_AROUND, cell.rows + _AROUND)
        ])  # fmt: skip
        width = 2 * _AROUND + 1
        around = sliding_window_view(purl, (width, width))
        own = around[..., _AROUND, _AROUND]
        other = around ^ own[..., None, None]
        weights = 1 << np.arange(width * width).reshape(width, width)
        code, mirrored = ((seen * weights).sum(axis=(2, 3)) for seen in (other, other[..., ::-1]))
        side = np.where(own, -1.0, 1.0)
        return cls(np.minimum(code, mirrored), side, np.sign(code - mirrored).astype(float))

    def at(self, rows: NDArray[np.int64], wales: NDArray[np.int64]) -> Surroundings:
        """The surroundings of the stitches at the crossings of some rows and wales."""
        place = np.ix_(rows, wales)
        return Surroundings(self.kind[place], self.side[place], self.hand[place])

    def alike(self, tips: Array, leans: Array) -> Array:
        """(k, n): what stitches in like surroundings do not do alike, from the tips and leans
        (stitches, n) of all."""
        kind, side, hand = self.kind.ravel(), self.side.ravel(), self.hand.ravel()
        tips, leans = side[:, None] * tips, side[:, None] * leans
        rows = [leans[hand == 0.0]]
        for shared in np.unique(kind):
            like, handed = kind == shared, (kind == shared) & (hand != 0.0)
            rows.append(tips[like][1:] - tips[like][:1])
            turned = hand[handed][:, None] * leans[handed]
            rows.append(turned[1:] - turned[:1])
        return np.concatenate(rows)


def foot_slopes(grid: SplineGrid, wales: int) -> Array:
    """(wales, controls): slopes dy/dt at the feet of a course, from its control points."""
    count = wales * grid.controls
    around = (grid.controls * np.arange(wales)[:, None] + FOOT + np.arange(SUPPORT)) % count
    slopes = np.zeros((wales, count))
    np.add.at(slopes, (np.arange(wales)[:, None], around), foot_weights(grid))
    return slopes


def foot_rows(cell: YarnCell) -> Array:
    """(k, unknowns): slope dy/dt at the foot between every two stitches, mm."""
    slopes = foot_slopes(cell.grid, cell.wales)
    rows = []
    for course in range(cell.rows):
        for slope in slopes:
            row = np.zeros(cell.unknowns)
            np.add.at(row, cell.dof[course, :, _Y], slope * cell.sign[course, :, _Y])
            rows.append(row)
    return independent(np.array(rows))


def plane_rows(cell: YarnCell) -> Array:
    """(k, unknowns): mean height of every stitch over the middle plane, mm."""
    heights = _of_stitches(cell, middle_weights(cell.grid))
    if cell.mirror == (1, 1):  # no symmetry says where the middle plane lies
        heights = heights - heights.mean(axis=0)
    return independent(heights)


def posture_rows(cell: YarnCell) -> Array:
    """(k, unknowns): how far stitches in like surroundings tip and lean differently, mm."""
    tips, leans = (_of_stitches(cell, of(cell.grid)) for of in (tip_weights, lean_weights))
    return independent(Surroundings.of(cell).alike(tips, leans))


def _of_stitches(cell: YarnCell, weights: Array) -> Array:
    """(stitches, unknowns): sums of heights of the control points of every stitch, foot to foot."""
    rows = []
    for course in range(cell.rows):
        for wale in range(cell.wales):
            row = np.zeros(cell.unknowns)
            for c, weight in enumerate(weights, wale * cell.grid.controls):
                next_cell, own = divmod(c, cell.controls_per_course)
                sign = cell.sign[course, own, _Z] * (cell.mirror[0] if next_cell else 1)
                row[cell.dof[course, own, _Z]] += sign * weight
            rows.append(row)
    return np.array(rows)


def independent(rows: Array) -> Array:
    """Linearly independent rows that span the same space."""
    kept, base = [], np.zeros((0, rows.shape[1]))
    for row in rows:
        left = beyond(base, row)
        if left is not None:
            kept.append(row)
            base = np.concatenate([base, left[None]])
    return np.array(kept).reshape(len(kept), rows.shape[1])


def beyond(base: Array, row: Array) -> Array | None:
    """The direction of a row beyond an orthonormal base (k, n), of length 1; None if it is within
    their span."""
    size = norm(row)
    if size < _SMALL:
        return None
    left = row / size
    for _ in range(2):  # again, for what rounding leaves
        left = left - times(base.T, times(base, left))
    remaining = norm(left)
    return None if remaining < _INDEPENDENT else left / remaining
