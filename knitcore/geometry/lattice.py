"""Where the stitches of a chart lie: the flat lattice of courses and wales."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.fabric import PHASES
from knitcore.materials.material import Material
from knitcore.phases import QUARTERS_OF_CODE, surroundings

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Lattice:
    """Stitches of a chart laid flat.

    Attributes
    ----------
    centres_mm : (rows, columns, 2) centres of the stitches, x along the course, y up the wale.
    sizes_mm : (rows, columns, 2) width and height of each stitch.
    """

    centres_mm: Array
    sizes_mm: Array


def stitch_sizes_mm(material: Material) -> Array:
    """Width and height of the 16 kinds of stitch, (16, 2), each the mean of its four quarters."""
    sizes = np.array(
        [
            [material.record(fabric).stitch_course_mm, material.record(fabric).stitch_wale_mm]
            for fabric in PHASES
        ]
    )
    of_code: Array = sizes[QUARTERS_OF_CODE].mean(axis=(1, 2))
    return of_code


def flat_lattice(chart: StitchChart, material: Material) -> Lattice:
    """The chart as a flat sheet: every wale as wide, every course as high, as its stitches' mean.

    It is a picture's lattice, not an equilibrium; the swatch solves for that.

    Raises
    ------
    InputError
        If the material lacks one of the four fabrics.
    """
    wanted = stitch_sizes_mm(material)[surroundings(chart)]
    widths, heights = wanted[:, :, 0].mean(axis=0), wanted[:, :, 1].mean(axis=1)
    x, y = np.cumsum(widths) - widths / 2, np.cumsum(heights) - heights / 2
    return Lattice(
        centres_mm=np.stack(np.meshgrid(x, y), axis=-1),
        sizes_mm=np.stack(np.meshgrid(widths, heights), axis=-1),
    )


def course_angles(centres_mm: Array) -> Array:
    """How far each course runs off the horizontal at each stitch, radians, (rows, columns)."""
    if centres_mm.shape[1] < 2:
        return np.zeros(centres_mm.shape[:2])
    along = np.gradient(centres_mm, axis=1)
    angles: Array = np.arctan2(along[..., 1], along[..., 0])
    return angles


def stretched_sizes_mm(centres_mm: Array, relaxed: Lattice) -> Array:
    """Sizes of stitches whose centres have moved, so that neighbours still meet.

    Parameters
    ----------
    centres_mm : (rows, columns, 2) where the centres are now.
    relaxed : the lattice before.
    """
    sizes = relaxed.sizes_mm.copy()
    for axis, component in ((1, 0), (0, 1)):
        if centres_mm.shape[axis] < 2:
            continue
        now = np.gradient(centres_mm[..., component], axis=axis)
        before = np.gradient(relaxed.centres_mm[..., component], axis=axis)
        sizes[..., component] *= now / before
    return sizes
