"""A piece laid flat at rest: the one rule for its size, on the page, in patterns and in files."""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.draw.lattice import resting_lattice
from knitcore.garment.shaped import ShapedChart
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Interval, log_interval
from knitcore.prediction.predict import predict
from knitcore.prediction.prediction import Prediction
from knitcore.prediction.size import RelaxedSize


@dataclass(frozen=True)
class SizeAtRest:
    """Width and height of a piece at its widest and highest, with 90 % intervals."""

    width_mm: float
    height_mm: float
    width_interval_mm: Interval
    height_interval_mm: Interval


def size_at_rest(shaped: ShapedChart, material: Material, prediction: Prediction) -> SizeAtRest:
    """Width and height of a piece at rest.

    A rectangle is as many mean stitches wide and high as it has columns and rows. A piece with an
    outline is as large as its laid stitches together; its size is as uncertain as the prediction's.

    Parameters
    ----------
    shaped : the piece.
    material : a yarn at one setting.
    prediction : of the chart, or of the largest rectangle inside the outline
        (:meth:`ShapedChart.rectangle_inside`); with a gauge if one was counted.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.

    Examples
    --------
    >>> from knitcore.chart.stitch_chart import StitchChart
    >>> from knitcore.materials import material
    >>> acrylic = material("acrylic")
    >>> piece = ShapedChart.rectangle(StitchChart.of_fabric("garter", 40, 30))
    >>> size = size_at_rest(piece, acrylic, predict(piece.chart, acrylic))
    >>> round(size.width_mm), round(size.height_mm)
    (119, 81)
    """
    stitch = _stitch_mm(prediction)
    if shaped.is_rectangle:
        sides = stitch * (shaped.chart.columns, shaped.chart.rows)
    else:
        known = RelaxedSize(*stitch.tolist()) if prediction.size_is_known else None
        corners = laid_corners_mm(shaped, material, known)
        cells = np.pad(shaped.stitch, 1)
        reached = cells[1:, 1:] | cells[1:, :-1] | cells[:-1, 1:] | cells[:-1, :-1]
        sides = np.ptp(corners[reached], axis=0)
    width, height = sides.tolist()
    return SizeAtRest(
        width,
        height,
        log_interval(width, prediction.course.relaxed_log_sd),
        log_interval(height, prediction.wale.relaxed_log_sd),
    )


def mean_stitch_mm(
    shaped: ShapedChart, material: Material, gauge: RelaxedSize | None = None
) -> Array:
    """Width and height of the mean stitch at rest, (2,).

    The gauge gives them if it is known; else the prediction for a rectangle, and the resting
    lattice for a piece with an outline.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    if gauge is not None:
        return np.array([gauge.course_mm, gauge.wale_mm])
    if shaped.is_rectangle:
        return _stitch_mm(predict(shaped.chart, material))
    lattice = resting_lattice(shaped.continued(), material)
    return np.asarray(lattice.sizes_mm[shaped.stitch].mean(axis=0))


def laid_corners_mm(
    shaped: ShapedChart, material: Material, gauge: RelaxedSize | None = None
) -> Array:
    """Corners of all cells in the plane, (rows + 1, columns + 1, 2), the lowest x and y at 0.

    They are the corners of the resting lattice. Its scale is that of the gauge if it is known, and
    else, for a rectangle, that of the prediction's stitch.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    lattice = resting_lattice(shaped.continued(), material)
    if gauge is None and shaped.is_rectangle:
        gauge = RelaxedSize(*mean_stitch_mm(shaped, material).tolist())
    corners = lattice.corners_mm
    if gauge is not None:
        corners = corners * gauge.over(lattice.sizes_mm, shaped.stitch)
    return np.asarray(corners - corners.min(axis=(0, 1)))


def _stitch_mm(prediction: Prediction) -> Array:
    return np.array([prediction.along(direction).relaxed_mm for direction in Direction])
