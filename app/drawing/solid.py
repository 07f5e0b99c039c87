"""A fabric as a solid, for other programs."""

from typing import Any

import numpy as np

from knitcore.draw.placing import placed_lines
from knitcore.draw.tubes import resampled, tube_faces, tube_vertices

from .colours import SKIN
from .fabric import FabricScene

SOLID_LEVELS = ((1_000, 33, 8), (4_000, 17, 6), (10_000, 11, 5))
"""(largest number of stitches, points, sides) of solids."""
MAX_SOLID = SOLID_LEVELS[-1][0]


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
