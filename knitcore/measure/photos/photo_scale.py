"""Scale and tilt of a photo, from a printed sheet with four marks or from a coin.

The sheet's marks are concentric: a disc inside a ring, which no fabric has. Their four centres give
the homography from the paper to the photo, and with it the plane of the swatch without any tilt. A
coin gives an ellipse only: it corrects the tilt as far as the photo is a parallel projection, so
little of it is accepted. The tilt is that of the parallel projection at the middle, arccos of the
ratio of the smaller to the larger scale.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy
import skimage

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError

SHEET_MM = (210.0, 297.0)
"""Width and height of the sheet: A4."""
MARKS_MM = ((20.0, 20.0), (190.0, 20.0), (20.0, 277.0), (190.0, 277.0))
"""Centres of the marks, from the left and from the top of the sheet."""
MARK_RADII_MM = (9.0, 6.0, 3.5)
"""Outer radius of the ring, its inner radius, and that of the disc."""
MAX_TILT_DEG = 20.0
"""Largest tilt of a photo with a sheet."""
MAX_COIN_TILT_DEG = 10.0
"""Largest tilt of a photo with a coin."""
COIN_DISTANCE = 5.0
"""Distance of the camera over that of coin and swatch, at least; it bounds the error of a coin."""
MIN_MARK_PX = 24
"""Least diameter of a mark or a coin."""
MIN_DISC_PX = 20
"""Least area of a disc, or of anything else that is looked at."""
_DARKER = 0.82
"""Grey level over that of its surroundings below which a pixel is dark."""
_SURROUNDINGS = 0.12
"""Side of a pixel's surroundings over the long side of the photo."""
_DISC_SHARE = (0.07, 0.28)
"""Area of the disc over that of all inside the ring; 0.15 in print, changed by blur."""


@dataclass(frozen=True, eq=False)
class PhotoScale:
    """The plane of the swatch in a photo.

    Attributes
    ----------
    projection : from mm in the plane (x to the right, y down) to pixels (x, y).
    middle_mm : (2,) the middle of what gives the scale.
    px_per_mm : scale at the middle.
    tilt_deg : of the camera against the plane's normal.
    relative_error : standard deviation of a length over the length, from tilt.
    blur_px : standard deviation of the blur of edges.
    source : "sheet" or "coin".
    """

    projection: skimage.transform.ProjectiveTransform
    middle_mm: Array
    px_per_mm: float
    tilt_deg: float
    relative_error: float
    blur_px: float
    source: str

    def straightened(self, grey: Array, box_mm: tuple[float, float, float, float]) -> Array:
        """The photo as the plane is seen from straight ahead, at ``px_per_mm``.

        Parameters
        ----------
        grey : (rows, columns) grey levels.
        box_mm : left, top, right and bottom.

        Returns
        -------
        (rows, columns), NaN outside the photo.
        """
        left, top, right, bottom = box_mm
        step = 1 / self.px_per_mm
        x, y = np.meshgrid(np.arange(left, right, step), np.arange(top, bottom, step))
        seen = self.projection(np.stack([x.ravel(), y.ravel()], axis=1))
        values = scipy.ndimage.map_coordinates(grey, seen[:, ::-1].T, order=1, cval=np.nan)
        return np.asarray(values.reshape(x.shape))


def sheet_scale(grey: Array, *, name: str = "photo") -> PhotoScale:
    """The scale from the printed sheet; (0, 0) mm is the middle of the upper left mark.

    Raises
    ------
    InputError
        If not just four marks are seen, or the photo is tilted too far.
    """
    centres = _marks(grey)
    if len(centres) != 4:
        raise InputError(
            name,
            f"{len(centres)} of the sheet's four marks can be seen.",
            "Let the swatch hang before the middle of the sheet, with all four marks free and in"
            " the photo, sharp, without glare or shadow on them; or give the diameter of a coin.",
        )
    upper, lower = np.split(centres[np.argsort(centres[:, 1])], 2)
    corners = np.concatenate([pair[np.argsort(pair[:, 0])] for pair in (upper, lower)])
    marks = np.array(MARKS_MM) - MARKS_MM[0]
    scale = _scale(_estimated(marks, corners), marks.mean(axis=0), "sheet")
    _check_tilt(scale, MAX_TILT_DEG, name)
    return _with_blur(scale, grey, marks, MARK_RADII_MM[0])


def coin_scale(grey: Array, diameter_mm: float, *, name: str = "photo") -> PhotoScale:
    """The scale from a coin; (0, 0) mm is its middle.

    Raises
    ------
    InputError
        If not just one coin is seen, or the photo is tilted too far.
    """
    coins = _coins(grey)
    if len(coins) != 1:
        raise InputError(
            name,
            f"{len(coins) or 'no'} round thing{'s' * (len(coins) > 1)} can be seen.",
            "Fix one coin beside the swatch, in its plane, on a plain ground of another brightness,"
            " whole in the photo; or print the sheet of marks.",
        )
    centre, axes, angle = coins[0]
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    matrix = np.eye(3)
    matrix[:2, :2] = turn @ np.diag(axes / diameter_mm) @ turn.T
    matrix[:2, 2] = centre
    scale = _scale(skimage.transform.ProjectiveTransform(matrix), np.zeros(2), "coin")
    _check_tilt(scale, MAX_COIN_TILT_DEG, name)
    return _with_blur(scale, grey, np.zeros((1, 2)), diameter_mm / 2)


def _estimated(plane_mm: Array, seen_px: Array) -> skimage.transform.ProjectiveTransform:
    """The homography of four points."""
    rows = []
    for (x, y), (u, v) in zip(plane_mm, seen_px, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
    unknowns = np.linalg.solve(np.array(rows), seen_px.ravel())
    return skimage.transform.ProjectiveTransform(np.append(unknowns, 1.0).reshape(3, 3))


def _scale(
    projection: skimage.transform.ProjectiveTransform, middle: Array, source: str
) -> PhotoScale:
    steps = np.array([[0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]])
    right, left, down, up = projection(middle + steps)
    larger, smaller = np.linalg.svd(np.stack([right - left, down - up]))[1]
    tilt = math.acos(min(1.0, smaller / larger))
    error = 0.002 if source == "sheet" else math.hypot(0.004, math.sin(tilt) / COIN_DISTANCE)
    per_mm = math.sqrt(larger * smaller)
    return PhotoScale(projection, middle, per_mm, math.degrees(tilt), error, math.nan, source)


def _check_tilt(scale: PhotoScale, most: float, name: str) -> None:
    if scale.tilt_deg > most:
        instead = ", or print the sheet of marks, which corrects 20°" * (scale.source == "coin")
        raise InputError(
            name,
            f"is tilted by {scale.tilt_deg:.0f}°; {most:.0f}° can be corrected.",
            f"Hold the camera level with the middle of the swatch and straight before it{instead}.",
        )


def _with_blur(scale: PhotoScale, grey: Array, centres: Array, radius_mm: float) -> PhotoScale:
    """The scale with the blur of the edges of discs, from their mean radial profile."""
    radii = np.arange(0.83 * radius_mm, 1.5 * radius_mm, 0.25 / scale.px_per_mm)
    angles = np.linspace(0, 2 * np.pi, 120, endpoint=False)
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = centres[:, None, None] + radii[None, :, None, None] * around
    seen = scale.projection(points.reshape(-1, 2))[:, ::-1].T
    levels = scipy.ndimage.map_coordinates(grey, seen, order=1, mode="nearest")
    profile = levels.reshape(len(centres), len(radii), len(angles)).mean(axis=(0, 2))
    ends = profile.min(), profile[-len(radii) // 4 :].mean()
    share = np.maximum.accumulate((profile - ends[0]) / (ends[1] - ends[0]))
    low, high = np.interp([0.1, 0.9], share, radii)
    blur = (high - low) * scale.px_per_mm / 2.563  # of a Gaussian's 10 to 90 % rise
    return replace(scale, blur_px=float(blur))


def _marks(grey: Array) -> Array:
    """(marks, 2) centres x, y of discs inside rings."""
    regions = _regions(_dark(grey))
    discs = [r for r in regions if _is_elliptic(r)]
    centres = []
    for ring in regions:
        height, width = ring.image.shape
        if min(height, width) < MIN_MARK_PX or ring.euler_number > 0:
            continue
        filled = float(ring.area_filled)
        near = 0.12 * math.sqrt(filled)
        for disc in discs:
            apart = math.dist(disc.centroid, ring.centroid)
            if apart < near and _DISC_SHARE[0] < disc.area / filled < _DISC_SHARE[1]:
                rows, columns = np.nonzero(scipy.ndimage.binary_fill_holes(ring.image))
                top, left = ring.bbox[:2]
                centres.append((left + columns.mean(), top + rows.mean()))
    return np.array(centres).reshape(-1, 2)


def _coins(grey: Array) -> list[tuple[Array, Array, float]]:
    """Centre (x, y), axes (px) and angle of the first axis of each large ellipse."""
    coins: list[tuple[Array, Array, float]] = []
    for mask in (_dark(grey), _dark(1.0 - grey)):
        for region in _regions(scipy.ndimage.binary_fill_holes(mask)):
            if min(region.image.shape) < MIN_MARK_PX or not _is_elliptic(region):
                continue
            rows, columns = region.coords.T
            centre = np.array([columns.mean(), rows.mean()])
            values, vectors = np.linalg.eigh(np.cov(np.stack([columns, rows])))
            axes, angle = 4 * np.sqrt(values), math.atan2(vectors[1, 0], vectors[0, 0])
            apart = (math.dist(centre, known) > known_axes[1] for known, known_axes, _ in coins)
            if all(apart):
                coins.append(_edge_of_coin(grey, centre, axes, angle))
    return coins


def _edge_of_coin(
    grey: Array, centre: Array, axes: Array, angle: float
) -> tuple[Array, Array, float]:
    """Centre, axes and angle of the ellipse through the places half-way from coin to ground."""
    shares = np.arange(0.75, 1.25, 0.25 / axes.max())
    angles = np.linspace(0, 2 * np.pi, 180, endpoint=False)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    rays = np.stack([np.cos(angles), np.sin(angles)], axis=1) * axes / 2 @ turn.T
    points = centre + shares[:, None, None] * rays
    levels = scipy.ndimage.map_coordinates(
        grey, np.moveaxis(points[..., ::-1], -1, 0), order=1, mode="nearest"
    )
    quarter = len(shares) // 4
    inside, ground = np.median(levels[:quarter]), np.median(levels[-quarter:], axis=0)
    beyond = (levels - inside) / np.where(np.abs(ground - inside) < 0.02, np.nan, ground - inside)
    crossing = np.argmax(beyond > 0.5, axis=0)
    lower = np.maximum(crossing - 1, 0)
    column = np.arange(len(angles))
    before, after = beyond[lower, column], beyond[crossing, column]
    good = (crossing > 0) & (after > before)
    step = (0.5 - before[good]) / (after - before)[good]
    share = shares[lower[good]] + step * (shares[1] - shares[0])
    edge = centre + share[:, None] * rays[good]
    x, y = ((edge - centre) / axes.max()).T
    a, b, c, d, e = np.linalg.lstsq(
        np.stack([x**2, x * y, y**2, x, y], axis=1), np.ones(len(x)), rcond=None
    )[0]
    form = np.array([[a, b / 2], [b / 2, c]])
    middle = np.linalg.solve(-2 * form, [d, e])
    values, vectors = np.linalg.eigh(form / (1 + middle @ form @ middle))
    return (
        centre + axes.max() * middle,
        axes.max() * 2 / np.sqrt(values),
        math.atan2(vectors[1, 0], vectors[0, 0]),
    )


def _regions(mask: Mask) -> list[Any]:
    """The connected regions of a mask, without specks: noise has hundreds of thousands."""
    labels = skimage.measure.label(mask, connectivity=2)
    is_speck = np.bincount(labels.ravel()) < MIN_DISC_PX
    regions: list[Any] = skimage.measure.regionprops(np.where(is_speck[labels], 0, labels))
    return regions


def _is_elliptic(region: Any) -> bool:
    """Say whether a region fills the ellipse of its moments, and is not slender."""
    shape = region.image.shape
    if min(shape) < 0.7 * max(shape) or region.extent < 0.6:
        return False  # as most of noise, whose moments would take long
    major, minor = float(region.axis_major_length), float(region.axis_minor_length)
    area = math.pi / 4 * major * minor
    return minor > 0.8 * major and abs(float(region.area_filled) / area - 1) < 0.03


def _dark(grey: Array) -> Mask:
    side = max(3, round(_SURROUNDINGS * max(grey.shape)))
    return np.asarray(grey < _DARKER * scipy.ndimage.uniform_filter(grey, side))
