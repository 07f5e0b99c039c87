"""Linear constraints on a cell's unknowns, besides the lengths of its yarn.

- The foot of every stitch: where each stitch has its own length, its yarn is measured between the
  lowest points of the feet before and after it, so these points are kept at whole t.
- The plane: a fabric laid flat has the middle of every stitch, the mean height of its control
  points, in one plane. It also keeps the feet: yarn that slid by half a stitch would fold as if
  nothing held it, its heads and feet in place of the middles.

Rules that symmetry already keeps are left out.
"""

from __future__ import annotations

import numpy as np

from knitcore.arrays import Array
from knitcore.yarnlevel.cell import YarnCell
from knitcore.yarnlevel.spline import SUPPORT, SplineGrid, quintic_basis

_Y, _Z = 1, 2
FOOT = -2
"""The first of the control points around a foot, from that at the foot."""
_SMALL = 1e-9
_INDEPENDENT = 1e-6


def middle_weights(grid: SplineGrid) -> Array:
    """(controls + 1,) weights of the control points from foot to foot in the mean height of a
    stitch; those at the feet count half."""
    weights = np.full(grid.controls + 1, 1.0 / grid.controls)
    weights[[0, -1]] *= 0.5
    return weights


def foot_weights(grid: SplineGrid) -> Array:
    """(6,) weights of the control points around a foot in the slope there, per unit of t."""
    return np.asarray(quintic_basis(np.array([0.0]), 1)[0] * grid.controls)


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
    weights = middle_weights(cell.grid)
    rows = []
    for course in range(cell.rows):
        for wale in range(cell.wales):
            row = np.zeros(cell.unknowns)
            for c, weight in enumerate(weights, wale * cell.grid.controls):
                next_cell, own = divmod(c, cell.controls_per_course)
                sign = cell.sign[course, own, _Z] * (cell.mirror[0] if next_cell else 1)
                row[cell.dof[course, own, _Z]] += sign * weight
            rows.append(row)
    heights = np.array(rows)
    if cell.mirror == (1, 1):  # no symmetry says where the middle plane lies
        heights = heights - heights.mean(axis=0)
    return independent(heights)


def independent(rows: Array) -> Array:
    """Linearly independent rows that span the same space."""
    kept: list[Array] = []
    for row in rows:
        if is_independent(kept, row):
            kept.append(row)
    return np.array(kept).reshape(len(kept), rows.shape[1])


def is_independent(rows: list[Array], row: Array) -> bool:
    """Whether a row is linearly independent of the others."""
    size = float(np.linalg.norm(row))
    if size < _SMALL:
        return False
    if not rows:
        return True
    base = np.array(rows)
    combined = np.linalg.lstsq(base.T, row, rcond=None)[0] @ base
    return float(np.linalg.norm(row - combined)) > _INDEPENDENT * size
