"""A fabric to look at: its yarn, where it lies, its colours."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.arrays import Array
from knitcore.geometry.instances import MOST_STITCHES
from knitcore.geometry.lattice import Lattice
from knitcore.geometry.placing import Placement
from knitcore.geometry.stitches import StitchShapes

Colours = NDArray[np.uint8]

BESIDE = 0.8
"""So many stitches from a stitch's centre a click still means it."""


@dataclass(frozen=True)
class Box:
    """Some stitches: rows ``row0`` (the bottom row is 0) to ``row1 - 1``, columns likewise."""

    row0: int
    column0: int
    row1: int
    column1: int


@dataclass(frozen=True, eq=False)
class FabricScene:
    """Everything needed to draw a fabric.

    Attributes
    ----------
    shapes, placement : the yarn and where it lies.
    colours : (rows, columns, 3) uint8.
    drawn : bool (rows, columns), False where the fabric has no stitch; None if it has all.
    rectangles_mm : (rectangles, 4, 2) corners of the layer of rectangles, or None.
    focus : (row, column) around which a chart that is too large is drawn as yarn; its middle if
        None.
    room_mm : width and height that the fabric takes at most while it is stretched.
    """

    shapes: StitchShapes
    placement: Placement
    colours: Colours
    drawn: NDArray[np.bool_] | None = None
    rectangles_mm: Array | None = None
    focus: tuple[int, int] | None = None
    room_mm: Array | None = None

    @property
    def middle_mm(self) -> Array:
        """Centre of the fabric; the scene's origin."""
        middle: Array = self.placement.centres_mm.reshape(-1, 2).mean(axis=0)
        return middle

    @property
    def extent_mm(self) -> Array:
        """Width and height."""
        places = self.placement
        extent: Array = np.ptp(places.centres_mm.reshape(-1, 2), axis=0) + places.sizes_mm[0, 0]
        return extent

    def window(self) -> FabricScene:
        """The part drawn as yarn: all of it, or as much as a browser can draw."""
        rows, columns = self.shapes.index.shape
        if rows * columns <= MOST_STITCHES:
            return self
        height = min(rows, max(int(MOST_STITCHES**0.5), MOST_STITCHES // columns))
        width = min(columns, MOST_STITCHES // height)
        row, column = self.focus or (rows // 2, columns // 2)
        bottom = min(max(row - height // 2, 0), rows - height)
        left = min(max(column - width // 2, 0), columns - width)
        part = (slice(bottom, bottom + height), slice(left, left + width))
        lattice, places = self.shapes.lattice, self.placement
        return dataclasses.replace(
            self,
            shapes=dataclasses.replace(
                self.shapes,
                index=self.shapes.index[part],
                lattice=Lattice(lattice.centres_mm[part], lattice.sizes_mm[part]),
            ),
            placement=places.part(part),
            colours=self.colours[part],
            drawn=None if self.drawn is None else self.drawn[part],
        )

    def stitch_at(self, x_mm: float, y_mm: float) -> tuple[int, int] | None:
        """The stitch at a place of the scene, (row, column); None outside the fabric."""
        places = self.placement
        if places.frames is not None:
            return None  # rays are met in the plane, which the fabric has left
        away = np.abs(places.centres_mm - self.middle_mm - (x_mm, y_mm)) / places.sizes_mm
        distance = away.max(axis=2)
        if self.drawn is not None:
            distance = np.where(self.drawn, distance, np.inf)
        row, column = np.unravel_index(distance.argmin(), distance.shape)
        return (int(row), int(column)) if distance[row, column] < BESIDE else None

    def box_corners_mm(self, box: Box) -> Array:
        """Corners of some stitches' outline in the scene, (4, 2)."""
        places = self.placement
        row0, row1 = (int(np.clip(r, 0, len(places.angles) - 1)) for r in (box.row0, box.row1 - 1))
        column0, column1 = (
            int(np.clip(c, 0, places.angles.shape[1] - 1)) for c in (box.column0, box.column1 - 1)
        )
        corners = ((row0, column0), (row0, column1), (row1, column1), (row1, column0))
        half = 0.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        return np.array(
            [
                places.centres_mm[at] + side * places.sizes_mm[at] - self.middle_mm
                for at, side in zip(corners, half, strict=True)
            ]
        )
