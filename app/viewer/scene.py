"""What a viser server shows of a fabric: instanced stitches, rectangles, a mark."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from app.viewer.camera import Side, place_camera
from app.viewer.colours import linear
from app.viewer.fabric import Box, FabricScene
from knitcore.geometry.instances import StitchMeshes, level_of, quaternions, stitch_meshes
from knitcore.geometry.placing import mean_sizes_mm
from knitcore.geometry.stitches import StitchShapes

Array = NDArray[np.float64]

RESIZE = 0.06
"""Logarithm of the change of size up to which tubes are scaled instead of drawn anew."""
FINEST = 256
"""Steps to a millimetre in which places and sizes are sent."""
MARK = (232, 72, 44)
INK = (30, 30, 30)
PAPER = (255, 252, 246)


class SceneWriter:
    """Keeps one viser server's scene in step with a :class:`FabricScene`.

    Handles are kept between writes: a new stretch or colour of the same chart only moves instances.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._lock = threading.RLock()
        self._scene: FabricScene | None = None
        self._shapes: StitchShapes | None = None
        self._drawn: NDArray[np.bool_] | None = None
        self._meshes: StitchMeshes | None = None
        self._level = (0, 0)
        self._handles: dict[int, Any] = {}
        self._members: dict[int, NDArray[np.intp]] = {}
        self._layers: dict[str, Any] = {}
        self._framed: tuple[float, ...] | None = None
        self._side = Side.FACE

    @property
    def scene(self) -> FabricScene | None:
        """What is shown."""
        return self._scene

    def write(self, scene: FabricScene) -> int:
        """Show a fabric to everybody who looks; returns the number of stitches drawn as yarn."""
        part = scene.window()
        stitches = int(part.shapes.index.size if part.drawn is None else part.drawn.sum())
        with self._lock:
            self._scene = scene
            if self._is_drawn(part, level_of(stitches)):
                self._move(part, scene.middle_mm)
            else:
                self._level = level_of(stitches)
                self._build(part, scene.middle_mm)
            self._draw_rectangles(part, scene.middle_mm)
            self._draw_sheet(None if part is scene else scene)
            room = _room(scene)
            if room != self._framed:
                self._framed = room
                self.look(self._side)
        return stitches

    def mark(self, box: Box | None) -> None:
        """Outline some stitches on both sides, or none."""
        with self._lock:
            scene = self._scene
            if box is None or scene is None:
                self._put("mark", None)
                return
            corners = scene.box_corners_mm(box)
            depth = scene.placement.depth * np.abs(scene.shapes.lines[..., 2]).max()
            height = depth + scene.shapes.yarn_radius_mm
            loops = [np.column_stack([corners, np.full(4, z)]) for z in (height, -height)]
            pairs = np.concatenate([np.stack([c, np.roll(c, -1, axis=0)], axis=1) for c in loops])
            self._put(
                "mark",
                self._server.scene.add_line_segments(
                    "/mark",
                    points=pairs.astype(np.float32),
                    colors=MARK,
                    thickness=3.0,
                    thickness_units="screen",
                ),
            )

    def look(self, side: Side) -> None:
        """Turn everybody's camera to a side."""
        with self._lock:
            self._side = side
            if self._scene is not None:
                room = self._scene.extent_mm
                if self._scene.room_mm is not None:
                    room = np.maximum(room, self._scene.room_mm)
                # Loops reach into the rows and columns beside theirs, the outermost beyond all.
                place_camera(self._server, side, room + self._scene.placement.sizes_mm[0, 0])

    # -- yarn ---------------------------------------------------------------------------------

    def _is_drawn(self, scene: FabricScene, level: tuple[int, int]) -> bool:
        before, shapes = self._shapes, scene.shapes
        return (
            before is not None
            and level == self._level
            and before.yarn_radius_mm == shapes.yarn_radius_mm
            and _same(self._drawn, scene.drawn)
            and np.array_equal(before.index, shapes.index)
            and np.array_equal(before.lines, shapes.lines)
        )

    def _build(self, scene: FabricScene, middle: Array) -> None:
        index = scene.shapes.index.ravel()
        if scene.drawn is not None:
            index = np.where(scene.drawn.ravel(), index, -1)
        members = {int(s): np.flatnonzero(index == s) for s in np.unique(index[index >= 0])}
        meshes = stitch_meshes(scene.shapes, scene.placement, *self._level)
        instances = _instances(scene, middle, meshes)
        with self._server.atomic():
            for shape in self._handles.keys() - members.keys():
                self._handles.pop(shape).remove()
            for shape, stitches in members.items():
                self._handles[shape] = self._server.scene.add_batched_meshes_simple(
                    f"/fabric/{shape}",
                    vertices=_short(meshes.vertices[shape]),
                    faces=meshes.faces,
                    lod="off",
                    cast_shadow=False,
                    receive_shadow=False,
                    **_of(instances, stitches),
                )
        self._members, self._meshes = members, meshes
        self._shapes, self._drawn = scene.shapes, scene.drawn

    def _move(self, scene: FabricScene, middle: Array) -> None:
        assert self._meshes is not None  # noqa: S101 - it is drawn
        sizes, depth = mean_sizes_mm(scene.shapes, scene.placement), scene.placement.depth
        meshes = self._meshes
        if not meshes.fits(sizes, depth, RESIZE):
            meshes = stitch_meshes(scene.shapes, scene.placement, *self._level)
        instances = _instances(scene, middle, meshes)
        with self._server.atomic():
            for shape, handle in self._handles.items():
                if meshes is not self._meshes:
                    handle.vertices = _short(meshes.vertices[shape])
                for name, values in instances.items():
                    new = values[self._members[shape]]
                    if not np.array_equal(getattr(handle, name), new):
                        setattr(handle, name, new)
        self._meshes = meshes

    # -- layers -------------------------------------------------------------------------------

    def _draw_rectangles(self, scene: FabricScene, middle: Array) -> None:
        if scene.rectangles_mm is None:
            self._put("rectangles", None)
            self._put("panes", None)
            return
        corners = _lifted_rectangles(scene, middle)
        first = 4 * np.arange(len(corners))[:, None]
        self._put(
            "panes",
            self._server.scene.add_mesh_simple(
                "/panes",
                vertices=corners.reshape(-1, 3),
                faces=(first + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3).astype(np.uint32),
                color=PAPER,
                opacity=0.55,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            ),
        )
        lines = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 3)
        self._put(
            "rectangles",
            self._server.scene.add_line_segments(
                "/rectangles", points=lines, colors=INK, thickness=1.5, thickness_units="screen"
            ),
        )

    def _draw_sheet(self, scene: FabricScene | None) -> None:
        """All of a chart that is too large, as a picture behind the part that is drawn."""
        if scene is None:
            self._put("sheet", None)
            return
        width, height = scene.extent_mm
        depth = np.abs(scene.shapes.lines[..., 2]).max() + scene.shapes.yarn_radius_mm
        picture = scene.colours
        if scene.drawn is not None:
            picture = np.dstack([picture, 255 * scene.drawn.astype(np.uint8)])
        self._put(
            "sheet",
            self._server.scene.add_image(
                "/sheet",
                picture[::-1],
                render_width=float(width),
                render_height=float(height),
                format="png",
                position=(0.0, 0.0, -2.0 * float(depth)),
                cast_shadow=False,
                receive_shadow=False,
            ),
        )

    def _put(self, name: str, handle: Any) -> None:
        """Note a layer's new handle; the same name replaced the old one, None removes it."""
        old = self._layers.pop(name, None)
        if handle is not None:
            self._layers[name] = handle
        elif old is not None:
            old.remove()


def _same(a: NDArray[np.bool_] | None, b: NDArray[np.bool_] | None) -> bool:
    return a is b or (a is not None and b is not None and np.array_equal(a, b))


def _room(scene: FabricScene) -> tuple[float, ...]:
    """What the camera is placed for; it stays where people turned it until this changes."""
    shape = scene.shapes.index.shape
    return shape if scene.room_mm is None else (*shape, *scene.room_mm.round(1).tolist())


def _instances(scene: FabricScene, middle: Array, meshes: StitchMeshes) -> dict[str, Any]:
    """What viser takes of every stitch, in the order of the chart's cells."""
    places, index = scene.placement, scene.shapes.index.ravel()
    centres = places.centres_mm.reshape(-1, 2) - middle
    sizes = places.sizes_mm.reshape(-1, 2) / meshes.sizes_mm[index]
    depth = np.full(len(index), places.depth / meshes.depth)
    return {
        "batched_positions": _short(np.column_stack([centres, 0.0 * depth])),
        "batched_scales": _short(np.column_stack([sizes, depth])),
        "batched_wxyzs": _short(quaternions(places.angles.ravel())),
        "batched_colors": linear(scene.colours.reshape(-1, 3)),
    }


def _short(values: NDArray[Any]) -> NDArray[np.float32]:
    """Numbers with few digits, which pack well on their way to the browser."""
    short: NDArray[np.float32] = np.round(values * FINEST).astype(np.float32) / np.float32(FINEST)
    return short


def _of(instances: dict[str, Any], stitches: NDArray[np.intp]) -> dict[str, Any]:
    return {name: values[stitches] for name, values in instances.items()}


def _lifted_rectangles(scene: FabricScene, middle: Array) -> NDArray[np.float32]:
    """Corners of the rectangles over the face, (rectangles, 4, 3)."""
    assert scene.rectangles_mm is not None  # noqa: S101 - the caller checked
    corners = scene.rectangles_mm - middle
    highest = scene.placement.depth * scene.shapes.lines[..., 2].max()
    height = highest + 1.3 * scene.shapes.yarn_radius_mm
    lifted = np.concatenate([corners, np.full((*corners.shape[:2], 1), height)], axis=2)
    return lifted.astype(np.float32)
