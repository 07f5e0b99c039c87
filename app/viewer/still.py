"""A still of a fabric, drawn by the service itself: what a view shows first, and without WebGL."""

from __future__ import annotations

import dataclasses
import io
import math

import numpy as np
from PIL import Image, ImageDraw

from knitcore.base.arrays import Array
from knitcore.draw.body import Floats
from knitcore.draw.placing import placed_lines
from knitcore.draw.tubes import resampled

from ..drawing.colours import SKIN, linear
from ..drawing.fabric import FabricScene
from .balls import Balls, Picture, drawn, lit, points_along
from .camera import FIELD_OF_VIEW, CameraSide, stand
from .sheet import sheet_picture

FINE = 1_000_000
"""A picture with fewer dots than this is drawn twice as large and reduced, for smooth edges."""


def still_png(scene: FabricScene, width: int, height: int) -> bytes:
    """The face of a fabric as a view of this size frames it, on nothing: a PNG with transparency.

    Parameters
    ----------
    scene : the fabric; its yarn hides what it rests on, or is hidden by it.
    width, height : pixels.
    """
    sheet = sheet_picture(scene)
    picture = _yarn(scene, width, height) if sheet is None else _sheet(scene, sheet, width, height)
    out = io.BytesIO()
    picture.save(out, "PNG", compress_level=1)
    return out.getvalue()


def _sheet(scene: FabricScene, sheet: Picture, width: int, height: int) -> Image.Image:
    """Draw a cloth of many stitches as it looks from afar."""
    eye, half = _Eye.of(scene, width, height), 0.5 * scene.ground.reach_mm
    corners = eye.middle_mm + np.array([[-half[0], half[1], 0.0], [half[0], -half[1], 0.0]])
    (left, top, _), (right, bottom, _) = eye.seen(corners).round().astype(int).tolist()
    size = (max(right - left, 1), max(bottom - top, 1))
    seen = Image.fromarray(sheet, "RGBA").convert("RGBa").resize(size, Image.Resampling.LANCZOS)
    picture = Image.new("RGBA", (width, height))
    picture.paste(seen.convert("RGBA"), (left, top))
    return picture


def _yarn(scene: FabricScene, width: int, height: int) -> Image.Image:
    for fine in (2, 1):
        eye = _Eye.of(scene, width * fine, height * fine)
        balls = _balls(scene, eye)
        if balls.x.size * (2 * balls.radius + 1) ** 2 < FINE:
            break
    picture = Image.fromarray(drawn(balls, _body(scene, eye)), "RGBA")
    return picture.reduce(fine) if fine > 1 else picture


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
    def of(cls, scene: FabricScene, width: int, height: int) -> _Eye:
        place, aim, up = stand(CameraSide.FACE, scene.ground.framed_mm)
        towards = (place - aim) / np.linalg.norm(place - aim)
        right = np.cross(up, towards)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(towards, right), towards], axis=1)
        focal = height / 2 / math.tan(FIELD_OF_VIEW / 2)
        return cls(width, height, np.append(scene.ground.middle_mm, 0.0), place, axes, focal)

    def seen(self, points_mm: Array) -> Array:
        """Points (n, 3), from the left, from the top and towards the eye, pixels."""
        places = points_mm - self.middle_mm
        seen = (places - self.place_mm) @ self.axes
        scale = self.focal / -seen[:, 2]
        x, y = self.width / 2 + scale * seen[:, 0], self.height / 2 - scale * seen[:, 1]
        return np.stack([x, y, scale * places[:, 2]], axis=1)


def _balls(scene: FabricScene, eye: _Eye) -> Balls:
    radius = scene.shapes.yarn_radius_mm * eye.focal / float(np.linalg.norm(eye.place_mm))
    number = points_along(scene, radius / scene.shapes.yarn_radius_mm)
    shapes = dataclasses.replace(scene.shapes, lines=resampled(scene.shapes.lines, number))
    lines = placed_lines(shapes, scene.placement)
    shown = slice(None) if scene.drawn is None else scene.drawn
    lines = lines[shown].reshape(-1, number, 3)
    along = np.gradient(lines, axis=1) @ eye.axes
    seen = eye.seen(lines.reshape(-1, 3)).astype(np.float32).reshape(lines.shape)
    return Balls(
        x=seen[..., 0],
        y=seen[..., 1],
        z=seen[..., 2],
        along=along / np.linalg.norm(along, axis=-1, keepdims=True),
        shape=np.arange(len(lines)),
        radius=radius,
        colours=linear(scene.colours)[shown].reshape(-1, 3),
    )


def _body(scene: FabricScene, eye: _Eye) -> tuple[Floats, Array]:
    """Picture of the body on which the fabric rests.

    Returns
    -------
    Height towards the eye at every pixel, (height, width), -inf outside the body, and the light
    that the body's pixels send, (pixels, 3) of 0 to 1.
    """
    depth = np.full((eye.height, eye.width), -np.inf, np.float32)
    body = scene.body
    if body is None:
        return depth, np.empty((0, 3))
    points_mm = body.sunk_mm(scene.top_mm).astype(float)
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
    return depth, linear(np.array([SKIN], np.uint8)) / 255 * lit(normal)[:, None]


def _twice(at: Array, b: Array, c: Array) -> Array:
    """Twice the area of triangles with their first corner at some places, with its sign."""
    (x, y), (u, v) = (b[:, :2] - at).T, (c[:, :2] - at).T
    return np.asarray(x * v - y * u)
