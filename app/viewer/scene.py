"""What a viser scene shows of a design: instanced loops, coloured, and extensibility rectangles."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np
import viser
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.geometry.loops import loop_centre_line, loop_kinds
from knitcore.geometry.tubes import TriangleMesh, tube

Array = NDArray[np.float64]

LEVELS = ((400, 40, 8), (1_500, 26, 6), (10_000, 16, 5), (40_000, 10, 4))
"""(largest number of stitches, points, sides): how finely each loop is drawn."""
MAX_STITCHES = LEVELS[-1][0]
"""Beyond this the view shows the chart's plane and loops only in its middle."""


@dataclass(frozen=True, eq=False)
class FabricScene:
    """Everything needed to draw a fabric.

    Attributes
    ----------
    chart : which loops.
    centres_mm : (rows, columns, 2) positions of the stitches' centres.
    sizes_mm : (rows, columns, 2) width and height of each stitch as it lies there.
    yarn_radius_mm : half the thickness of the tubes.
    colours : (rows, columns, 3) uint8.
    rectangles_mm : (rows, columns, 2) sides of the extensibility rectangles, or None for no layer.
    """

    chart: StitchChart
    centres_mm: Array
    sizes_mm: Array
    yarn_radius_mm: float
    colours: NDArray[np.uint8]
    rectangles_mm: Array | None = None


class SceneWriter:
    """Keeps one viser server's scene in step with a :class:`FabricScene`.

    Handles are kept between writes: a new stretch or colour of the same chart only moves instances.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._lock = threading.Lock()
        self._meshes: dict[int, viser.BatchedMeshHandle] = {}
        self._members: dict[int, NDArray[np.intp]] = {}
        self._drawn: tuple[object, ...] | None = None
        self._rectangles: viser.LineSegmentsHandle | None = None
        self._framed: tuple[int, int] | None = None

    def write(self, scene: FabricScene) -> int:
        """Show the scene to everybody who looks; returns the number of stitches drawn as loops."""
        window = _window(scene.chart)
        chart = scene.chart.region(*window)
        centres = scene.centres_mm[window].reshape(-1, 2)
        sizes = scene.sizes_mm[window].reshape(-1, 2)
        colours = scene.colours[window].reshape(-1, 3)
        middle = scene.centres_mm.reshape(-1, 2).mean(axis=0)
        positions = np.column_stack([centres - middle, np.zeros(len(centres))])
        unit = np.median(scene.sizes_mm.reshape(-1, 2), axis=0)
        scales = np.column_stack([sizes / unit, np.ones(len(sizes))])
        with self._lock:
            drawn = (chart, tuple(np.round(unit, 2)), scene.yarn_radius_mm)
            if drawn != self._drawn:
                self._build(chart, unit, scene.yarn_radius_mm, positions, scales, colours)
                self._drawn = drawn
            else:
                self._move(positions, scales, colours)
            self._draw_rectangles(scene, middle)
            self._frame(scene)
        return chart.rows * chart.columns

    def _build(
        self,
        chart: StitchChart,
        unit: Array,
        radius: float,
        positions: Array,
        scales: Array,
        colours: NDArray[np.uint8],
    ) -> None:
        kinds = loop_kinds(chart).ravel()
        points, sides = _level(kinds.size)
        members = {int(kind): np.flatnonzero(kinds == kind) for kind in np.unique(kinds)}
        meshes = {kind: _loop_mesh(kind, unit, radius, points, sides) for kind in members}
        with self._server.atomic():
            for handle in self._meshes.values():
                handle.remove()
            self._meshes = {
                kind: self._server.scene.add_batched_meshes_simple(
                    f"/fabric/{kind}",
                    vertices=mesh.vertices,
                    faces=mesh.faces,
                    batched_wxyzs=np.tile([1.0, 0.0, 0.0, 0.0], (len(members[kind]), 1)),
                    batched_positions=positions[members[kind]],
                    batched_scales=scales[members[kind]],
                    batched_colors=colours[members[kind]],
                    lod="off",
                    cast_shadow=False,
                    receive_shadow=False,
                )
                for kind, mesh in meshes.items()
            }
        self._members = members

    def _move(self, positions: Array, scales: Array, colours: NDArray[np.uint8]) -> None:
        with self._server.atomic():
            for kind, handle in self._meshes.items():
                members = self._members[kind]
                handle.batched_positions = positions[members].astype(np.float32)
                handle.batched_scales = scales[members].astype(np.float32)
                handle.batched_colors = colours[members]

    def _draw_rectangles(self, scene: FabricScene, middle: Array) -> None:
        if scene.rectangles_mm is None:
            if self._rectangles is not None:
                self._rectangles.remove()
                self._rectangles = None
            return
        self._rectangles = self._server.scene.add_line_segments(
            "/rectangles",
            points=_rectangle_lines(scene, middle),
            colors=(30, 30, 30),
            thickness=1.5,
        )

    def _frame(self, scene: FabricScene) -> None:
        """Look at the whole cloth from the face, once per size of chart."""
        size = (scene.chart.rows, scene.chart.columns)
        if size == self._framed:
            return
        self._framed = size
        extent = np.ptp(scene.centres_mm.reshape(-1, 2), axis=0) + scene.sizes_mm[0, 0]
        distance = 0.76 * float(max(extent[1], extent[0] * 0.9))
        camera = self._server.initial_camera
        camera.up = (0.0, 1.0, 0.0)
        camera.look_at = (0.0, 0.0, 0.0)
        camera.position = (0.0, -0.05 * distance, distance)
        for client in self._server.get_clients().values():
            client.camera.up_direction = (0.0, 1.0, 0.0)
            client.camera.position = (0.0, -0.05 * distance, distance)
            client.camera.look_at = (0.0, 0.0, 0.0)


def _window(chart: StitchChart) -> tuple[slice, slice]:
    """The whole chart, or its middle where that is too much for a browser's triangles."""
    if chart.rows * chart.columns <= MAX_STITCHES:
        return slice(0, chart.rows), slice(0, chart.columns)
    shrink = (MAX_STITCHES / (chart.rows * chart.columns)) ** 0.5
    rows, columns = int(chart.rows * shrink), int(chart.columns * shrink)
    bottom, left = (chart.rows - rows) // 2, (chart.columns - columns) // 2
    return slice(bottom, bottom + rows), slice(left, left + columns)


def _level(stitches: int) -> tuple[int, int]:
    return next((p, s) for most, p, s in LEVELS if stitches <= most)


def _loop_mesh(kind: int, unit: Array, radius: float, points: int, sides: int) -> TriangleMesh:
    line = loop_centre_line(kind, points) * np.array([unit[0], unit[1], radius])
    return tube(line, radius * 0.92, sides)


def _rectangle_lines(scene: FabricScene, middle: Array) -> NDArray[np.float32]:
    assert scene.rectangles_mm is not None  # noqa: S101 - the caller checked
    half = scene.rectangles_mm.reshape(-1, 1, 2) / 2
    centre = (scene.centres_mm.reshape(-1, 2) - middle)[:, None, :]
    corners = centre + half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    lifted = np.concatenate(
        [corners, np.full((*corners.shape[:2], 1), 2.2 * scene.yarn_radius_mm)], axis=2
    )
    pairs = np.stack([lifted, np.roll(lifted, -1, axis=1)], axis=2)
    return pairs.reshape(-1, 2, 3).astype(np.float32)
