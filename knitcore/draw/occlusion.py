"""Ambient occlusion: how much of the light from all around reaches the yarn between other yarn."""

from collections.abc import Sequence

import numpy as np

from knitcore.base.arrays import Array
from knitcore.draw.stitches import StitchShapes
from knitcore.draw.tubes import resampled, tube_vertices

POINTS = 13
"""Number of points along a stitch that get light, and of pieces of each neighbour that hide it."""
NEAREST = 0.7
"""Smallest distance of a piece, in radii: strands of soft yarn overlap a little."""


def occlusion(
    shapes: StitchShapes, points: int, sides: int, some: Sequence[int] | None = None
) -> Array:
    """Light at the corners of tubes around shapes, (shapes, points, sides), 0 to 1.

    A piece of yarn of length ds at a distance d, in the direction e, hides 2 r ds / (π d²) n · e of
    what a surface with the normal n sees in front of it; the light is exp(-sum). The sum is over
    the yarn of the stitch itself and of the eight around it at rest, at the place nearest to the
    middle of the chart where the shape occurs.

    Parameters
    ----------
    shapes : the stitches of a chart.
    points, sides : of the tubes, as in :func:`knitcore.draw.tubes.tube_vertices`.
    some : numbers of the shapes; all if None.
    """
    radius, (rows, columns) = shapes.yarn_radius_mm, shapes.index.shape
    numbers = range(len(shapes.lines)) if some is None else some
    examples = _examples(shapes)
    places = [(number, *examples[s]) for number, s in enumerate(numbers) if s in examples]
    lines = resampled(shapes.lines, POINTS)
    sizes = np.concatenate([shapes.lattice.sizes_mm, np.ones((rows, columns, 1))], axis=-1)
    light = np.ones((len(numbers), POINTS, sides))
    for number, row, column in places:
        around = np.s_[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2]
        pieces = lines[shapes.index[around]] * sizes[around][:, :, None]
        lengths = np.linalg.norm(np.gradient(pieces, axis=2), axis=-1).ravel()
        away = shapes.lattice.centres_mm[around] - shapes.lattice.centres_mm[row, column]
        pieces[..., :2] += away[:, :, None]
        line = lines[shapes.index[row, column]] * sizes[row, column]
        corners = tube_vertices(line[None], radius, sides)[0].reshape(POINTS, sides, 3)
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
