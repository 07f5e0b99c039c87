"""Points of a stretch curve from photos of a swatch that hangs with known weights.

A swatch of clamped width w carries in its middle the weight below, and half its own: a force per
width (m + m_swatch / 2) g / w. The size of its stitches there, over their size at rest, gives the
strain along the pull and across it; far from the clamps the width is free. At rest means a photo
without a weight, or else the gauge.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
import skimage

from knitcore.base.arrays import Array, Mask
from knitcore.base.bounds import check_range
from knitcore.base.errors import InputError
from knitcore.base.gravity import STANDARD_GRAVITY_M_PER_S2
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.measure.photos.photo_scale import MARKS_MM, PhotoScale, coin_scale, sheet_scale
from knitcore.measure.photos.stitch_spacing import StitchSpacing, stitch_spacing
from knitcore.measure.stretch_points import StretchPoint

GRAVITY_N_PER_G = 1e-3 * STANDARD_GRAVITY_M_PER_S2
WORKING_PIXELS = 3000
"""Long side of the photo that is read."""
MAX_BLUR = 0.16
"""Standard deviation of the blur over the smaller extent of a stitch."""
MAX_CLIPPED = 0.25
"""Share of the fabric that may be quite black or quite white."""
MIN_CONTRAST = 0.025
"""Least standard deviation of grey levels within the fabric, over full scale."""
GAUGE_ERROR = 0.02
"""Standard deviation of a counted gauge, over the gauge: half a stitch in 25."""
REST_RANGE = (0.75, 1.33)
"""Size of a stitch in a photo without weight over that of the gauge."""
MAX_STRETCH = 2.6
"""Largest size of a stitch along the pull over that at rest."""
MAX_NARROWING = 0.4
"""Least size across the pull over that at rest."""
MIN_STRAIN = 0.02
"""Least strain of a point; less is lost in its error."""
MIDDLE = 0.5
"""Part of the swatch's extent, about its middle, that is read."""


@dataclass(frozen=True, eq=False)
class SwatchPhoto:
    """A photo with what hung on the swatch.

    Attributes
    ----------
    name : for messages.
    grey : (rows, columns) levels between 0 and 1, upright.
    load_g : mass that hangs on the swatch, with its clamp; 0 without.
    """

    name: str
    grey: Array
    load_g: float


@dataclass(frozen=True)
class Swatch:
    """The swatch by ruler and kitchen scale.

    Attributes
    ----------
    fabric : a pure fabric, its face side seen.
    direction : that of the pull, which is down in the photos.
    stitches_per_10_cm, rows_per_10_cm : the gauge at rest.
    width_mm : width that the clamps hold.
    weight_g : of the whole swatch; 0 if unknown.
    """

    fabric: Fabric
    direction: Direction
    stitches_per_10_cm: float
    rows_per_10_cm: float
    width_mm: float
    weight_g: float = 0.0

    def __post_init__(self) -> None:
        check_range("stitches_per_10_cm", self.stitches_per_10_cm, 3, 300)
        check_range("rows_per_10_cm", self.rows_per_10_cm, 3, 300)
        check_range("width_mm", self.width_mm, 10, 1000, "mm")
        check_range("weight_g", self.weight_g, 0, 1000, "g")

    @property
    def stitch_mm(self) -> tuple[float, float]:
        """Width and height of a stitch, of the gauge."""
        return 100 / self.stitches_per_10_cm, 100 / self.rows_per_10_cm


@dataclass(frozen=True, eq=False)
class PhotoReading:
    """Stitches in a photo, and its scale.

    Attributes
    ----------
    name : of the photo.
    load_g : that hung.
    spacing : size of a stitch at rest or under the load.
    scale : of the photo.
    fabric_mm : width and height of the fabric that was read, as the photo shows it.
    """

    name: str
    load_g: float
    spacing: StitchSpacing
    scale: PhotoScale
    fabric_mm: tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class HangingSwatch(Result):
    """Points of the stretch curve by increasing load, and what each photo shows."""

    points: tuple[StretchPoint, ...]
    photos: tuple[PhotoReading, ...]
    notes: tuple[str, ...]


def read_hanging(
    photos: Sequence[SwatchPhoto], swatch: Swatch, *, coin_mm: float | None = None
) -> HangingSwatch:
    """Points of a stretch curve from photos of one swatch, pulled down.

    Parameters
    ----------
    photos : one to three with a load, and where there is one, that without.
    swatch : gauge, width and weight.
    coin_mm : diameter of the coin beside the swatch; None with the printed sheet.

    Raises
    ------
    InputError
        Naming the photo that cannot serve, the reason and the remedy.
    """
    loads = [photo.load_g for photo in photos]
    if not any(load > 0 for load in loads) or len(set(loads)) < len(loads):
        remedy = "Give one photo without a weight, and one or more with a weight each."
        raise InputError("photos", "there are not different weights on them.", remedy)
    for photo in photos:
        check_range(f"{photo.name}: load_g", photo.load_g, 0, 20_000, "g")
    if coin_mm is not None:
        check_range("coin_mm", coin_mm, 10, 60, "mm")
    ordered = sorted(photos, key=lambda photo: photo.load_g)
    readings = [read_photo(photo, swatch, coin_mm=coin_mm) for photo in ordered]
    notes = []
    if ordered[0].load_g > 0:
        rest, rest_sd = np.array(swatch.stitch_mm), GAUGE_ERROR * np.array(swatch.stitch_mm)
        notes.append(
            "There is no photo without a weight: the size at rest is the gauge's, ± 2 %, which"
            " is most of the error of the strain."
        )
    else:
        rest, rest_sd = _size(readings[0])
        notes += _off_gauge(rest, swatch)
    points = tuple(_point(r, rest, rest_sd, swatch) for r in readings if r.load_g > 0)
    return HangingSwatch(points, tuple(readings), tuple(notes))


@in_reading_time
def read_photo(photo: SwatchPhoto, swatch: Swatch, *, coin_mm: float | None = None) -> PhotoReading:
    """The size of a stitch in one photo.

    Raises
    ------
    InputError
        If the photo cannot serve.
    """
    grey = photo.grey
    if grey.ndim != 2 or min(grey.shape) < 200:
        raise InputError(photo.name, "is too small.", "Give a photo of 1000 pixels or more.")
    factor = WORKING_PIXELS / max(grey.shape)
    small = skimage.transform.rescale(grey, factor, anti_aliasing=True) if factor < 1 else grey
    scale = (
        sheet_scale(small, name=photo.name)
        if coin_mm is None
        else coin_scale(small, coin_mm, name=photo.name)
    )
    expected = _expected(swatch, loaded=photo.load_g > 0)
    smallest = min(low for low, _ in expected)
    _check_blur(scale, min(swatch.stitch_mm), photo.name)
    fabric = _fabric(small, scale, smallest, coin_mm, photo.name)
    _check_exposure(fabric, photo.name)
    # In the photo the pull is down; turned so that rows of the knitting lie along the rows.
    turned = fabric if swatch.direction is Direction.WALE else fabric.T
    spacing = stitch_spacing(turned, scale.px_per_mm, expected, swatch.fabric, name=photo.name)
    height, width = fabric.shape
    size = (width / scale.px_per_mm, height / scale.px_per_mm)
    return PhotoReading(photo.name, photo.load_g, spacing, scale, size)


def _expected(swatch: Swatch, *, loaded: bool) -> tuple[tuple[float, float], tuple[float, float]]:
    """Least and largest width of a stitch, and the same of its height."""
    if not loaded:
        course, wale = ((REST_RANGE[0] * s, REST_RANGE[1] * s) for s in swatch.stitch_mm)
        return course, wale
    stretched, narrowed = (0.9, MAX_STRETCH), (MAX_NARROWING, 1.15)
    ranges = swatch.direction.of((stretched, narrowed), (narrowed, stretched))
    course, wale = (
        (low * size, high * size)
        for (low, high), size in zip(ranges, swatch.stitch_mm, strict=True)
    )
    return course, wale


def _check_blur(scale: PhotoScale, stitch_mm: float, name: str) -> None:
    most = MAX_BLUR * stitch_mm * scale.px_per_mm
    if scale.blur_px > most:
        raise InputError(
            name,
            f"is blurred by {scale.blur_px:.1f} pixels; {most:.1f} can be read.",
            "Focus on the swatch, hold the camera still, and give more light.",
        )


def _check_exposure(fabric: Array, name: str) -> None:
    clipped = float(np.mean((fabric > 0.99) | (fabric < 0.01)))
    if clipped > MAX_CLIPPED:
        remedy = "Tap on the swatch to expose for it, and keep direct sun and the flash off it."
        raise InputError(name, f"{clipped:.0%} of the fabric is quite black or white.", remedy)
    if float(fabric.std()) < MIN_CONTRAST:
        remedy = "Light it from one side, so that each stitch has a shadow."
        raise InputError(name, "the fabric has no contrast.", remedy)


def _fabric(
    grey: Array, scale: PhotoScale, stitch_mm: float, coin_mm: float | None, name: str
) -> Array:
    """The middle of the fabric, straightened: where grey levels vary within a stitch."""
    box = _searched(grey, scale)
    plane = scale.straightened(grey, box)
    if coin_mm is not None:
        _cover_coin(plane, box, coin_mm, scale.px_per_mm)
    outside = np.isnan(plane)
    filled = np.where(outside, np.nanmedian(plane), plane)
    side = max(3, round(2 * stitch_mm * scale.px_per_mm))
    varies = (
        scipy.ndimage.uniform_filter(filled**2, side)
        - scipy.ndimage.uniform_filter(filled, side) ** 2
    )
    rough = np.log(np.maximum(varies, MIN_CONTRAST**2))
    mask: Mask = (rough > skimage.filters.threshold_otsu(rough)) & ~outside
    mask = scipy.ndimage.binary_opening(
        scipy.ndimage.binary_fill_holes(mask),
        np.ones((3, 3), dtype=bool),
        iterations=max(1, side // 2),
    )
    regions = skimage.measure.regionprops(skimage.measure.label(mask))
    region = max(regions, key=lambda r: r.area, default=None)
    rows = np.zeros(0) if region is None else region.image.sum(axis=1)
    if region is None or region.extent < 0.4:
        raise InputError(
            name,
            "no swatch stands out from the ground.",
            "Let the swatch hang flat before a plain ground, such as the printed sheet.",
        )
    top, left, bottom, _ = region.bbox
    half = (1 - MIDDLE) / 2
    first, last = (round(share * len(rows)) for share in (half, 1 - half))
    middle = region.image[first:last]
    starts = np.argmax(middle, axis=1)
    ends = middle.shape[1] - np.argmax(middle[:, ::-1], axis=1)
    low, high = float(np.percentile(starts, 90)), float(np.percentile(ends, 10))
    rim = max(0.08 * (high - low), 0.75 * side)
    columns = slice(left + math.ceil(low + rim), left + math.floor(high - rim))
    part = filled[top + first : min(top + last, bottom), columns]
    if min(part.shape) < 20:
        remedy = "Knit a swatch of 20 stitches and 30 rows or more, and go closer."
        raise InputError(name, "too little flat fabric can be seen.", remedy)
    return np.asarray(part)


def _searched(grey: Array, scale: PhotoScale) -> tuple[float, float, float, float]:
    """The part of the plane in which the swatch is sought: left, top, right and bottom, mm."""
    if scale.source == "sheet":
        width, height = np.array(MARKS_MM[-1]) - MARKS_MM[0]
        return 12.0, -8.0, float(width) - 12.0, float(height) + 8.0
    rows, columns = grey.shape
    corners = np.array([[0, 0], [columns, 0], [0, rows], [columns, rows]], dtype=float)
    plane = scale.projection.inverse(corners)
    left, top = plane.min(axis=0).tolist()
    right, bottom = plane.max(axis=0).tolist()
    return left, top, right, bottom


def _cover_coin(
    plane: Array, box: tuple[float, float, float, float], coin_mm: float, px_per_mm: float
) -> None:
    """Blank the coin, whose relief is texture, too."""
    rows, columns = np.indices(plane.shape)
    x, y = box[0] + columns / px_per_mm, box[1] + rows / px_per_mm
    reach = 0.65 * coin_mm
    ring = (np.hypot(x, y) < 1.2 * reach) & (np.hypot(x, y) >= reach)
    plane[np.hypot(x, y) < reach] = np.nanmedian(plane[ring])


def _size(reading: PhotoReading) -> tuple[Array, Array]:
    """Width and height of a stitch, and their standard deviations; the scale's tilt is in both."""
    s = reading.spacing
    size, own = np.array([s.course_mm, s.wale_mm]), np.array([s.course_sd_mm, s.wale_sd_mm])
    return size, np.hypot(own, reading.scale.relative_error * size)


def _point(reading: PhotoReading, rest: Array, rest_sd: Array, swatch: Swatch) -> StretchPoint:
    size, size_sd = _size(reading)
    stretch = size / rest
    stretch_sd = stretch * np.hypot(size_sd / size, rest_sd / rest)
    along, across = swatch.direction.axis, swatch.direction.other.axis
    if stretch[along] - 1 < MIN_STRAIN:
        raise InputError(
            reading.name,
            f"{reading.load_g:g} g stretch the swatch by {max(stretch[along] - 1, 0):.1%} only.",
            "Hang a larger weight on it, such as a full bottle of water.",
        )
    carried = (reading.load_g + swatch.weight_g / 2) * GRAVITY_N_PER_G
    return StretchPoint(
        swatch.fabric,
        swatch.direction,
        carried / swatch.width_mm,
        float(stretch[along] - 1),
        float(stretch_sd[along]),
        float(stretch[across] - 1),
        float(stretch_sd[across]),
    )


def _off_gauge(rest: Array, swatch: Swatch) -> list[str]:
    off = rest / np.array(swatch.stitch_mm) - 1
    if np.abs(off).max() < 0.06:
        return []
    return [
        f"Stitches in the photo without weight are {off[0]:+.0%} wide and {off[1]:+.0%} high"
        " against the gauge: count it again on the swatch as it hangs. The strains rest on the"
        " photo."
    ]
