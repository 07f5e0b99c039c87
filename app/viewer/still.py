"""A still of a fabric, drawn by the service itself: what a view shows first, and without WebGL."""

from __future__ import annotations

import dataclasses
import io
import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from knitcore.base.arrays import Array
from knitcore.draw.body import Floats
from knitcore.draw.placing import placed_lines
from knitcore.draw.tubes import resampled

from ..drawing.colours import SKIN, linear
from ..drawing.fabric import Drawing
from .camera import FIELD_OF_VIEW, CameraSide, stand

SPACING = 0.5
"""Distance between the balls that draw a yarn, over its radius."""
CLOSEST = 1.0
"""Least distance between balls, pixels."""
FINE = 1_000_000
"""A picture with fewer dots than this is drawn twice as large and reduced, for smooth edges."""
LIGHT = np.array([-70.0, 100.0, 90.0]) / np.linalg.norm([-70.0, 100.0, 90.0])
"""Direction of the light: from the upper left, as in the view."""
FROM_AROUND, FROM_LIGHT = 0.42, 1.05
"""Light of the sky and of the lamp, over what the yarn throws back of it."""
BURIED = 0.35
"""Darkening of yarn at the back of the fabric, 0 to 1."""


def still_png(drawing: Drawing, width: int, height: int) -> bytes:
    """The face of a fabric as a view of this size frames it, on nothing: a PNG with transparency.

    The yarn is drawn as balls along its line, the nearer over the farther ones, and hides what the
    fabric rests on, or is hidden by it.

    Parameters
    ----------
    drawing : of a fabric that is drawn whole.
    width, height : pixels.
    """
    for fine in (2, 1):
        eye = _Eye.of(drawing, width * fine, height * fine)
        balls = _balls(drawing, eye)
        if len(balls.x) * (2 * balls.radius + 1) ** 2 < FINE:
            break
    picture = Image.fromarray(_drawn(balls, _body(drawing, eye), eye), "RGBA")
    if fine > 1:
        picture = picture.reduce(fine)
    out = io.BytesIO()
    picture.save(out, "PNG", compress_level=1)
    return out.getvalue()


@dataclasses.dataclass(frozen=True, eq=False)
class _Eye:
    """The place from which the picture is taken.

    Attributes
    ----------
    width, height : of the picture, pixels.
    middle_mm, place_mm : (3,) the scene's origin, and the eye from there.
    axes : (3, 3) the directions to the right, up and towards the eye, as columns.
    focal : pixels.
    """

    width: int
    height: int
    middle_mm: Array
    place_mm: Array
    axes: Array
    focal: float

    @classmethod
    def of(cls, drawing: Drawing, width: int, height: int) -> _Eye:
        place, aim, up = stand(CameraSide.FACE, drawing.ground.framed_mm)
        towards = (place - aim) / np.linalg.norm(place - aim)
        right = np.cross(up, towards)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(towards, right), towards], axis=1)
        focal = height / 2 / math.tan(FIELD_OF_VIEW / 2)
        return cls(width, height, np.append(drawing.ground.middle_mm, 0.0), place, axes, focal)

    def seen(self, points_mm: Array) -> Array:
        """Points (n, 3), from the left, from the top and towards the eye, pixels."""
        places = points_mm - self.middle_mm
        seen = (places - self.place_mm) @ self.axes
        scale = self.focal / -seen[:, 2]
        x, y = self.width / 2 + scale * seen[:, 0], self.height / 2 - scale * seen[:, 1]
        return np.stack([x, y, scale * places[:, 2]], axis=1)


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


def _balls(drawing: Drawing, eye: _Eye) -> _Balls:
    scene = drawing.part
    radius = scene.shapes.yarn_radius_mm * eye.focal / float(np.linalg.norm(eye.place_mm))

    steps = np.diff(scene.shapes.lines, axis=1) * [*scene.shapes.lattice.sizes_mm[0, 0], 1.0]
    longest = float(np.linalg.norm(steps, axis=2).sum(axis=1).max())
    spacing = max(SPACING * radius, CLOSEST) * scene.shapes.yarn_radius_mm / radius
    number = min(scene.shapes.lines.shape[1], max(4, math.ceil(longest / spacing)))
    shapes = dataclasses.replace(scene.shapes, lines=resampled(scene.shapes.lines, number))
    lines = placed_lines(shapes, scene.placement)
    along = np.gradient(lines, axis=2) @ eye.axes
    colours = linear(scene.colours)
    if scene.drawn is not None:
        lines, along = lines[scene.drawn], along[scene.drawn]
        colours = colours[scene.drawn]
    along = along.reshape(-1, 3)
    seen = eye.seen(lines.reshape(-1, 3))
    order = np.argsort(seen[:, 2])
    x, y, z = seen[order].T
    along = along[order]
    return _Balls(
        x=x,
        y=y,
        z=z,
        along=along / np.linalg.norm(along, axis=1, keepdims=True),
        radius=radius,
        colours=colours.reshape(-1, 3)[order // number],
    )


def _body(drawing: Drawing, eye: _Eye) -> tuple[Floats, Array]:
    """Picture of the body on which the fabric rests.

    Returns
    -------
    Height towards the eye at every pixel, (height, width), -inf outside the body, and the light
    that the body's pixels send, (pixels, 3) of 0 to 1.
    """
    depth = np.full((eye.height, eye.width), -np.inf, np.float32)
    body = drawing.part.body
    if body is None:
        return depth, np.empty((0, 3))
    points_mm = body.sunk_mm(drawing.part.top_mm).astype(float)
    seen = eye.seen(points_mm)
    triangles = seen[body.faces]
    facing = np.cross(*(points_mm[body.faces[:, k]] - points_mm[body.faces[:, 0]] for k in (1, 2)))
    facing *= np.sign(np.einsum("ij,ij->", facing, points_mm[body.faces[:, 0]]))  # outwards
    normals = np.zeros_like(points_mm)
    for corner in range(3):
        np.add.at(normals, body.faces[:, corner], facing)
    towards = eye.middle_mm + eye.place_mm - points_mm[body.faces[:, 0]]
    in_front = np.einsum("ij,ij->i", facing, towards) > 0
    pen = ImageDraw.Draw(whose := Image.new("I", (eye.width, eye.height), -1))
    for number in np.lexsort((triangles[..., 2].mean(axis=1), in_front)).tolist():
        pen.polygon(triangles[number, :, :2].ravel().tolist(), fill=number)
    numbers = np.asarray(whose)
    rows, columns = np.nonzero(numbers >= 0)
    shown = numbers[rows, columns]
    a, b, c = triangles[shown].transpose(1, 0, 2)
    at = np.stack([columns + 0.5, rows + 0.5], axis=1)
    shares = np.stack([_twice(at, b, c), _twice(at, c, a), _twice(at, a, b)], axis=1)
    whole = shares.sum(axis=1, keepdims=True)  # 0 for a triangle on edge
    shares = np.clip(np.where(whole, shares / np.where(whole, whole, 1.0), 1 / 3), 0.0, 1.0)
    shares /= shares.sum(axis=1, keepdims=True)
    corners = body.faces[shown]
    depth[rows, columns] = np.einsum("ij,ij->i", shares, seen[corners, 2])
    normal = np.einsum("ij,ijk->ik", shares, normals[corners]) @ eye.axes
    normal *= np.where(in_front[shown], 1.0, -1.0)[:, None]  # both sides are lit
    return depth, linear(np.array([SKIN], np.uint8)) / 255 * _lit(normal)[:, None]


def _twice(at: Array, b: Array, c: Array) -> Array:
    """Twice the area of triangles with their first corner at some places, with its sign."""
    (x, y), (u, v) = (b[:, :2] - at).T, (c[:, :2] - at).T
    return np.asarray(x * v - y * u)


def _lit(normal: Array) -> Array:
    """Light that falls on a surface, from its normals (n, 3) to the right, up, and to the eye."""
    normal = normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    lit = FROM_AROUND * (0.75 + 0.25 * normal[:, 1])
    return np.asarray(lit + FROM_LIGHT * np.clip(normal @ LIGHT, 0.0, None))


def _drawn(balls: _Balls, body: tuple[Floats, Array], eye: _Eye) -> NDArray[np.uint8]:
    """(height, width, 4) uint8."""
    width, height = eye.width, eye.height
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
    behind, skin = body
    shown = (whose >= 0) & (depth > behind)
    ball, (rows, columns) = whose[shown], np.nonzero(shown)
    normal = np.stack([columns + 0.5 - x[ball], y[ball] - rows - 0.5, depth[shown] - z[ball]], -1)
    along = balls.along[near][ball]
    normal -= along * np.einsum("ij,ij->i", along, normal)[:, None]
    lit = _lit(normal)
    deepest, highest = np.percentile(z, [2, 98])
    lit *= 1 - BURIED * np.clip((highest - z[ball]) / max(highest - deepest, 1e-6), 0.0, 1.0)
    light = np.zeros((height, width, 3))
    light[np.isfinite(behind)] = skin
    light[shown] = balls.colours[near][ball] / 255 * lit[:, None]
    picture = np.zeros((height, width, 4), np.uint8)
    picture[..., :3] = np.round(255 * np.clip(light, 0.0, 1.0) ** (1 / 2.2))
    picture[..., 3] = 255 * (shown | np.isfinite(behind))
    return picture
