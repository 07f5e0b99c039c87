"""A first shape of the yarn for any repeat of knits and purls."""

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.yarn.model.cell import FACE_LEGS, YarnCell

_KNOTS = np.array([0.0, 0.08, 0.21, 0.29, 0.42, 0.5, 0.58, 0.71, 0.79, 0.92, 1.0])
"""Parameter of foot centre, foot end, lower leg, upper leg, shoulder, head, and back again."""

COURSE_PER_LOOP = 0.27
WALE_PER_LOOP = 0.19
"""Size of a stitch at the start over its loop length."""


def start_state(
    cell: YarnCell,
    loop_length_mm: float,
    radius_mm: float,
    *,
    course_per_loop: float = COURSE_PER_LOOP,
    wale_per_loop: float = WALE_PER_LOOP,
) -> Array:
    """Unknowns of a smooth omega loop with every crossing on its right side.

    The stitch (row j, wale i) is drawn through the loop of row j - 1, forward or backward; a leg
    passes the loop below at the side of its own stitch and the loop above at the side of that one.
    Foot and head pass at the opposite sides.

    Parameters
    ----------
    loop_length_mm : length of yarn in a stitch.
    radius_mm : height of the crossings above the middle plane; strands that cross are twice that
        apart.
    course_per_loop, wale_per_loop : size of a stitch over its loop length.
    """
    size = (course_per_loop * loop_length_mm, wale_per_loop * loop_length_mm)
    grid = cell.grid
    u = np.arange(grid.controls) / grid.controls
    # the last digits of sines differ between processors
    sine, cosine = (
        np.round(of, 12)
        for of in (np.sin(4.0 * np.pi * (u - 0.5)), np.cos(2.0 * np.pi * (u - 0.5)))
    )
    swing_x, swing_y = 0.22 * size[0] * sine, 0.78 * size[1] * cosine
    points = np.zeros((cell.rows, cell.controls_per_course, 3))
    for row in range(cell.rows):
        height = np.concatenate([_height(cell, row, wale, u) for wale in range(cell.wales)])
        points[row, :, 0] = grid.interpolate(np.tile(swing_x, cell.wales))
        points[row, :, 1] = grid.interpolate(np.tile(swing_y, cell.wales))
        points[row, :, 2] = radius_mm * grid.interpolate(height, antiperiodic=cell.mirror_course)
    return cell.state(points, *size)


def _height(cell: YarnCell, row: int, wale: int, u: Array) -> Array:
    """z of one stitch in units of the height of a crossing."""

    def legs(j: int, i: int) -> float:
        return -FACE_LEGS if cell.purl_at(j, i) else FACE_LEGS

    own, above = legs(row, wale), legs(row + 1, wale)
    left, right = (-0.5 * (own + legs(row, wale + side)) for side in (-1, 1))
    half = [-own, own, above, -above]
    knots = [left, *half, -above, *half[::-1], right]
    return scipy.interpolate.PchipInterpolator(_KNOTS, knots)(u)
