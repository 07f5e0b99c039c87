"""A solved cell laid out over a larger piece of the fabric."""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.yarn.kernels.curve_samples import sample_curve
from knitcore.yarn.model.cell import YarnCell


def tiled_controls(cell: YarnCell, state: Array, rows: int, wales: int) -> Array:
    """(rows, wales * controls, 3): control points of rows × wales stitches, without drift, mm.

    Where the cell repeats mirrored, its copies have z reversed.
    """
    points = cell.controls(state)
    per_stitch = cell.grid.controls
    out = np.empty((rows, wales * per_stitch, 3))
    mirror_course, mirror_wale = cell.mirror
    for row in range(rows):
        for wale in range(wales):
            first = (wale % cell.wales) * per_stitch
            sign = mirror_course ** (wale // cell.wales) * mirror_wale ** (row // cell.rows)
            part = points[row % cell.rows, first : first + per_stitch]
            out[row, wale * per_stitch : (wale + 1) * per_stitch] = part * (1.0, 1.0, sign)
    return out


def tiled_state(cell: YarnCell, state: Array, larger: YarnCell) -> Array:
    """Unknowns of a larger cell of the same fabric in the shape of a smaller one."""
    points = tiled_controls(cell, state, larger.rows, larger.wales)
    return larger.state(points, float(state[-2]), float(state[-1]))


def refined_state(cell: YarnCell, state: Array, finer: YarnCell) -> Array:
    """Unknowns of the same cell with more control points, in the same shape."""
    periods = 2 if cell.mirror_course else 1
    points = tiled_controls(cell, state, cell.rows, periods * cell.wales)
    count = finer.controls_per_course
    fine = np.stack([cell.grid.refine(finer.grid, row)[:count] for row in points])
    return finer.state(fine, float(state[-2]), float(state[-1]))


def centre_lines(cell: YarnCell, state: Array, rows: int, wales: int) -> Array:
    """(rows, wales * samples, 3): samples of the centre lines, mm, bottom course first.

    Each course runs from left to right over ``wales`` stitches; the next repeat follows ``wales``
    stitches further.
    """
    points = tiled_controls(cell, state, rows, wales)
    whole_swaps = cell.mirror_course and (wales // cell.wales) % 2 == 1
    curve = sample_curve(points, float(state[-2]), -1 if whole_swaps else 1, cell.grid.basis)
    lines = np.array(curve[:, :, 0])
    samples = lines.shape[1]
    lines[:, :, 0] += state[-2] * (np.arange(samples) + 0.5) / cell.grid.samples
    lines[:, :, 1] += state[-1] * np.arange(rows)[:, None]
    return lines
