"""The yarn of a fabric in a viser scene: one node for every shape of stitch, drawn many times."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.draw.instances import quaternions, rounded_tubes, stitch_meshes, tube_sizes
from knitcore.draw.placing import placed_lines
from knitcore.draw.stitches import StitchShapes
from knitcore.draw.tubes import resampled, tube_faces

from ..drawing.colours import linear
from ..drawing.fabric import FabricScene

if TYPE_CHECKING:
    import viser

UNITS_PER_MM = 0.01
"""A scene is drawn in dm: browsers draw nothing that is 1000 units from the camera or farther, and
a camera that sees a cloth half a metre wide stands a metre away."""
RESIZE = np.array([0.06, 0.06, 0.06, 0.02])
"""Logarithms of the changes of :func:`tube_sizes` up to which a tube is scaled, not drawn anew."""
FINEST = 256
"""Steps to a millimetre in which places and sizes are sent, as in frontend/viser/yarn.js."""
MOST_SHAPES = 500
"""Shapes that have nodes of their own: a browser draws one after the other."""
WHOLE = b"whole"
"""Beginning of the key of a mesh of many stitches."""
BURIED = 0.5
"""Darkening of yarn at the back of stitches that are all different, 0 to 1."""
BRIGHTEST = 63 / 64
"""Full light as it is sent: less than a step, since the fraction of a step holds the light."""


@dataclass(frozen=True, eq=False)
class _Node:
    """A shape as browsers have it: viser's handle, and the :func:`tube_sizes` it was drawn for."""

    handle: Any
    sizes: Array

    def fits(self, sizes: Array) -> bool:
        return bool((np.abs(np.log(sizes / self.sizes)) <= RESIZE).all())


class ShownStitches:
    """The stitches of a scene.

    A shape keeps its node: a stretch, a colour or a stroke moves stitches from node to node, and
    browsers build what is new. They show removed nodes until they have built the rest
    (frontend/viser/frame.js).
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._nodes: dict[bytes, _Node] = {}
        self._made = 0

    def lay(
        self, scene: FabricScene, middle_mm: Array, level: tuple[int, int], *, exact: bool
    ) -> bool:
        """Show the stitches of a scene, and no others.

        Parameters
        ----------
        scene : drawn as yarn throughout.
        middle_mm : (2,) the scene's origin.
        level : points along and around a tube.
        exact : False scales tubes however much, which flattens them, and is quick.

        Returns
        -------
        whether tubes are scaled more than they should be.
        """
        shapes = _distinct(scene.shapes)
        if len(shapes.lines) > MOST_SHAPES:
            self._lay_whole(scene, middle_mm, level)
            return False
        sizes = tube_sizes(shapes, scene.placement)
        cells = shapes.index.ravel()
        there = np.arange(len(cells)) if scene.drawn is None else np.flatnonzero(scene.drawn)
        there = there[np.argsort(cells[there], kind="stable")]
        used, first = np.unique(cells[there], return_index=True)
        stitches = dict(zip(map(int, used), np.split(there, first[1:]), strict=True))
        keys = {shape: bytes(level) + shapes.lines[shape].tobytes() for shape in stitches}
        kept = {key: self._nodes[key] for key in keys.values() if key in self._nodes}
        flat = [key for s, key in keys.items() if key in kept and not kept[key].fits(sizes[s])]
        if exact:
            kept = {key: node for key, node in kept.items() if key not in flat}
        new = [shape for shape, key in keys.items() if key not in kept]
        meshes = stitch_meshes(shapes, scene.placement, *level, new)
        drawn = sizes.copy()
        for shape, key in keys.items():
            if key in kept:
                drawn[shape] = kept[key].sizes
        copies = _copies(scene, middle_mm, drawn[cells])
        with self._server.atomic():
            for shape, key in keys.items():
                of = {name: values[stitches[shape]] for name, values in copies.items()}
                if key in kept:
                    _move(kept[key].handle, of)
                else:
                    number = new.index(shape)
                    lit = _lit(meshes.vertices[number], meshes.light[number])
                    kept[key] = _Node(self._made_of(lit, meshes.faces, of), sizes[shape])
            for key, node in self._nodes.items():
                if node is not kept.get(key):
                    node.handle.remove()
        self._nodes = kept
        return bool(flat) and not exact

    def _lay_whole(self, scene: FabricScene, middle_mm: Array, level: tuple[int, int]) -> None:
        """Show stitches that are all different: a mesh for each colour, drawn once."""
        points, sides = level
        drawn = np.ones(scene.shapes.index.shape, bool) if scene.drawn is None else scene.drawn
        lines = resampled(placed_lines(scene.shapes, scene.placement)[drawn], points)
        lines[..., :2] -= middle_mm
        tubes = rounded_tubes(lines, scene.shapes.yarn_radius_mm, sides)
        low, high = np.percentile(tubes[..., 2], [2, 98])
        light = 1.0 - BURIED * np.clip((high - tubes[..., 2]) / max(high - low, 1e-6), 0.0, 1.0)
        colours, own = np.unique(linear(scene.colours[drawn]), axis=0, return_inverse=True)
        nodes: dict[bytes, _Node] = {}
        with self._server.atomic():
            for number, colour in enumerate(colours):
                some = own.ravel() == number
                tube, count = tube_faces(points + 2, sides), tubes.shape[1]
                faces = tube + count * np.arange(some.sum(), dtype=np.uint32)[:, None, None]
                nodes[WHOLE + colour.tobytes()] = _Node(
                    self._made_of(
                        _lit(tubes[some].reshape(-1, 3), light[some].ravel()),
                        faces.reshape(-1, 3),
                        {
                            "batched_positions": np.zeros((1, 3), np.float32),
                            "batched_scales": np.ones((1, 3), np.float32),
                            "batched_wxyzs": np.array([[1, 0, 0, 0]], np.float32),
                            "batched_colors": colour[None],
                        },
                    ),
                    np.full(4, np.inf),
                )
            for node in self._nodes.values():
                node.handle.remove()
        self._nodes = nodes

    def _made_of(
        self, vertices: NDArray[np.float32], faces: NDArray[np.uint32], copies: dict[str, Any]
    ) -> Any:
        self._made += 1
        return self._server.scene.add_batched_meshes_simple(
            f"/fabric/{self._made}",
            vertices=vertices,
            faces=faces,
            lod="off",
            scale=UNITS_PER_MM,
            cast_shadow=False,
            receive_shadow=False,
            **copies,
        )


def _move(handle: Any, copies: dict[str, Any]) -> None:
    for name, values in copies.items():
        if not np.array_equal(getattr(handle, name), values):
            setattr(handle, name, values)


def _distinct(shapes: StitchShapes) -> StitchShapes:
    """Every shape once."""
    count, *size = shapes.lines.shape
    distinct, number = np.unique(
        shapes.lines.astype(np.float32).reshape(count, -1), axis=0, return_inverse=True
    )
    lines = distinct.astype(float).reshape(-1, *size)
    return replace(shapes, lines=lines, index=number.ravel()[shapes.index])


def _copies(scene: FabricScene, middle_mm: Array, drawn: Array) -> dict[str, Any]:
    """Make viser's arguments for every stitch, in the order of the chart's cells.

    Parameters
    ----------
    drawn : (stitches, 4) for which :func:`tube_sizes` their tubes were drawn.
    """
    places = scene.placement
    centres = places.centres_mm.reshape(-1, 2) - middle_mm
    sizes = places.sizes_mm.reshape(-1, 2) / drawn[:, :2]
    depth = places.depth / drawn[:, 2]
    heights = 0.0 * depth if places.heights_mm is None else places.heights_mm.ravel()
    return {
        "batched_positions": _short(np.column_stack([centres, heights])),
        "batched_scales": _short(np.column_stack([sizes, depth])),
        "batched_wxyzs": _short(quaternions(places)),
        "batched_colors": linear(scene.colours.reshape(-1, 3)),
    }


def _lit(vertices: NDArray[np.float32], light: NDArray[np.float32]) -> NDArray[np.float32]:
    """Corners of a tube; the fractional part of z encodes the ambient light for the browser's
    shaders: viser sends nothing else for each corner."""
    lit = _short(vertices)
    lit[:, 2] = (np.floor(FINEST * vertices[:, 2]) + np.minimum(light, BRIGHTEST)) / FINEST
    return lit


def _short(values: NDArray[Any]) -> NDArray[np.float32]:
    """Numbers with few digits, which pack well on their way to the browser."""
    return np.round(values * FINEST).astype(np.float32) / np.float32(FINEST)
