"""Rendered photos of a hanging swatch, of which scale, tilt, blur and strain are known."""

from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.draw.placing import placed_lines, unstretched
from knitcore.draw.stitches import stitch_shapes
from knitcore.draw.tubes import resampled
from knitcore.materials import material
from knitcore.measure.photos.photo_scale import MARK_RADII_MM, MARKS_MM

STITCH_MM = (5.0, 3.6)
TILE = 2
"""Stitches of a tile in each direction: a whole repeat of each pure fabric."""


@dataclass(frozen=True)
class Scene:
    """A swatch before the sheet of marks, or beside a coin, and the camera.

    ``stitch_mm`` width and height of a stitch; ``swatch_mm`` size of the swatch; ``tilt_deg``
    about the vertical and the horizontal axis; ``turn_deg`` of the swatch in its plane;
    ``blur_px``; ``shade`` fall of the light from one side to the other, over the mean;
    ``light`` over the usual; ``irregular`` scatter of stitches, over a stitch; ``noise`` of
    grey levels; ``yarn`` grey level of the yarn.
    """

    stitch_mm: tuple[float, float] = STITCH_MM
    swatch_mm: tuple[float, float] = (110.0, 150.0)
    tilt_deg: tuple[float, float] = (0.0, 0.0)
    turn_deg: float = 0.0
    blur_px: float = 0.7
    shade: float = 0.3
    light: float = 1.0
    irregular: float = 0.04
    noise: float = 0.01
    yarn: float = 0.55
    coin_mm: float | None = None
    marks: bool = True
    texture: bool = True
    px_per_mm: float = 6.0
    seen_mm: tuple[float, float] = (240.0, 330.0)
    distance_mm: float = 700.0
    seed: int = 0
    fabric: Fabric = Fabric.STOCKINETTE

    def pulled(self, along: float, across: float) -> "Scene":
        """The swatch pulled down by a strain, and narrowed."""
        stretch = np.array([1 + across, 1 + along])
        course, wale = (np.array(self.stitch_mm) * stretch).tolist()
        width, height = (np.array(self.swatch_mm) * stretch).tolist()
        return replace(self, stitch_mm=(course, wale), swatch_mm=(width, height))

    @lru_cache(maxsize=6)  # noqa: B019 - scenes are small, and compared by value
    def photo(self) -> Array:
        """Grey levels (rows, columns) between 0 and 1."""
        random = np.random.default_rng(self.seed)
        columns, rows = (round(side * self.px_per_mm) for side in self.seen_mm)
        v, u = np.mgrid[0:rows, 0:columns].astype(float)
        x, y = self._plane(u - columns / 2, v - rows / 2)
        picture = self._drawn(x, y, random)
        fall = 1 + self.shade * (u / columns - 0.5) + 0.5 * self.shade * (v / rows - 0.5)
        seen = gaussian_filter(picture * fall * self.light, self.blur_px)
        seen += self.noise * random.normal(size=seen.shape)
        return np.round(255 * np.clip(seen, 0, 1)) / 255

    def _plane(self, u: Array, v: Array) -> tuple[Array, Array]:
        """Where the rays of pixels about the picture's middle meet the swatch's plane, mm."""
        about_y, about_x = np.radians(self.tilt_deg)
        turn_y = np.array(
            [
                [np.cos(about_y), 0, np.sin(about_y)],
                [0, 1, 0],
                [-np.sin(about_y), 0, np.cos(about_y)],
            ]
        )
        turn_x = np.array(
            [
                [1, 0, 0],
                [0, np.cos(about_x), -np.sin(about_x)],
                [0, np.sin(about_x), np.cos(about_x)],
            ]
        )
        axes = turn_y @ turn_x  # columns: the plane's x, y and normal in the camera's axes
        focal = self.px_per_mm * self.distance_mm
        rays = np.stack([u / focal, v / focal, np.ones_like(u)])
        normal, middle = axes[:, 2], np.array([0, 0, self.distance_mm])
        depth = (normal @ middle) / np.tensordot(normal, rays, 1)
        points = rays * depth - middle[:, None, None]
        return np.tensordot(axes[:, 0], points, 1), np.tensordot(axes[:, 1], points, 1)

    def _drawn(self, x: Array, y: Array, random: np.random.Generator) -> Array:
        """Grey levels of the plane; its middle is that of the sheet."""
        on_paper = (np.abs(x) < 105) & (np.abs(y) < 148.5)
        picture = np.where(on_paper, 0.85, 0.6) if self.marks else np.full(x.shape, 0.7)
        if self.marks:
            for left, top in MARKS_MM:
                away = np.hypot(x - left + 105, y - top + 148.5)
                ink = ((away < MARK_RADII_MM[0]) & (away > MARK_RADII_MM[1])) | (
                    away < MARK_RADII_MM[2]
                )
                picture = np.where(ink, 0.08, picture)
        if self.coin_mm is not None:
            coin = np.hypot(x + 82, y) < self.coin_mm / 2
            picture = np.where(coin, 0.35 + 0.05 * np.sin(2 * x) * np.sin(2.3 * y), picture)
        turn = np.radians(self.turn_deg)
        a, b = x * np.cos(turn) + y * np.sin(turn), -x * np.sin(turn) + y * np.cos(turn)
        inside = (np.abs(a) < self.swatch_mm[0] / 2) & (np.abs(b) < self.swatch_mm[1] / 2)
        if self.texture:
            picture[inside] = self._knitted(a[inside], -b[inside], random)
        return picture

    def _knitted(self, x: Array, y: Array, random: np.random.Generator) -> Array:
        """Grey levels of the fabric's face, its stitches scattered a little."""
        s, t = x / self.stitch_mm[0], y / self.stitch_mm[1]
        t, s = (at + self.irregular * _smooth(random, s, t) for at in (t, s))
        tile = _tile(self.fabric)
        high, wide = np.array(tile.shape) / TILE
        places = np.stack([-t * high, s * wide])
        level = map_coordinates(tile, places, order=1, mode="grid-wrap")
        cell = np.floor(s) * 7919 + np.floor(t) * 104729
        return np.asarray(self.yarn * level * (1 + 0.06 * np.sin(cell)))


@cache
def _tile(fabric: Fabric, px_per_mm: float = 12.0) -> Array:
    """Two by two stitches of acrylic as the product draws them, lit from the upper left."""
    acrylic = material("acrylic")
    chart = StitchChart.of_fabric(fabric, 3 * TILE, 3 * TILE)
    shapes = stitch_shapes(chart, acrylic, folded=False)
    lines = placed_lines(shapes, unstretched(shapes)).reshape(-1, shapes.lines.shape[1], 3)
    course, wale = acrylic.record(fabric).stitch_mm
    shape = round(3 * TILE * wale * px_per_mm), round(3 * TILE * course * px_per_mm)
    height = np.full(shape, -3.0)
    radius = shapes.yarn_radius_mm
    reach = int(radius * px_per_mm)
    down, right = (a.ravel() for a in np.mgrid[-reach : reach + 1, -reach : reach + 1])
    bulge = np.sqrt(np.maximum(radius**2 - (down**2 + right**2) / px_per_mm**2, 0))
    round_ = bulge > 0
    points = resampled(lines, 160).reshape(-1, 3)
    points = points - points.mean(axis=0)
    rows = np.rint(shape[0] / 2 - points[:, 1] * px_per_mm).astype(int)[:, None] + down[round_]
    columns = np.rint(shape[1] / 2 + points[:, 0] * px_per_mm).astype(int)[:, None] + right[round_]
    seen = (rows >= 0) & (rows < shape[0]) & (columns >= 0) & (columns < shape[1])
    top = points[:, 2][:, None] + bulge[round_]
    np.maximum.at(height, (rows[seen], columns[seen]), top[seen])
    slope_y, slope_x = np.gradient(gaussian_filter(height, 1.0), 1 / px_per_mm)
    light = (1 + 0.5 * slope_x + 0.6 * slope_y) / np.sqrt(1 + slope_x**2 + slope_y**2)
    deep = np.clip((height - np.percentile(height, 20)) / np.ptp(height) + 0.4, 0.15, 1)
    a, b = shape[0] // 3, shape[1] // 3
    return np.asarray(np.clip(0.75 * light, 0.1, 1.3) * deep)[a : 2 * a, b : 2 * b]


def _smooth(random: np.random.Generator, s: Array, t: Array) -> Array:
    """A smooth random field over stitches, of unit variance."""
    grid = gaussian_filter(random.normal(size=(160, 160)), 1.0)
    return np.asarray(map_coordinates(grid / grid.std(), [t + 80, s + 80], order=1, mode="wrap"))
