"""Relaxed sizes of stitches by their surroundings: textures side by side in one piece.

The relaxed size of a stitch depends on the texture around it. The piece is divided into windows
that overlap by half. Each is a chart of its own, whose learned folding
(:mod:`knitcore.answer.learned`) gives the width and height of its stitches; between the centres of
windows, sizes vary linearly. So a ribbed hem is narrow, the stockinette above it is wide, and the
transition is gradual. Beyond the edges of the piece, the chart is continued as its mirror
image, not as its repeat.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from knitcore.answer.densities import Densities, densities_of
from knitcore.answer.learned import packaged_model
from knitcore.answer.mixture import present
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.fabric import PHASES
from knitcore.materials import Material

WINDOW = 16
"""Rows and columns of a window."""
HALF = WINDOW // 2


def neighbourhood_sizes(chart: StitchChart, material: Material) -> Array:
    """Relaxed width and height of the stitches of a piece, (rows, columns, 2), mm.

    Parameters
    ----------
    chart : the piece, with edges.
    material : a yarn at one setting.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> hem = np.tile([[False, False, True, True]], (20, 10))
    >>> piece = StitchChart(np.vstack([hem, np.zeros((20, 40), dtype=bool)]))
    >>> sizes = neighbourhood_sizes(piece, material("acrylic"))
    >>> bool(sizes[2, 20, 0] < 0.8 * sizes[37, 20, 0])
    True
    """
    return _seen(chart, lambda found: packaged_model().relaxed_mm(found, material))


def sizes_and_folds(chart: StitchChart, material: Material) -> tuple[Array, Array]:
    """Those sizes, and the same over the flat mixture's of the same surroundings, (rows, columns,
    2) each: 1 where a pure fabric is far from others, less where the cloth folds.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """

    def both(found: Densities) -> Array:
        phases = present(found.shares)
        records = [material.record(PHASES[phase]) for phase in phases]
        flat = found.shares[:, phases] @ [(r.stitch_course_mm, r.stitch_wale_mm) for r in records]
        relaxed = packaged_model().relaxed_mm(found, material)
        return np.concatenate([relaxed, relaxed / flat], axis=1)

    seen = _seen(chart, both)
    return seen[..., :2], seen[..., 2:]


def _seen(chart: StitchChart, of: Callable[[Densities], Array]) -> Array:
    """Values of a function of densities (windows, n) at every stitch, (rows, columns, n)."""
    counted = list(product(*(_windows(count) for count in chart.purl.shape)))
    return np.asarray(sum(_interpolated(chart, of, *each) for each in counted) / len(counted))


def _interpolated(
    chart: StitchChart, of: Callable[[Densities], Array], rows: Windows, columns: Windows
) -> Array:
    """The values of windows at these places."""
    around = chart.purl[np.ix_(rows.stitches, columns.stitches)]
    windows = sliding_window_view(around, (WINDOW, WINDOW))[::HALF, ::HALF]
    count, windows = windows.shape[:2], windows.reshape(-1, WINDOW, WINDOW)
    packed = np.packbits(windows.reshape(len(windows), -1), axis=1)
    _, first, same = np.unique(packed, axis=0, return_index=True, return_inverse=True)
    values = of(densities_of(windows[first]))[same].reshape(*count, -1)
    at = np.meshgrid(rows.places, columns.places, indexing="ij")
    layers = np.moveaxis(values, -1, 0)
    return np.stack([map_coordinates(layer, at, order=1) for layer in layers], axis=-1)


class Windows(NamedTuple):
    """Windows along one side of a piece.

    Attributes
    ----------
    stitches : the stitch at each place that the windows reach, mirrored beyond the edges.
    places : of the stitches among the middles of the windows, counted from the first.
    """

    stitches: NDArray[np.int64]
    places: Array


def _windows(count: int) -> Iterator[Windows]:
    """Windows that reach equally far beyond both ends; counted from either if that is not whole."""
    beyond = -count % HALF
    for before in {beyond // 2, beyond - beyond // 2}:
        reach = before + HALF, beyond - before + HALF
        yield Windows(_mirrored(count, *reach), (np.arange(count) + 0.5 + before) / HALF)


def _mirrored(count: int, before: int, after: int) -> NDArray[np.int64]:
    """Places of a row and, before and after it, of its mirror images about the end stitches."""
    places = np.arange(-before, count + after)
    period = max(2 * (count - 1), 1)
    folded = places % period
    return np.minimum(folded, period - folded) if count > 1 else np.zeros_like(places)
