"""Trace the centreline of one yarn in a photo."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy
import skimage
from numpy.typing import NDArray
from PIL import Image, ImageOps, UnidentifiedImageError

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time

MAX_PIXELS = 60_000_000
MAX_BYTES = 100 * 2**20
WORKING_PIXELS = 1400
"""Long side of the image that is traced; a yarn is then 10 to 60 pixels wide."""
MIN_CONTRAST = 0.12
"""Least contrast between the yarn and its background, over full scale."""
MIN_SLENDERNESS = 6.0
"""Length over width below which a bright spot is not a yarn."""
MAX_UNEVENNESS = 0.25
"""Standard deviation over mean of the width along a yarn (0.05 to 0.13 in the paper's photos)."""


@dataclass(frozen=True, eq=False)
class Centreline:
    """A yarn from its clamp to its free end, in pixels of the photo.

    Attributes
    ----------
    x_px : (n,) horizontal distance from the clamp, positive away from it.
    y_px : (n,) distance below the clamp.
    arc_px : (n,) arc length from the clamp, evenly spaced.
    width_px : median width of the yarn.
    tip_in_photo : whether the free end ends inside the photo.
    next_largest : area of the next largest object, over the yarn's.
    """

    x_px: Array
    y_px: Array
    arc_px: Array
    width_px: float
    tip_in_photo: bool
    next_largest: float

    @property
    def length_px(self) -> float:
        """Arc length from the clamp to the free end."""
        return float(self.arc_px[-1])


@in_reading_time
def load_grey(path: Path) -> Array:
    """A photo as grey levels between 0 and 1, upright.

    Raises
    ------
    InputError
        If the file is not an image, or is larger than any camera's.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(str(path), "is not a file.", "Give the path of a photo.")
    if path.stat().st_size > MAX_BYTES:
        raise InputError(path.name, "is larger than 100 MB.", "Give a JPEG or PNG photo.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(path, formats=("JPEG", "PNG", "TIFF", "BMP", "WEBP")) as image:
                if image.width * image.height > MAX_PIXELS:
                    problem = f"has {image.width} x {image.height} pixels."
                    raise InputError(path.name, problem, "Give a photo of up to 60 megapixels.")
                upright = ImageOps.exif_transpose(image).convert("L")
                return np.asarray(upright, dtype=float) / 255.0
    except InputError:
        raise
    except UnidentifiedImageError:
        raise InputError(path.name, "is not an image.", "Give a JPEG or PNG photo.") from None
    except (
        OSError,
        SyntaxError,
        ValueError,
        Image.DecompressionBombError,
        Image.DecompressionBombWarning,
    ) as e:
        raise InputError(
            path.name, f"cannot be read as an image ({e}).", "It may be cut off: copy it again."
        ) from None


def trace_centreline(grey: Array, *, name: str = "photo") -> Centreline:
    """The centreline of the one yarn in a photo.

    The yarn is the region that differs from the border's grey level, without stray fibres; its
    centreline is the longest path of its skeleton, extended to both ends and smoothed over one
    yarn width.

    Parameters
    ----------
    grey : (rows, columns) grey levels between 0 and 1, the yarn lighter or darker than the rest.
    name : for messages.

    Raises
    ------
    InputError
        If no yarn stands out.
    """
    if grey.ndim != 2 or min(grey.shape) < 40:
        raise InputError(
            name, f"is too small ({grey.shape}).", "Give a photo of 40 pixels or more."
        )
    factor = min(1.0, WORKING_PIXELS / max(grey.shape))
    small = skimage.transform.rescale(grey, factor, anti_aliasing=True) if factor < 1 else grey
    mask, next_largest = _yarn_mask(small, name)
    path, width = _ribbon_axis(mask, name)
    if path[0, 0] > path[-1, 0]:
        path = path[::-1]
    path = _smooth(path, width)
    row, column = path[:, 0], path[:, 1]
    away = np.sign(np.mean(column[: max(len(column) // 4, 2)]) - column[0]) or 1.0
    x, y = away * (column - column[0]), row - row[0]
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    end = path[-1]
    edge = 0.5 * width
    inside = edge < end[0] < mask.shape[0] - 1 - edge and 2 < end[1] < mask.shape[1] - 3
    return Centreline(
        x / factor, y / factor, arc / factor, width / factor, bool(inside), next_largest
    )


def _yarn_mask(grey: Array, name: str) -> tuple[Mask, float]:
    """Mask of the yarn, and the next largest area over its own."""
    border = np.concatenate([grey[0], grey[-1], grey[:, 0], grey[:, -1]])
    ground = float(np.median(border))
    low, high = np.percentile(grey, [0.5, 99.5])
    lighter = high - ground >= ground - low
    signal = skimage.filters.gaussian(grey - ground if lighter else ground - grey, sigma=1.0)
    if max(high - ground, ground - low) < MIN_CONTRAST:
        raise _no_yarn(name, "nothing stands out from the background")
    mask: Mask = signal > skimage.filters.threshold_otsu(signal)
    if mask.mean() > 0.6:
        raise _no_yarn(name, f"{mask.mean():.0%} of the photo stands out")
    whole = mask
    mask, _ = _largest(mask, name)
    # Fibres are thinner than half a yarn: opening removes them and leaves the yarn.
    area, length = float(mask.sum()), float(skimage.morphology.skeletonize(mask).sum())
    if length**2 < MIN_SLENDERNESS * area:
        raise _no_yarn(name, "what stands out is a spot, not a yarn")
    radius = max(1.0, 0.3 * area / length)
    _, next_largest = _largest(skimage.morphology.isotropic_opening(whole, radius), name)
    return _largest(skimage.morphology.isotropic_opening(mask, radius), name)[0], next_largest


def _largest(mask: Mask, name: str) -> tuple[Mask, float]:
    """The largest piece alone, and the area of the next one over its own."""
    pieces = skimage.measure.label(mask, connectivity=2)
    areas = np.bincount(pieces.ravel())
    areas[0] = 0  # the background
    if not areas.any():
        raise _no_yarn(name, "nothing stands out from the background")
    largest = int(areas.argmax())
    next_largest = np.delete(areas, largest).max(initial=0)
    return np.asarray(pieces == largest), float(next_largest / areas[largest])


def _no_yarn(name: str, why: str) -> InputError:
    return InputError(
        name,
        f"no yarn was found: {why}.",
        "Photograph one yarn against a plain background of another brightness, level, and crop to"
        " the hanging part with the clamp at one side.",
    )


def _longest_path(mask: Mask) -> tuple[Array, float]:
    """(n, 2) rows and columns of the skeleton's longest shortest path, and the yarn's width."""
    skeleton = skimage.morphology.skeletonize(mask)
    points = np.argwhere(skeleton)
    index = np.full(mask.shape, -1)
    index[tuple(points.T)] = np.arange(len(points))
    first, second, weight = [], [], []
    for step in ((0, 1), (1, 0), (1, 1), (1, -1)):
        shifted = points + step
        inside = np.all((shifted >= 0) & (shifted < mask.shape), axis=1)
        other = index[tuple(shifted[inside].T)]
        linked = other >= 0
        first.append(np.flatnonzero(inside)[linked])
        second.append(other[linked])
        weight.append(np.full(int(linked.sum()), np.hypot(*step)))
    graph = scipy.sparse.csr_array(
        scipy.sparse.coo_array(
            (np.concatenate(weight), (np.concatenate(first), np.concatenate(second))),
            shape=(len(points), len(points)),
        )
    )
    start = _farthest(graph, 0)[0]
    end, before = _farthest(graph, start)
    order = [end]
    while before[order[-1]] >= 0:
        order.append(int(before[order[-1]]))
    path = points[order].astype(float)
    length = float(np.sum(np.hypot(*np.diff(path, axis=0).T))) if len(path) > 1 else 1.0
    return path, float(mask.sum()) / max(length, 1.0)


def _farthest(graph: scipy.sparse.csr_array, start: int) -> tuple[int, NDArray[np.int32]]:
    """The reachable point farthest from a start, and each point's predecessor on the way."""
    distance, before = scipy.sparse.csgraph.dijkstra(
        graph, directed=False, indices=np.array([start]), return_predecessors=True
    )
    along = np.asarray(distance).ravel()
    return int(np.argmax(np.where(np.isfinite(along), along, -1.0))), np.asarray(before).ravel()


def _ribbon_axis(mask: Mask, name: str) -> tuple[Array, float]:
    """The axis of a ribbon from end to end, and its width; refuses other shapes.

    Beyond the photo's border the yarn is continued straight out, so that its axis is as accurate at
    the border as elsewhere. A skeleton forks at a free end: there it is replaced by a straight
    piece.
    """
    # A frame of background lets the skeleton end at the border like anywhere else.
    area, length = float(mask.sum()), float(skimage.morphology.skeletonize(mask).sum())
    if length**2 < MIN_SLENDERNESS * area:
        raise _no_yarn(name, "what stands out is a spot, not a yarn")
    frame = max(4, round(1.5 * area / length))
    wide = np.pad(np.pad(mask, frame, mode="edge"), 1)
    path, width = _longest_path(wide)
    if len(path) < MIN_SLENDERNESS * width:
        raise _no_yarn(name, "what stands out is a spot, not a yarn")
    cut = round(width)
    core = path[cut:-cut]
    radius = scipy.ndimage.distance_transform_edt(wide)[tuple(core.astype(int).T)]
    if radius.std() > MAX_UNEVENNESS * radius.mean():
        raise _no_yarn(name, "what stands out has no even width")
    ends = (_straight_end(core[::-1], wide, width)[::-1], _straight_end(core, wide, width))
    path = np.concatenate([ends[0], core, ends[1]]) - (frame + 1)
    inside = np.all((path >= -0.5) & (path <= np.array(mask.shape) - 0.5), axis=1)
    return path[inside], width


def _straight_end(path: Array, mask: Mask, width: float) -> Array:
    """Points that continue a path along its last tangent while they are in the yarn."""
    reach = min(len(path) - 1, max(3, round(1.5 * width)))
    tangent = path[-1] - path[-1 - reach]
    tangent = tangent / np.hypot(*tangent)
    steps = np.arange(1.0, 2.5 * width + 2.0)[:, None]
    points = path[-1] + steps * tangent
    nearest = np.rint(points).astype(int)
    within = np.all((nearest >= 0) & (nearest < mask.shape), axis=1)
    within[within] = mask[tuple(nearest[within].T)]
    count = len(points) if within.all() else int(np.argmin(within))
    return np.asarray(points[:count])


def _smooth(path: Array, width: float) -> Array:
    """The path, evenly spaced (one pixel), smoothed over one yarn width; its ends stay."""
    smooth = path
    for sigma in (2.0, 0.5 * width):
        step = np.hypot(*np.diff(smooth, axis=0).T)
        arc = np.concatenate([[0.0], np.cumsum(step)])
        even = np.linspace(0.0, arc[-1], max(int(arc[-1]), 20))
        smooth = np.stack([np.interp(even, arc, smooth[:, i]) for i in (0, 1)], axis=1)
        smooth = np.stack([_odd_smooth(smooth[:, i], sigma) for i in (0, 1)], axis=1)
    return smooth


def _odd_smooth(values: Array, sigma: float) -> Array:
    """Gaussian smoothing with point reflection at the ends, which keeps position and slope."""
    pad = min(len(values) - 1, int(4 * sigma) + 1)
    head = 2 * values[0] - values[pad:0:-1]
    tail = 2 * values[-1] - values[-2 : -2 - pad : -1]
    padded = scipy.ndimage.gaussian_filter1d(np.concatenate([head, values, tail]), sigma)
    return np.asarray(padded[pad : pad + len(values)])
