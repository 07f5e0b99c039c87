"""A fabric to look at: its yarn, where it lies, its colours; and as a solid for other programs."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Mask
from knitcore.draw.body import Body
from knitcore.draw.instances import MAX_STITCHES
from knitcore.draw.lattice import Lattice
from knitcore.draw.placing import PlacedStitches, placed_lines
from knitcore.draw.stitches import StitchShapes
from knitcore.draw.tubes import resampled, tube_faces, tube_vertices

from .colours import SKIN

Colours = NDArray[np.uint8]

RECTANGLE = 20
"""Stitches that take as much memory of a view as an extensibility rectangle."""
NEARER = 0.25
"""Allowance for perspective: a point at height h above the plane appears 0.25 h farther out."""
BESIDE = 0.8
"""A click selects a stitch if it lands within this many stitch widths of its centre."""
SOLID_LEVELS = ((1_000, 33, 8), (4_000, 17, 6), (10_000, 11, 5))
"""(largest number of stitches, points, sides) of solids."""
MAX_SOLID = SOLID_LEVELS[-1][0]


@dataclass(frozen=True, eq=False)
class Box:
    """Some stitches: rows ``row0`` (the bottom row is 0) to ``row1 - 1``, columns likewise.

    ``part`` (rows, columns) of the box is True where a stitch is one of them; None if all are.
    """

    row0: int
    column0: int
    row1: int
    column1: int
    part: Mask | None = None


_SIDES = (
    ((-1, 0), (-1, -1), (1, -1)),
    ((1, 0), (-1, 1), (1, 1)),
    ((0, -1), (-1, -1), (-1, 1)),
    ((0, 1), (1, -1), (1, 1)),
)
"""Where the next stitch lies, (rows, columns), and the ends of the side to it, (x, y)."""


@dataclass(frozen=True, eq=False)
class Ground:
    """Places of all stitches of a fabric, for clicks, marks, the scale and the camera.

    Attributes
    ----------
    centres_mm, sizes_mm : (rows, columns, 2); in single precision, as a view keeps them.
    top_mm : how high the yarn reaches above the middle plane.
    drawn, room_mm : as in :class:`FabricScene`.
    box_mm : (2, 2) of a fabric that has left its plane: lowest and highest place, as they look from
        the front, of its stitches and of what it rests on.
    rests : whether it rests on something that is to be seen.
    """

    centres_mm: NDArray[np.float32]
    sizes_mm: NDArray[np.float32]
    top_mm: float
    box_mm: Array | None = None
    rests: bool = False
    drawn: NDArray[np.bool_] | None = None
    room_mm: Array | None = None

    @property
    def is_flat(self) -> bool:
        """False for a fabric that has left its plane."""
        return self.box_mm is None

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        rows, columns, _ = self.centres_mm.shape
        return rows, columns

    @cached_property
    def _ends_mm(self) -> Array:
        """Lowest and highest place, (2, 2), of the fabric and of what it rests on."""
        if self.box_mm is not None:
            return np.asarray(self.box_mm + 0.5 * np.array([[-1], [1]]) * self.sizes_mm[0, 0])
        places, half = (v.reshape(-1, 2).astype(float) for v in (self.centres_mm, self.sizes_mm))
        half /= 2
        return np.array([(places - half).min(axis=0), (places + half).max(axis=0)])

    @property
    def middle_mm(self) -> Array:
        """Half way between the ends of the fabric, with what it rests on; the scene's origin."""
        return np.asarray(self._ends_mm.mean(axis=0))

    @property
    def extent_mm(self) -> Array:
        """Width and height, with what the fabric rests on."""
        return np.asarray(np.ptp(self._ends_mm, axis=0))

    @property
    def reach_mm(self) -> Array:
        """Width and height with the outermost loops, which reach beyond the chart."""
        return np.asarray(self.extent_mm + self.sizes_mm[0, 0])

    @property
    def framed_mm(self) -> Array:
        """Width and height that a camera frames: a stretch may need more room than the rest."""
        if self.room_mm is None:
            return self.reach_mm
        return np.asarray(np.maximum(self.reach_mm, self.room_mm + self.sizes_mm[0, 0]))

    def stitch_at(self, x_mm: float, y_mm: float) -> tuple[int, int] | None:
        """The stitch at a place of the scene, (row, column); None outside the fabric."""
        if not self.is_flat:
            return None  # rays are met in the plane, which the fabric has left
        place = np.add(self.middle_mm, (x_mm, y_mm)).astype(np.float32)
        away = np.abs(self.centres_mm - place) / self.sizes_mm
        distance = away.max(axis=2)
        if self.drawn is not None:
            distance = np.where(self.drawn, distance, np.inf)
        row, column = np.unravel_index(distance.argmin(), distance.shape)
        return (int(row), int(column)) if distance[row, column] < BESIDE else None

    def outline_mm(self, box: Box) -> Array:
        """Sides of some stitches beyond which there is none of them, (sides, 2 ends, 2)."""
        where = slice(box.row0, box.row1), slice(box.column0, box.column1)
        marked = np.zeros(self.shape, dtype=bool)
        rows, columns = marked[where].shape
        marked[where] = True if box.part is None else box.part[:rows, :columns]
        if self.drawn is not None:
            marked &= self.drawn
        around = np.pad(marked, 1)
        sides = []
        for (up, right), *ends in _SIDES:
            beyond = around[1 + up : 1 + up + len(marked), 1 + right : 1 + right + marked.shape[1]]
            bare = marked & ~beyond
            half = 0.5 * np.array(ends)[None] * self.sizes_mm[bare][:, None]
            sides.append(self.centres_mm[bare][:, None] - self.middle_mm + half)
        return np.concatenate(sides)


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
    body : what the fabric rests on, if that is to be seen.
    """

    shapes: StitchShapes
    placement: PlacedStitches
    colours: Colours
    drawn: NDArray[np.bool_] | None = None
    rectangles_mm: Array | None = None
    focus: tuple[int, int] | None = None
    room_mm: Array | None = None
    body: Body | None = None

    @cached_property
    def top_mm(self) -> float:
        """Height of the yarn above the middle plane, mm."""
        highest = self.placement.depth * np.abs(self.shapes.lines[..., 2]).max()
        return float(highest + self.shapes.yarn_radius_mm)

    @cached_property
    def ground(self) -> Ground:
        """Places of all its stitches."""
        places = self.placement
        return Ground(
            centres_mm=places.centres_mm.astype(np.float32),
            sizes_mm=places.sizes_mm.astype(np.float32),
            top_mm=self.top_mm,
            box_mm=self._box_mm,
            rests=self.body is not None,
            drawn=self.drawn,
            room_mm=self.room_mm,
        )

    @property
    def _box_mm(self) -> Array | None:
        """Lowest and highest place of stitches and body from the front: ``Ground.box_mm``."""
        places = self.placement
        if places.frames is None or places.heights_mm is None:
            return None
        points = np.dstack([places.centres_mm, places.heights_mm])
        points = points.reshape(-1, 3) if self.drawn is None else points[self.drawn]
        if self.body is not None:
            points = np.concatenate([points, self.body.vertices_mm])
        out = NEARER * np.maximum(points[:, 2:], 0.0)
        plane = points[:, :2]
        return np.stack([(plane - out).min(axis=0), (plane + out).max(axis=0)])

    def drawing(self) -> Drawing:
        """Make the drawing that a view shows and keeps."""
        return Drawing(self.window(), self.ground)

    def window(self, most: int = MAX_STITCHES) -> FabricScene:
        """The part drawn as yarn: all of it, or as many stitches as a browser can draw."""
        rows, columns = self.shapes.index.shape
        if rows * columns <= most:
            return self
        height = min(rows, max(int(most**0.5), most // columns))
        width = min(columns, most // height)
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
            focus=(row - bottom, column - left),
        )


@dataclass(frozen=True, eq=False)
class Drawing:
    """Part of a fabric that a view shows and keeps: little of one too large to be drawn whole.

    Attributes
    ----------
    part : drawn as yarn.
    ground : where all stitches lie.
    """

    part: FabricScene
    ground: Ground

    @property
    def is_whole(self) -> bool:
        """Return whether all stitches are drawn as yarn."""
        return self.part.shapes.index.shape == self.ground.shape

    @property
    def weight(self) -> int:
        """Stitches that it counts as in the budget of a user's views."""
        rectangles = self.part.rectangles_mm
        return self.ground.centres_mm[..., 0].size + (
            0 if rectangles is None else RECTANGLE * len(rectangles)
        )


def solid_glb(scene: FabricScene) -> bytes:
    """The yarn as it lies, with its colours, and what it rests on: binary glTF 2.0 in metres."""
    import trimesh

    drawn = np.ones(scene.shapes.index.size, dtype=bool)
    if scene.drawn is not None:
        drawn = scene.drawn.ravel()
    stitches = int(drawn.sum())
    points, sides = next((p, s) for most, p, s in SOLID_LEVELS if stitches <= most)
    placed = placed_lines(scene.shapes, scene.placement).reshape(len(drawn), -1, 3)[drawn]
    vertices = tube_vertices(resampled(placed, points), scene.shapes.yarn_radius_mm, sides)
    count = vertices.shape[1]
    faces = tube_faces(points, sides).astype(np.int64)
    solid: Any = trimesh.Trimesh(
        vertices.reshape(-1, 3) * 0.001,
        (faces[None] + count * np.arange(stitches)[:, None, None]).reshape(-1, 3),
        vertex_colors=np.repeat(scene.colours.reshape(-1, 3)[drawn], count, axis=0),
        process=False,
    )
    if scene.body is not None:
        skin: Any = trimesh.Trimesh(
            scene.body.sunk_mm(scene.top_mm) * 0.001,
            scene.body.faces,
            vertex_colors=np.tile(np.array(SKIN, dtype=np.uint8), (len(scene.body.vertices_mm), 1)),
            process=False,
        )
        solid = trimesh.util.concatenate([solid, skin])
    content = solid.export(file_type="glb")
    return bytes(content)
