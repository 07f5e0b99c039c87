"""Position of each stitch's shape: at rest, or moved with a swatch's displacement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.draw.lattice import Lattice, course_angles, stretched_sizes_mm
from knitcore.draw.stitches import StitchShapes

DEPTH = (0.55, 1.4)
"""Least and greatest change of thickness: strands cannot pass through each other."""


@dataclass(frozen=True, eq=False)
class PlacedStitches:
    """Stitches of a chart in space.

    Attributes
    ----------
    centres_mm : (rows, columns, 2)
    sizes_mm : (rows, columns, 2) along the course and across it.
    angles : (rows, columns) direction of the course, radians.
    depth : thickness of the fabric over its thickness at rest.
    heights_mm : (rows, columns) of the centres over the plane; None if all lie in it.
    frames : (rows, columns, 3, 3) directions of course, wale and face as columns, for stitches that
        have left the plane; None if the angles say all.
    """

    centres_mm: Array
    sizes_mm: Array
    angles: Array
    depth: float
    heights_mm: Array | None = None
    frames: Array | None = None

    def part(self, of: tuple[slice, slice]) -> PlacedStitches:
        """Cut out some rows and columns."""
        return PlacedStitches(
            self.centres_mm[of],
            self.sizes_mm[of],
            self.angles[of],
            self.depth,
            None if self.heights_mm is None else self.heights_mm[of],
            None if self.frames is None else self.frames[of],
        )


def unstretched(shapes: StitchShapes) -> PlacedStitches:
    """Place the stitches where they lie at rest."""
    lattice = shapes.lattice
    return PlacedStitches(*_turned(lattice.centres_mm, lattice.sizes_mm), 1.0)


def carried(shapes: StitchShapes, centres_mm: Array, sheet: Lattice) -> PlacedStitches:
    """Move the fabric with a stretched sheet.

    Loops turn with their course and grow or shrink with the distances to their neighbours. The
    yarn is as long as before, so a fabric that grows in the plane becomes thinner.

    Parameters
    ----------
    shapes : of the chart.
    centres_mm : (rows, columns, 2) centres of the stitches in the stretched sheet.
    sheet : where the stitches lay before.
    """
    placed = _turned(centres_mm, stretched_sizes_mm(centres_mm, sheet))
    return PlacedStitches(*placed, _depth(shapes, placed[1]))


def _turned(centres_mm: Array, sizes_mm: Array) -> tuple[Array, Array, Array]:
    """Centres, sizes and angles along and across the courses, from sizes along x and y."""
    angles = course_angles(centres_mm)
    cosine = np.cos(angles)[..., None]
    return centres_mm, sizes_mm * np.concatenate([1 / cosine, cosine], axis=-1), angles


def lying(corners_mm: Array) -> PlacedStitches:
    """Place the fabric on a curled sheet, every stitch as a whole.

    Parameters
    ----------
    corners_mm : (rows + 1, columns + 1, 3) corners of the stitches.
    """
    right, left = corners_mm[:, 1:], corners_mm[:, :-1]
    along = 0.5 * ((right - left)[1:] + (right - left)[:-1])
    rows = 0.5 * (right + left)
    up, centres = rows[1:] - rows[:-1], 0.5 * (rows[1:] + rows[:-1])
    sizes = np.stack([np.linalg.norm(along, axis=-1), np.linalg.norm(up, axis=-1)], axis=-1)
    course = along / sizes[..., :1]
    face = np.cross(course, up)
    face /= np.maximum(np.linalg.norm(face, axis=-1)[..., None], 1e-12)
    frames = np.stack([course, np.cross(face, course), face], axis=-1)
    return PlacedStitches(
        centres[..., :2], sizes, np.zeros(sizes.shape[:2]), 1.0, centres[..., 2], frames
    )


def mean_sizes_mm(shapes: StitchShapes, placement: PlacedStitches) -> Array:
    """Mean size of the stitches of each shape, (shapes, 2); 1 mm for shapes that do not occur."""
    index, count = shapes.index.ravel(), len(shapes.lines)
    number = np.bincount(index, minlength=count)
    sums = [
        np.bincount(index, placement.sizes_mm[..., axis].ravel(), minlength=count)
        for axis in range(2)
    ]
    return np.where(number > 0, np.array(sums) / np.maximum(number, 1), 1.0).T


def placed_lines(shapes: StitchShapes, placement: PlacedStitches) -> Array:
    """Centre lines of all stitches, (rows, columns, points, 3), mm."""
    lines = shapes.lines[shapes.index]
    flat = lines[..., :2] * placement.sizes_mm[:, :, None]
    if placement.frames is not None and placement.heights_mm is not None:
        own = np.concatenate([flat, placement.depth * lines[..., 2:]], axis=-1)
        centres = np.concatenate([placement.centres_mm, placement.heights_mm[..., None]], axis=-1)
        return np.asarray(own @ placement.frames.swapaxes(-1, -2) + centres[:, :, None])
    cos, sin = np.cos(placement.angles)[..., None], np.sin(placement.angles)[..., None]
    x, y = flat[..., 0], flat[..., 1]
    turned = np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
    depth = placement.depth * lines[..., 2:]
    return np.concatenate([turned + placement.centres_mm[:, :, None], depth], axis=-1)


def _depth(shapes: StitchShapes, sizes_mm: Array) -> float:
    """The change of thickness that conserves the yarn's length, within bounds."""
    number = np.bincount(shapes.index.ravel(), minlength=len(shapes.lines))
    rest = mean_sizes_mm(shapes, unstretched(shapes))
    now = mean_sizes_mm(shapes, PlacedStitches(sizes_mm, sizes_mm, sizes_mm[..., 0], 1.0))

    def length(sizes: Array, depth: float) -> float:
        steps = np.diff(shapes.lines, axis=1)
        steps = steps * np.column_stack([sizes, np.full(len(sizes), depth)])[:, None]
        return float(number @ np.linalg.norm(steps, axis=2).sum(axis=1))

    yarn, (low, high) = length(rest, 1.0), DEPTH
    for _ in range(12):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if length(now, middle) < yarn else (low, middle)
    return 0.5 * (low + high)
