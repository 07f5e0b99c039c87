"""A still of a fabric, drawn by the service itself: what a view shows first, and without WebGL."""

from __future__ import annotations

import dataclasses
import io
import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from app.drawing.colours import linear
from app.drawing.fabric import Drawing
from app.viewer.camera import FIELD_OF_VIEW, CameraSide, stand
from knitcore.arrays import Array
from knitcore.geometry.placing import placed_lines
from knitcore.geometry.tubes import resampled

SPACING = 0.5
"""Of the balls that a yarn is drawn as, over its radius."""
CLOSEST = 1.0
"""Pixels between balls at least."""
FINE = 1_000_000
"""A picture of so few dots is drawn twice as large, and made smaller: its edges are smooth."""
LIGHT = np.array([-70.0, 100.0, 90.0]) / np.linalg.norm([-70.0, 100.0, 90.0])
"""Towards the upper left, as in the view."""
FROM_AROUND, FROM_LIGHT = 0.42, 1.05
"""Light of the sky and of the lamp, over what the yarn throws back of it."""
BURIED = 0.35
"""So much darker is yarn at the back of the fabric."""


def still_png(drawing: Drawing, width: int, height: int) -> bytes:
    """The face of a fabric as a view of this size frames it, on nothing: a PNG with transparency.

    The yarn is drawn as balls along its line, the nearer over the farther ones.

    Parameters
    ----------
    drawing : of a fabric that is drawn whole.
    width, height : pixels.
    """
    for fine in (2, 1):
        balls = _balls(drawing, width * fine, height * fine)
        if len(balls.x) * (2 * balls.radius + 1) ** 2 < FINE:
            break
    picture = Image.fromarray(_drawn(balls, width * fine, height * fine), "RGBA")
    if fine > 1:
        picture = picture.reduce(fine)
    out = io.BytesIO()
    picture.save(out, "PNG", compress_level=1)
    return out.getvalue()


@dataclasses.dataclass(frozen=True, eq=False)
class _Balls:
    """Balls of one radius, the farthest first; places and radius in pixels.

    Attributes
    ----------
    x, y, z : (balls,) from the left, from the top, towards the eye.
    along : (balls, 3) unit vectors along the yarn.
    colours : (balls, 3) uint8, in proportion to light.
    """

    x: Array
    y: Array
    z: Array
    along: Array
    radius: float
    colours: NDArray[np.uint8]


def _balls(drawing: Drawing, width: int, height: int) -> _Balls:
    scene, ground = drawing.part, drawing.ground
    eye, aim, up = stand(CameraSide.FACE, ground.framed_mm)
    towards = (eye - aim) / np.linalg.norm(eye - aim)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    turned = np.stack([right, np.cross(towards, right), towards], axis=1)
    focal = height / 2 / math.tan(FIELD_OF_VIEW / 2)
    radius = scene.shapes.yarn_radius_mm * focal / float(np.linalg.norm(eye - aim))

    steps = np.diff(scene.shapes.lines, axis=1) * [*scene.shapes.lattice.sizes_mm[0, 0], 1.0]
    longest = float(np.linalg.norm(steps, axis=2).sum(axis=1).max())
    spacing = max(SPACING * radius, CLOSEST) * scene.shapes.yarn_radius_mm / radius
    number = min(scene.shapes.lines.shape[1], max(4, math.ceil(longest / spacing)))
    shapes = dataclasses.replace(scene.shapes, lines=resampled(scene.shapes.lines, number))
    lines = placed_lines(shapes, scene.placement)
    along = np.gradient(lines, axis=2) @ turned
    colours = linear(scene.colours)
    if scene.drawn is not None:
        lines, along = lines[scene.drawn], along[scene.drawn]
        colours = colours[scene.drawn]
    places = lines.reshape(-1, 3) - [*ground.middle_mm, 0.0]
    along = along.reshape(-1, 3)
    seen = (places - eye) @ turned
    order = np.argsort(seen[:, 2])
    seen, along = seen[order], along[order]
    scale = focal / -seen[:, 2]
    return _Balls(
        x=width / 2 + scale * seen[:, 0],
        y=height / 2 - scale * seen[:, 1],
        z=scale * places[order, 2],
        along=along / np.linalg.norm(along, axis=1, keepdims=True),
        radius=radius,
        colours=colours.reshape(-1, 3)[order // number],
    )


def _drawn(balls: _Balls, width: int, height: int) -> NDArray[np.uint8]:
    """(height, width, 4) uint8."""
    reach = math.ceil(balls.radius)
    margin = 2 * reach  # balls beyond the edge reach as far beyond it again
    stride = width + 2 * margin
    near = (balls.x > -reach) & (balls.x < width + reach)
    near &= (balls.y > -reach) & (balls.y < height + reach)
    x, y, z = balls.x[near], balls.y[near], balls.z[near].astype(np.float32)
    column, row = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    at = (row + margin) * stride + column + margin
    depth = np.full(stride * (height + 2 * margin), -np.inf, np.float32)
    whose = np.full(depth.shape, -1, np.int32)
    number = np.arange(len(at), dtype=np.int32)
    radius = max(balls.radius, 0.75)
    aside = (column + 0.5 - x).astype(np.float32)
    below = (row + 0.5 - y).astype(np.float32)
    for down in range(-reach, reach + 1):
        for across in range(-reach, reach + 1):
            left = radius**2 - (aside + across) ** 2 - (below + down) ** 2
            hit = np.flatnonzero(left > 0)
            pixel = at[hit] + (down * stride + across)
            top = z[hit] + np.sqrt(left[hit])
            over = top > depth[pixel]
            hit, pixel = hit[over], pixel[over]
            depth[pixel] = top[over]  # of several on one pixel the last counts, the nearest
            whose[pixel] = number[hit]
    inside = (slice(margin, margin + height), slice(margin, margin + width))
    depth = depth.reshape(-1, stride)[inside]
    whose = whose.reshape(-1, stride)[inside]
    shown = whose >= 0
    ball, (rows, columns) = whose[shown], np.nonzero(shown)
    normal = np.stack([columns + 0.5 - x[ball], y[ball] - rows - 0.5, depth[shown] - z[ball]], -1)
    along = balls.along[near][ball]
    normal -= along * np.einsum("ij,ij->i", along, normal)[:, None]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    lit = FROM_AROUND * (0.75 + 0.25 * normal[:, 1])
    lit += FROM_LIGHT * np.clip(normal @ LIGHT, 0.0, None)
    deepest, highest = np.percentile(z, [2, 98])
    lit *= 1 - BURIED * np.clip((highest - z[ball]) / max(highest - deepest, 1e-6), 0.0, 1.0)
    light = balls.colours[near][ball] / 255 * lit[:, None]
    picture = np.zeros((height, width, 4), np.uint8)
    picture[shown, :3] = np.round(255 * np.clip(light, 0.0, 1.0) ** (1 / 2.2))
    picture[shown, 3] = 255
    return picture
