"""Relaxed sizes of stitches by their surroundings: textures side by side in one piece.

The relaxed size of a stitch depends on the texture around it. The piece is divided into windows
that overlap by half. Each is a chart of its own, whose learned folding
(:mod:`knitcore.prediction.learned`) gives the width and height of its stitches; between the centres
of windows, sizes vary linearly. So a ribbed hem is narrow, the stockinette above it is wide, and
the transition is gradual. Beyond the edges of the piece, the chart is continued as its mirror
image, not as its repeat.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Mask
from knitcore.chart.fabric import PHASES
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import Material, Origin
from knitcore.prediction.densities import densities_of
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.mixture import present, pure_numbers
from knitcore.prediction.size import RelaxedSize

WINDOW = 16
"""Rows and columns of a window."""
HALF = WINDOW // 2
MOST_KNOWN = 10_000
"""Windows of a material whose values are kept, about 2 MB."""


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
    return sizes_and_folds(chart, material)[0]


def counted_over_computed(
    chart: StitchChart, material: Material, size: RelaxedSize | None, stitches: Mask | None = None
) -> Array:
    """How much wider and higher the stitches of a piece are than computed, (2,).

    Parameters
    ----------
    chart : continued where the piece has no stitch.
    size : relaxed size of the piece's mean stitch; both are 1 if it is not known.
    stitches : (rows, columns) False where the piece has none.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    return np.ones(2) if size is None else size.over(neighbourhood_sizes(chart, material), stitches)


def sizes_and_folds(chart: StitchChart, material: Material) -> tuple[Array, Array]:
    """Width and height of every stitch at rest, and their ratios to the flat mixture's.

    Both are (rows, columns, 2). The flat mixture has the same surroundings; a ratio is 1 where a
    pure fabric is far from others, and less where the cloth folds.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    known = _of_yarn(_numbers(material))
    counted = list(product(*(_windows(count) for count in chart.purl.shape)))
    sums = sum(_interpolated(chart, material, known, *each) for each in counted)
    values = np.asarray(sums) / len(counted)
    return values[..., :2], values[..., 2:]


def _numbers(material: Material) -> bytes:
    """All of a material that decides the sizes of windows."""
    fabrics = [fabric for fabric in PHASES if fabric in material.fabrics]
    records = [material.record(fabric) for fabric in fabrics]
    sizes = [(r.fabric.phase, *r.stitch_mm, r.origin is Origin.SIMULATED) for r in records]
    yarn = pure_numbers(material, np.array([fabric.phase for fabric in fabrics]))
    return np.append(sizes, yarn).tobytes()


@lru_cache(maxsize=16)
def _of_yarn(numbers: bytes) -> dict[bytes, Array]:
    """Values of windows in a material: a stroke changes a few windows of a piece."""
    return {}


def _interpolated(
    chart: StitchChart,
    material: Material,
    known: dict[bytes, Array],
    rows: Windows,
    columns: Windows,
) -> Array:
    """The values of windows at these places, (rows, columns, 4)."""
    around = chart.purl[np.ix_(rows.stitches, columns.stitches)]
    windows = sliding_window_view(around, (WINDOW, WINDOW))[::HALF, ::HALF]
    count, windows = windows.shape[:2], windows.reshape(-1, WINDOW, WINDOW)
    keys = [packed.tobytes() for packed in np.packbits(windows.reshape(len(windows), -1), axis=1)]
    here = {key: value for key in keys if (value := known.get(key)) is not None}
    new = {key: window for key, window in zip(keys, windows, strict=True) if key not in here}
    if new:
        values = _sizes_and_folds(np.array(list(new.values())), material)
        here.update(zip(new, values, strict=True))
        if len(known) > MOST_KNOWN:
            known.clear()
        known.update(here)
    values = np.array([here[key] for key in keys]).reshape(*count, -1)
    return _between(_between(values, rows.places), columns.places, axis=1)


def _between(values: Array, places: Array, axis: int = 0) -> Array:
    """Values at places between those along an axis, linearly."""
    before = places.astype(int)
    weight = np.expand_dims(places - before, tuple(range(1, values.ndim - axis)))
    low, high = (values.take(at, axis) for at in (before, before + 1))
    return low + weight * (high - low)


def _sizes_and_folds(windows: Mask, material: Material) -> Array:
    """Relaxed size in mm, and over that of the flat mixture, (windows, 4)."""
    composition = densities_of(windows)
    phases = present(composition.shares)
    flat = composition.shares[:, phases] @ [material.record(PHASES[k]).stitch_mm for k in phases]
    relaxed = packaged_model().relaxed_mm(composition, material)
    return np.concatenate([relaxed, relaxed / flat], axis=1)


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
