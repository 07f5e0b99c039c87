"""A fabric as a few meshes and the positions of their copies, for renderers with instancing."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
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
LIT_POINTS = 13
"""Number of points along a stitch that get light, and of pieces of each neighbour that hide it."""
NEAREST = 0.7
"""Smallest distance of a piece, in radii: strands of soft yarn overlap a little."""


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
    vertices = rounded_tubes(lines, shapes.yarn_radius_mm, sides)
    light = occlusion(shapes, points, sides, some)[:, [0, *range(points), points - 1]]
    return StitchMeshes(
        vertices=vertices,
        light=light.reshape(vertices.shape[:2]).astype(np.float32),
        faces=tube_faces(points + 2, sides),
    )


def rounded_tubes(lines: Array, radius_mm: float, sides: int) -> Floats:
    """Tubes around lines (n, points, 3) of successive stitches, with a ring more at each end.

    Returns
    -------
    (n, (points + 2) * sides, 3), ring by ring; successive tubes overlap.
    """
    lines, points = lines.copy(), lines.shape[1]
    lines[:, 0] -= OVERLAP * points * (lines[:, 1] - lines[:, 0])
    lines[:, -1] += OVERLAP * points * (lines[:, -1] - lines[:, -2])
    tubes = tube_vertices(lines, radius_mm, sides)
    ends = [_tips(lines[:, at], lines[:, by], radius_mm) for at, by in ENDS]
    first, last = (np.repeat(tip[:, None], sides, axis=1).astype(np.float32) for tip in ends)
    return np.concatenate([first, tubes, last], axis=1)


def _tips(end: Array, before: Array, radius_mm: float) -> Array:
    """Points (n, 3) beyond the ends of lines."""
    along = end - before
    tips: Array = end + ROUND * radius_mm * along / np.linalg.norm(along, axis=1, keepdims=True)
    return tips


def quaternions(placement: PlacedStitches) -> Floats:
    """Rotation of every stitch as a quaternion w, x, y, z, (rows * columns, 4)."""
    if placement.frames is not None:
        turns = scipy.spatial.transform.Rotation.from_matrix(placement.frames.reshape(-1, 3, 3))
        return turns.as_quat(scalar_first=True).astype(np.float32)
    angles = placement.angles.ravel()
    half = 0.5 * angles
    zero = np.zeros_like(half)
    return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=-1).astype(np.float32)


def occlusion(
    shapes: StitchShapes, points: int, sides: int, some: Sequence[int] | None = None
) -> Array:
    """Ambient occlusion: light at the corners of tubes around shapes, (shapes, points, sides).

    It is the share, 0 to 1, of the light from all around that reaches the yarn between other yarn.

    A piece of yarn of length ds at a distance d, in the direction e, hides 2 r ds / (π d²) n · e of
    what a surface with the normal n sees in front of it; the light is exp(-sum). The sum is over
    the yarn of the stitch itself and of the eight around it at rest, at the place nearest to the
    middle of the chart where the shape occurs.

    Parameters
    ----------
    shapes : the stitches of a chart.
    points, sides : of the tubes, as in :func:`~knitcore.draw.tubes.tube_vertices`.
    some : numbers of the shapes; all if None.
    """
    radius, (rows, columns) = shapes.yarn_radius_mm, shapes.index.shape
    numbers = range(len(shapes.lines)) if some is None else some
    examples = _examples(shapes)
    places = [(number, *examples[s]) for number, s in enumerate(numbers) if s in examples]
    lines = resampled(shapes.lines, LIT_POINTS)
    sizes = np.concatenate([shapes.lattice.sizes_mm, np.ones((rows, columns, 1))], axis=-1)
    light = np.ones((len(numbers), LIT_POINTS, sides))
    for number, row, column in places:
        around = np.s_[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
        pieces = lines[shapes.index[around]] * sizes[around][:, :, None]
        lengths = np.linalg.norm(np.gradient(pieces, axis=2), axis=-1).ravel()
        away = shapes.lattice.centres_mm[around] - shapes.lattice.centres_mm[row, column]
        pieces[..., :2] += away[:, :, None]
        line = lines[shapes.index[row, column]] * sizes[row, column]
        corners = tube_vertices(line[None], radius, sides)[0].reshape(LIT_POINTS, sides, 3)
        outwards = (corners - line[:, None]) / radius
        seen = pieces.reshape(-1, 3) - corners[:, :, None]
        distance = np.maximum(np.linalg.norm(seen, axis=-1), NEAREST * radius)
        facing = np.maximum((seen @ outwards[..., None])[..., 0], 0.0)
        light[number] = np.exp(-2 * radius / np.pi * (facing / distance**3) @ lengths)
    return resampled(light, points)


def _examples(shapes: StitchShapes) -> dict[int, tuple[int, int]]:
    """Row and column nearest to the chart's middle of each shape that occurs."""
    rows, columns = shapes.index.shape
    row, column = np.indices((rows, columns)).reshape(2, -1)
    order = np.argsort(np.hypot(row - rows // 2, column - columns // 2), kind="stable")
    occurring, first = np.unique(shapes.index.ravel()[order], return_index=True)
    cells = order[first]
    return {int(s): (int(row[at]), int(column[at])) for s, at in zip(occurring, cells, strict=True)}
