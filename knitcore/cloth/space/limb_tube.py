"""A piece closed to a tube and worn on a limb whose girth changes along its length.

Around the limb a line of stitches (a row, or a column) is as long as the limb's girth there, or as
at rest where that is more. Where the piece has an outline, a line has the stitches inside it. Along
the limb nothing holds it, so that it shortens as predicted of a strip free to narrow
(:mod:`knitcore.garment.limb`). Sizes at rest are those of every stitch's surroundings, and so is
the law (:meth:`knitcore.prediction.patches.Patches.lines`).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.in_space import ClothInSpace
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.limb import LimbPlace, MeasuredLimb, place_on
from knitcore.garment.shaped import ShapedChart
from knitcore.materials import Material
from knitcore.prediction.neighbourhood import counted_over_computed, neighbourhood_sizes
from knitcore.prediction.predict import patches_of
from knitcore.prediction.size import RelaxedSize

LEAST_AROUND = 4
"""Smallest number of stitches that can close to a tube."""
STEEPEST = 0.25
"""Largest share of its stitches that a line of a tube gains or loses, if more than a few."""
SIDES = 72
"""Number of sides with which the limb's surface is drawn."""
BARE = 0.12
"""Length of limb that is drawn beyond either end of the tube, over the limb's girth."""


@dataclass(frozen=True, eq=False, repr=False)
class TubeOnLimb(ClothInSpace):
    """A tube on a limb, in space: the limb's axis along y (x if the columns run around it).

    Attributes
    ----------
    corners_mm : (rows + 1, columns + 1, 3) corners of the stitches, the middle of the chart in
        front (z), the seam behind. The face is outside.
    places : of every line of stitches around the limb, from where the tube begins.
    length_mm, relaxed_length_mm : of the tube along the limb's surface, worn and unworn.
    stitches : (rows, columns) False where the tube has none.
    limb_mm : (rings, sides, 3) the limb under it and a little beyond, closed around.
    """

    corners_mm: Array
    places: tuple[LimbPlace, ...]
    length_mm: float
    relaxed_length_mm: float
    stitches: Mask
    limb_mm: Array


def worn_tube(
    chart: StitchChart,
    material: Material,
    limb: MeasuredLimb,
    around: Direction = Direction.COURSE,
    *,
    stitches: Mask | None = None,
    size: RelaxedSize | None = None,
) -> TubeOnLimb:
    """The whole chart as a tube on a limb.

    Parameters
    ----------
    chart : the tube, cut open; its lowest row (left column) is where the limb begins.
    limb : beyond its ends its girth stays that of the end.
    around : which direction runs around the limb: rows, or columns.
    stitches : (rows, columns), where the chart has an outline.
    size : relaxed size of the mean stitch, if known.

    Raises
    ------
    InputError
        If the chart is too narrow for a tube, its outline is not that of one tube, or the material
        lacks a fabric.
    """
    by_row = around is Direction.COURSE
    shaped = ShapedChart.rectangle(chart) if stitches is None else ShapedChart(chart, stitches)
    inside = shaped.stitch if by_row else shaped.stitch.T
    _check_tube(inside)
    chart = shaped.continued()
    patches = patches_of(chart, material, size)
    if size is None and shaped.is_rectangle:  # as of every rectangle, the predicted size is its own
        course, wale = (patches.relaxed_mm(direction) for direction in Direction)
        size = RelaxedSize(course, wale)
    sizes = neighbourhood_sizes(chart, material)
    sizes *= counted_over_computed(chart, material, size, shaped.stitch)
    if not by_row:
        sizes = sizes.transpose(1, 0, 2)[..., ::-1]
    rests = sizes[..., 0].sum(axis=1, where=inside)
    heights = sizes[..., 1].mean(axis=1, where=inside)
    predictions = patches.lines(around, len(inside))
    places, along_mm = [], [0.0]
    lines = zip(predictions, rests.tolist(), heights.tolist(), strict=True)
    for prediction, rest, height in lines:
        at = along_mm[-1] + 0.5 * height
        place = place_on(
            prediction.along(around), at, float(np.interp(at, limb.at_mm, limb.girths_mm)), rest
        )
        places.append(place)
        along_limb = 0.0 if place.pressure is None else place.pressure.axial_strain_free
        along_mm.append(along_mm[-1] + height * (1.0 + along_limb))
    rings = _between(np.array([max(p.rest_mm, p.girth_mm) for p in places])) / (2.0 * np.pi)
    ends = np.pad(np.cumsum(sizes[..., 0], axis=1), ((0, 0), (1, 0)))
    begins = np.take_along_axis(ends, inside.argmax(axis=1)[:, None], axis=1)
    angles = 2.0 * np.pi * _between((ends - begins) / rests[:, None]) - np.pi
    bare = BARE * places[-1].girth_mm
    reached = np.array([-bare, *along_mm, along_mm[-1] + bare])
    radius = limb.girth_mm(reached) / (2.0 * np.pi)
    steps = np.square(np.diff(reached)) - np.square(np.diff(radius))
    along_axis = np.concatenate([[0.0], np.cumsum(np.sqrt(np.maximum(steps, 0.0)))])
    level = (along_axis - 0.5 * along_axis[-1])[:, None]
    corners = _turned(rings[:, None], angles, level[1:-1])
    sides = np.linspace(-np.pi, np.pi, SIDES, endpoint=False)[None]
    skin = _turned(radius[:, None], sides, level)
    if not by_row:
        corners, skin = (points[..., [1, 0, 2]] for points in (corners, skin))
        corners = corners.transpose(1, 0, 2)
    return TubeOnLimb(
        corners, tuple(places), along_mm[-1], float(heights.sum()), shaped.stitch, skin
    )


def _check_tube(inside: Mask) -> None:
    """Refuse lines (lines, stitches) around a limb that do not close to one tube."""
    remedy = "Wear a part of it, or let the other direction run around the limb."
    for line, marks in enumerate(inside, start=1):
        columns = np.flatnonzero(marks)
        if len(columns) < LEAST_AROUND:
            raise InputError(
                "chart",
                "is too narrow for a tube around a limb.",
                f"Give at least {LEAST_AROUND} stitches, or let the other direction run around it.",
            )
        if np.ptp(columns) >= len(columns):
            problem = f"line {line} around the limb is in several parts, such as fingers."
            raise InputError("outline", problem, remedy)
    counts = inside.sum(axis=1)
    steps = np.abs(np.diff(counts))
    steep = steps > np.maximum(LEAST_AROUND, STEEPEST * np.minimum(counts[1:], counts[:-1]))
    for line in np.flatnonzero(steep)[:1].tolist():
        problem = (
            f"it is no tube: line {line + 1} around the limb has {counts[line]} stitches, the next "
            f"{counts[line + 1]}."
        )
        raise InputError("outline", problem, remedy)


def _between(lines: Array) -> Array:
    """Values at the borders between lines, from the values of the lines."""
    return np.concatenate([lines[:1], 0.5 * (lines[1:] + lines[:-1]), lines[-1:]])


def _turned(radius_mm: Array, angles: Array, level_mm: Array) -> NDArray[np.float64]:
    """Points at angles around the axis; angle 0 is in front."""
    x, z = radius_mm * np.sin(angles), radius_mm * np.cos(angles)
    return np.stack(np.broadcast_arrays(x, level_mm, z), axis=-1).astype(float)
