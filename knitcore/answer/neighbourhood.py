"""Relaxed sizes of stitches by their surroundings: textures side by side in one piece.

The relaxed size of a stitch depends on the texture around it. The piece is divided into windows
that overlap by half. Each is a chart of its own, whose learned folding
(:mod:`knitcore.answer.learned`) gives the width and height of its stitches; between the centres of
windows, sizes vary linearly. So a ribbed hem is narrow, the stockinette above it wide, and one
passes gradually into the other. Beyond the edges of the piece, the chart is continued as its mirror
image, not as its repeat.
"""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from knitcore.answer.densities import densities_of
from knitcore.answer.learned import packaged_model
from knitcore.chart import StitchChart
from knitcore.materials import Material

Array = NDArray[np.float64]

WINDOW = 16
"""Rows and columns of a window."""


def neighbourhood_sizes(chart: StitchChart, material: Material) -> Array:
    """Relaxed width and height of the stitches of a piece, (rows, columns, 2), mm.

    Parameters
    ----------
    chart : the piece, with edges.
    material : one yarn on one setting.

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
    half = WINDOW // 2
    rows, columns = chart.purl.shape
    # the last window is whole, so that every stitch lies between middles
    frame = [(half, half + (-n) % half) for n in (rows, columns)]
    up, right = (_mirrored(n, *ends) for n, ends in zip((rows, columns), frame, strict=True))
    around = chart.purl[np.ix_(up, right)]
    windows = sliding_window_view(around, (WINDOW, WINDOW))[::half, ::half]
    count = windows.shape[:2]
    found = densities_of(windows.reshape(-1, WINDOW, WINDOW))
    sizes = packaged_model().relaxed_mm(found, material).reshape(*count, 2)
    middle = np.meshgrid(
        (np.arange(rows) + 0.5) / half, (np.arange(columns) + 0.5) / half, indexing="ij"
    )
    return np.stack([map_coordinates(sizes[..., k], middle, order=1) for k in range(2)], axis=-1)


def _mirrored(count: int, before: int, after: int) -> NDArray[np.int64]:
    """Places of a row and, before and after it, of its mirror images about the end stitches."""
    places = np.arange(-before, count + after)
    period = max(2 * (count - 1), 1)
    folded = places % period
    return np.minimum(folded, period - folded) if count > 1 else np.zeros_like(places)
