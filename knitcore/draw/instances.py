"""A fabric as a few meshes and the positions of their copies, for renderers with instancing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from knitcore.base.arrays import Array
from knitcore.draw.occlusion import occlusion
from knitcore.draw.placing import PlacedStitches, mean_sizes_mm
from knitcore.draw.stitches import StitchShapes
from knitcore.draw.tubes import resampled, tube_faces, tube_vertices

Floats = NDArray[np.float32]

LEVELS = ((1_500, 48, 8), (10_000, 14, 6), (40_000, 10, 4))
"""(largest number of stitches, points, sides): how finely each stitch is drawn."""
COARSE_LEVELS = ((250, 48, 8), (900, 18, 6), (1_500, 15, 4), (40_000, 7, 4))
"""The levels without a GPU, where the time for a frame grows with its triangles."""
OVERLAP = 0.012
"""Overlap of successive tubes, in stitches, so that joins show no gap."""
ENDS = ((0, 1), (-1, -2))
"""Indices of the points at both ends of a line, each with its neighbour."""
ROUND = 0.7
"""Reach of the round ends beyond a tube, in radii; within a row the next tube hides them."""
MAX_STITCHES = LEVELS[-1][0]


@dataclass(frozen=True, eq=False)
class StitchMeshes:
    """One tube for each shape, sized as its stitches are on average.

    Attributes
    ----------
    vertices : (shapes, V, 3) mm, around the stitch's centre; ring by ring along the tube, with a
        ring at each end that rounds it.
    light : (shapes, V) share of the light from all around that reaches them, 0 to 1.
    faces : (F, 3), the same for all.
    """

    vertices: Floats
    light: Floats
    faces: NDArray[np.uint32]


def level_of(stitches: int, *, coarse: bool = False) -> tuple[int, int]:
    """Points and sides of a tube, for a number of stitches; ``coarse`` without a GPU."""
    levels = COARSE_LEVELS if coarse else LEVELS
    return next((p, s) for most, p, s in levels if stitches <= most)


def tube_sizes(shapes: StitchShapes, placement: PlacedStitches) -> Array:
    """Sizes for which the tube of each shape is drawn, (shapes, 4).

    Mean width and height of its stitches in mm, thickness of the fabric over that at rest, radius
    of the yarn in mm. Tubes may be scaled to sizes that are little different.
    """
    mean = mean_sizes_mm(shapes, placement)
    same = np.broadcast_to([placement.depth, shapes.yarn_radius_mm], mean.shape)
    return np.concatenate([mean, same], axis=1)


def stitch_meshes(
    shapes: StitchShapes,
    placement: PlacedStitches,
    points: int,
    sides: int,
    some: Sequence[int] | None = None,
) -> StitchMeshes:
    """Tubes of the yarn's thickness around the shapes, at their mean sizes in a placement.

    Parameters
    ----------
    some : numbers of the shapes; all if None.
    """
    numbers = np.arange(len(shapes.lines)) if some is None else np.asarray(some, dtype=int)
    sizes = tube_sizes(shapes, placement)[numbers, :3]
    lines = resampled(shapes.lines[numbers], points) * sizes[:, None]
    lines[:, 0] -= OVERLAP * points * (lines[:, 1] - lines[:, 0])
    lines[:, -1] += OVERLAP * points * (lines[:, -1] - lines[:, -2])
    tubes = tube_vertices(lines, shapes.yarn_radius_mm, sides)
    ends = [_tips(lines[:, at], lines[:, by], shapes.yarn_radius_mm) for at, by in ENDS]
    first, last = (np.repeat(tip[:, None], sides, axis=1).astype(np.float32) for tip in ends)
    light = occlusion(shapes, points, sides, some)[:, [0, *range(points), points - 1]]
    vertices = np.concatenate([first, tubes, last], axis=1)
    return StitchMeshes(
        vertices=vertices,
        light=light.reshape(vertices.shape[:2]).astype(np.float32),
        faces=tube_faces(points + 2, sides),
    )


def _tips(end: Array, before: Array, radius_mm: float) -> Array:
    """Points (n, 3) beyond the ends of lines."""
    along = end - before
    tips: Array = end + ROUND * radius_mm * along / np.linalg.norm(along, axis=1, keepdims=True)
    return tips


def quaternions(placement: PlacedStitches) -> Floats:
    """Rotation of every stitch as a quaternion w, x, y, z, (rows * columns, 4)."""
    if placement.frames is not None:
        turns = Rotation.from_matrix(placement.frames.reshape(-1, 3, 3))
        return turns.as_quat(scalar_first=True).astype(np.float32)
    angles = placement.angles.ravel()
    half = 0.5 * angles
    zero = np.zeros_like(half)
    return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=-1).astype(np.float32)
