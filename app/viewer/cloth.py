"""The yarn of a fabric in a viser scene: one batch of instances for every shape of stitch."""

from __future__ import annotations

from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from app.drawing.colours import linear
from app.drawing.fabric import FabricScene
from knitcore.arrays import Array
from knitcore.geometry.instances import StitchMeshes, quaternions, stitch_meshes
from knitcore.geometry.placing import mean_sizes_mm

UNITS_PER_MM = 0.01
"""A scene is drawn in dm: browsers draw nothing that is 1000 units from the camera or farther, and
a camera that sees a cloth half a metre wide stands a metre away."""
RESIZE = 0.06
"""Logarithm of the change of size up to which tubes are scaled instead of drawn anew."""
FINEST = 256
"""Steps to a millimetre in which places and sizes are sent; frontend/yarn.js knows it, too."""
BRIGHTEST = 63 / 64
"""Full light is no whole step."""


class Cloth:
    """Instanced stitches; those of the same shapes can be moved and coloured.

    Parameters
    ----------
    server : where they are drawn.
    name : of their node in the scene.
    scene : drawn as yarn throughout.
    middle_mm : (2,) the scene's origin.
    level : points along and around a tube.
    visible : False makes the browsers build them without showing them.
    """

    def __init__(
        self,
        server: viser.ViserServer,
        name: str,
        scene: FabricScene,
        middle_mm: Array,
        level: tuple[int, int],
        *,
        visible: bool,
    ) -> None:
        self._server = server
        self._level = level
        self._shapes, self._drawn = scene.shapes, scene.drawn
        index = scene.shapes.index.ravel()
        if scene.drawn is not None:
            index = np.where(scene.drawn.ravel(), index, -1)
        self._members = {int(s): np.flatnonzero(index == s) for s in np.unique(index[index >= 0])}
        self._meshes = stitch_meshes(scene.shapes, scene.placement, *level)
        instances = _instances(scene, middle_mm, self._meshes)
        with server.atomic():
            self._handles: dict[int, Any] = {
                shape: server.scene.add_batched_meshes_simple(
                    f"{name}/{shape}",
                    vertices=_lit(self._meshes.vertices[shape], self._meshes.light[shape]),
                    faces=self._meshes.faces,
                    lod="off",
                    scale=UNITS_PER_MM,
                    cast_shadow=False,
                    receive_shadow=False,
                    visible=visible,
                    **{key: values[stitches] for key, values in instances.items()},
                )
                for shape, stitches in self._members.items()
            }

    def draws(self, scene: FabricScene, level: tuple[int, int]) -> bool:
        """Whether the scene has the same stitches, wherever they lie."""
        mine, shapes = self._shapes, scene.shapes
        return (
            level == self._level
            and mine.yarn_radius_mm == shapes.yarn_radius_mm
            and _same(self._drawn, scene.drawn)
            and np.array_equal(mine.index, shapes.index)
            and np.array_equal(mine.lines, shapes.lines)
        )

    def fits(self, scene: FabricScene) -> bool:
        """Whether its tubes can be scaled to the scene's stitches without looking flattened."""
        sizes = mean_sizes_mm(scene.shapes, scene.placement)
        return self._meshes.fits(sizes, scene.placement.depth, RESIZE)

    def move(self, scene: FabricScene, middle_mm: Array) -> None:
        """Lay its stitches, and colour them, as in a scene that it :meth:`draws`."""
        instances = _instances(scene, middle_mm, self._meshes)
        with self._server.atomic():
            for shape, handle in self._handles.items():
                for name, values in instances.items():
                    new = values[self._members[shape]]
                    if not np.array_equal(getattr(handle, name), new):
                        setattr(handle, name, new)

    def show(self) -> None:
        """Make it visible."""
        for handle in self._handles.values():
            handle.visible = True

    def remove(self) -> None:
        """Take it out of the scene."""
        for handle in self._handles.values():
            handle.remove()


def _same(a: NDArray[np.bool_] | None, b: NDArray[np.bool_] | None) -> bool:
    return a is b or (a is not None and b is not None and np.array_equal(a, b))


def _instances(scene: FabricScene, middle_mm: Array, meshes: StitchMeshes) -> dict[str, Any]:
    """What viser takes of every stitch, in the order of the chart's cells."""
    places, index = scene.placement, scene.shapes.index.ravel()
    centres = places.centres_mm.reshape(-1, 2) - middle_mm
    sizes = places.sizes_mm.reshape(-1, 2) / meshes.sizes_mm[index]
    depth = np.full(len(index), places.depth / meshes.depth)
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
