"""Holes of a cloth seen from its face, and whether it lies flat enough to have a size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import Array

_PIXELS = 12
"""Pixels in a radius of the yarn."""
_STEEPEST = 1.0
"""Slope from stitch to stitch, or from row to row, beyond which a cloth counts as folded."""


@dataclass(frozen=True, eq=False)
class Holes:
    """Holes that the yarn of a repeat leaves.

    Attributes
    ----------
    areas_mm2 : area of every hole of the repeat, the largest first.
    share : their part of the cloth.
    """

    areas_mm2: Array
    share: float

    def eyelet_mm2(self, eyelets: int) -> float | None:
        """Mean area of the largest holes, as many as there are eyelets; None without any."""
        areas = self.areas_mm2[:eyelets]
        return float(areas.mean()) if len(areas) else None


def holes(lines: Array, width_mm: float, height_mm: float, radius_mm: float) -> Holes:
    """The holes of a repeat.

    Parameters
    ----------
    lines : (rows, points, 3) centre lines, mm, once across the repeat.
    width_mm, height_mm : of the repeat.
    radius_mm : of the yarn.
    """
    ahead = lines[:, :1] + (width_mm, 0.0, 0.0)
    closed = np.concatenate([lines, ahead], axis=1)[..., :2]
    part = np.arange(4)[:, None, None, None] / 4
    points = ((1 - part) * closed[:, :-1] + part * closed[:, 1:]).reshape(-1, 2)
    size = np.array([width_mm, height_mm])
    points = np.minimum(points % size, np.nextafter(size, 0.0))
    shape = np.ceil(size / radius_mm * _PIXELS).astype(int)
    x, y = ((np.arange(n) + 0.5) / n * whole for n, whole in zip(shape, size, strict=True))
    pixels = np.stack(np.meshgrid(x, y), axis=-1)
    distance, _ = scipy.spatial.cKDTree(points, boxsize=size).query(
        pixels, distance_upper_bound=radius_mm
    )
    is_open = ~np.isfinite(distance)
    pixel_mm2 = float(np.prod(size / shape))
    areas = np.sort(pixel_mm2 * np.bincount(_joined(is_open)))[::-1]
    return Holes(np.asarray(areas, float), float(is_open.mean()))


def _joined(is_open: Array) -> Array:
    """Number the hole that every open pixel belongs to; the repeat goes on over its edges."""
    label, count = scipy.ndimage.label(is_open)
    pairs = [
        np.stack([first, last], axis=-1)[(first > 0) & (last > 0)]
        for first, last in ((label[0], label[-1]), (label[:, 0], label[:, -1]))
    ]
    first, last = np.concatenate(pairs).T - 1
    touching = scipy.sparse.coo_array((np.ones(len(first)), (first, last)), shape=(count, count))
    _, hole = scipy.sparse.csgraph.connected_components(touching, directed=False)
    return np.asarray(hole[label[is_open] - 1])


def is_folded(lines: Array, columns: int, course_mm: float, wale_mm: float) -> bool:
    """Tell whether the rows or columns of a cloth stand rather than lie.

    Parameters
    ----------
    lines : (rows, points, 3) centre lines, mm, once across the repeat.
    columns : stitches of a row.
    course_mm, wale_mm : size of a stitch.
    """
    heights = lines[..., 2].reshape(len(lines), columns, -1).mean(axis=2)
    slopes = [
        np.abs(np.diff(mean, append=mean[:1])).max() / size
        for mean, size in ((heights.mean(axis=0), course_mm), (heights.mean(axis=1), wale_mm))
    ]
    return bool(max(slopes) > _STEEPEST)
