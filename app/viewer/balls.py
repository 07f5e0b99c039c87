"""Yarn as the service draws it: balls along its line, the nearer over the farther ones."""

import dataclasses
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.draw.body import Floats

from ..drawing.fabric import FabricScene

Picture = NDArray[np.uint8]

SPACING = 0.5
"""Distance between the balls that draw a yarn, over its radius."""
CLOSEST = 1.0
"""Least distance between balls, pixels."""
LIGHT = np.array([-70.0, 100.0, 90.0]) / np.linalg.norm([-70.0, 100.0, 90.0])
"""Direction of the light: from the upper left, as in the view."""
FROM_AROUND, FROM_LIGHT = 0.42, 1.05
"""Light of the sky and of the lamp, over what the yarn throws back of it."""
BURIED = 0.35
"""Darkening of yarn at the back of the fabric, 0 to 1."""


@dataclasses.dataclass(frozen=True, eq=False)
class Balls:
    """Balls of one radius along the yarn of stitches; places and radius in pixels.

    Attributes
    ----------
    x, y, z : (stitches, points) from the left, from the top, towards the eye.
    along : (shapes, points, 3) unit vectors along the yarn: to the right, up, towards the eye.
    shape : (stitches,) which of these each stitch has.
    colours : (stitches, 3) uint8, in proportion to light.
    """

    x: NDArray[np.floating[Any]]
    y: NDArray[np.floating[Any]]
    z: NDArray[np.floating[Any]]
    along: Array
    shape: NDArray[np.intp]
    radius: float
    colours: NDArray[np.uint8]


def points_along(scene: FabricScene, scale: float) -> int:
    """Number of balls that draw the yarn of a stitch at so many pixels per mm."""
    shapes = scene.shapes
    steps = np.diff(shapes.lines, axis=1) * [*shapes.lattice.sizes_mm[0, 0], 1.0]
    longest = scale * float(np.linalg.norm(steps, axis=2).sum(axis=1).max())
    spacing = max(SPACING * scale * shapes.yarn_radius_mm, CLOSEST)
    return min(len(shapes.lines[0]), max(4, math.ceil(longest / spacing)))


def lit(normal: Array) -> Array:
    """Light that falls on a surface, from its normals (n, 3) to the right, up, and to the eye."""
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    around = FROM_AROUND * (0.75 + 0.25 * normal[:, 1])
    return np.asarray(around + FROM_LIGHT * np.clip(normal @ LIGHT, 0.0, None))


def drawn(balls: Balls, body: tuple[Floats, Array]) -> NDArray[np.uint8]:
    """A picture of balls and of the body on which they rest, (height, width, 4) uint8.

    Parameters
    ----------
    body : height towards the eye of its surface, (height, width), and its pixels' light.
    """
    behind, skin = body
    height, width = behind.shape
    radius = max(balls.radius, 0.75)
    reach = int(radius + 0.5)  # from the pixel in which the middle lies
    margin = 2 * reach  # balls beyond the edge reach as far beyond it again
    stride = width + 2 * margin
    depth = np.full(stride * (height + 2 * margin), -np.inf, np.float32)
    whose = np.full(depth.shape, -1, np.int32)
    x, y, z = balls.x.ravel(), balls.y.ravel(), balls.z.ravel()
    inside = (x > -reach) & (x < width + reach) & (y > -reach) & (y < height + reach)
    lowest, steps = float(z.min()), 65535 / max(float(np.ptp(z)), 1e-6)
    heights = ((z - lowest) * steps).astype(np.uint16)  # 16 bits are sorted by their digits
    number = np.argsort(heights, kind="stable").astype(np.int32)
    number = number[inside[number]]
    x, y, z = x[number], y[number], z[number]
    column, row = np.floor(x).astype(np.int32), np.floor(y).astype(np.int32)
    at = (row + margin) * stride + column + margin
    aside, below = column + np.float32(0.5) - x, row + np.float32(0.5) - y
    for down in range(-reach, reach + 1):
        for across in range(-reach, reach + 1):
            left = radius**2 - (aside + across) ** 2 - (below + down) ** 2
            hit = np.flatnonzero(left > 0)
            pixel = at[hit] + (down * stride + across)
            top = z[hit] + np.sqrt(left[hit])
            over = top > depth[pixel]
            hit, pixel = hit[over], pixel[over]
            depth[pixel] = top[over]  # of several on one pixel the last counts, the nearest
            whose[pixel] = hit
    middle = (slice(margin, margin + height), slice(margin, margin + width))
    depth, whose = depth.reshape(-1, stride)[middle], whose.reshape(-1, stride)[middle]
    shown = (whose >= 0) & (depth > behind)
    ball, (rows, columns) = whose[shown], np.nonzero(shown)
    stitch, point = np.divmod(number[ball], balls.x.shape[1])
    normal = np.stack([columns + 0.5 - x[ball], y[ball] - rows - 0.5, depth[shown] - z[ball]], -1)
    along = balls.along[balls.shape[stitch], point]
    normal -= along * np.einsum("ij,ij->i", along, normal)[:, None]
    deepest, highest = np.percentile(balls.z, [2, 98])
    buried = np.clip((highest - z[ball]) / max(highest - deepest, 1e-6), 0.0, 1.0)
    light = np.zeros((height, width, 3), np.float32)
    light[np.isfinite(behind)] = skin
    falls = lit(normal) * (1 - BURIED * buried)
    light[shown] = balls.colours[stitch] / np.float32(255) * falls[:, None]
    picture = np.zeros((height, width, 4), np.uint8)
    picture[..., :3] = np.round(255 * np.clip(light, 0.0, 1.0) ** (1 / 2.2))
    picture[..., 3] = 255 * (shown | np.isfinite(behind))
    return picture
