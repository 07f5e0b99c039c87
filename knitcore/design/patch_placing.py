"""Put repeats into patches, and fit the patches to each other stitch by stitch."""

from collections.abc import Callable

import numpy as np
import scipy

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.chart.phases import surroundings
from knitcore.chart.stitch_chart import StitchChart
from knitcore.mechanics.local_moduli import StitchTable, windows_of

Look = Callable[[float], None]

BORDER = 2
"""Stitches on each side of a border that may be turned singly."""
_SWEEPS = 6
_TURNED = ((1, 1), (1, 2), (2, 1))
"""Rows and columns of the pieces that are turned."""
_APART = 4
"""Stitches from one to the next of the pieces that are turned together."""
_ENOUGH = 1e-12


def placed(
    patches: Indices,
    repeats: list[StitchChart],
    target: Array,
    table: StitchTable,
    *,
    kept: StitchChart,
    stitch: Mask,
    scattered: bool,
    seed: int,
    look: Look,
) -> StitchChart:
    """The chart of patches that each hold a repeat, fitted to their neighbours.

    Parameters
    ----------
    patches : (rows, columns) number of each stitch's patch; a number without a repeat means that
        the stitch stays as it is in ``kept``.
    repeats : of each patch.
    target : (2, rows, columns) logarithms of the target moduli, NaN where there is no target.
    table : of the material.
    kept : stitches of the chart where there is no repeat.
    stitch : (rows, columns), where there are stitches.
    scattered : single stitches may be turned at the borders of patches.
    seed : of the order in which patches and stitches are tried.
    look : called from time to time with the share done; may raise to stop.
    """
    rng = np.random.default_rng(seed)
    local = _LocalCost(target, table, stitch)
    purl = kept.purl.copy()
    for patch, repeat in enumerate(repeats):
        purl[patches == patch] = repeat.resized(*purl.shape).purl[patches == patch]
    if patches.max() > 0:
        _shift(purl, patches, repeats, local, rng, look)
        if scattered:
            _turn(purl, patches, patches < len(repeats), local, rng, look)
    return StitchChart(purl)


class _LocalCost:
    """Squared deviations of local moduli from the map, by windows."""

    def __init__(self, target: Array, table: StitchTable, stitch: Mask) -> None:
        self._stitch = stitch
        have = table.log_moduli[:, None, None]
        self._cost = np.nansum((have - target[..., None]) ** 2, axis=0)

    def each(self, purl: Mask) -> Array:
        """Cost of every stitch, (rows, columns)."""
        codes = surroundings(StitchChart(purl), stitch=self._stitch)[..., None]
        return np.take_along_axis(self._cost, codes.astype(np.intp), axis=2)[..., 0]

    def around(self, purl: Mask, rows: slice, columns: slice) -> float:
        """Cost of all stitches whose surroundings a change inside the window can alter."""
        (row, far_row), (column, far_column) = (
            windows_of(s, n) for s, n in zip((rows, columns), purl.shape, strict=True)
        )
        far = far_row, far_column
        codes = surroundings(StitchChart(purl[far]), stitch=self._stitch[far])[
            row.start - far_row.start : row.stop - far_row.start,
            column.start - far_column.start : column.stop - far_column.start,
        ]
        costs = self._cost[row, column]
        return float(np.take_along_axis(costs, codes[..., None].astype(np.intp), axis=2).sum())


def _shift(
    purl: Mask,
    patches: Indices,
    repeats: list[StitchChart],
    local: _LocalCost,
    rng: np.random.Generator,
    look: Look,
) -> None:
    """Shift or turn every patch so that it fits its neighbours, until nothing improves."""
    boxes = scipy.ndimage.find_objects(patches + 1)
    for sweep in range(_SWEEPS):
        improved = False
        for count, patch in enumerate(rng.permutation(len(repeats)).tolist()):
            look(0.5 * (sweep + count / len(repeats)) / _SWEEPS)
            rows, columns = boxes[patch]
            cells = patches == patch
            best = purl[cells]
            least = local.around(purl, rows, columns)
            for image in _images(repeats[patch]):
                purl[cells] = image.resized(*purl.shape).purl[cells]
                cost = local.around(purl, rows, columns)
                if cost < least - _ENOUGH:
                    best, least, improved = purl[cells], cost, True
            purl[cells] = best
        if not improved:
            return


def _turn(
    purl: Mask,
    patches: Indices,
    free: Mask,
    local: _LocalCost,
    rng: np.random.Generator,
    look: Look,
) -> None:
    """Turn single free stitches, and pairs of them, near borders where that lowers the cost."""
    edge = np.zeros(purl.shape, dtype=bool)
    edge[:, :-1] |= patches[:, :-1] != patches[:, 1:]
    edge[:-1] |= patches[:-1] != patches[1:]
    near = scipy.ndimage.binary_dilation(edge, iterations=BORDER) & free
    pieces = {(height, width): _starts(near, free, height, width) for height, width in _TURNED}
    for sweep in range(_SWEEPS):
        improved = False
        for place in rng.permutation(_APART**2).tolist():
            look(0.5 + 0.5 * sweep / _SWEEPS)
            first = divmod(place, _APART)
            for size, starts in pieces.items():
                improved |= _turn_far_apart(purl, starts, first, size, local)
        if not improved:
            return


def _starts(near: Mask, free: Mask, height: int, width: int) -> Mask:
    """Places where a piece of this size begins that may be turned."""
    starts = near.copy()
    for down, across in np.ndindex(height, width):
        starts[: len(free) - down, : free.shape[1] - across] &= free[down:, across:]
        starts[len(free) - down :] = starts[:, free.shape[1] - across :] = False
    return starts


def _turn_far_apart(
    purl: Mask, starts: Mask, first: tuple[int, int], size: tuple[int, int], local: _LocalCost
) -> bool:
    """Turn pieces so far apart that none alters what another one costs, each where that helps."""
    begins = np.zeros_like(starts)
    every = tuple(slice(start, None, _APART) for start in first)
    begins[every] = starts[every]
    if not begins.any():
        return False
    # a piece alters its own stitches and those beside it, which lie in one block
    row, column = (
        (np.arange(side) + _APART + 1 - start) // _APART
        for side, start in zip(purl.shape, first, strict=True)
    )
    block = row[:, None] * (column[-1] + 1) + column
    turned = np.zeros_like(purl)
    for down, across in np.ndindex(*size):
        turned[down:, across:] |= begins[: len(purl) - down, : purl.shape[1] - across]
    less = np.bincount(block.ravel(), (local.each(purl) - local.each(purl ^ turned)).ravel())
    turned &= (less > _ENOUGH)[block]
    purl ^= turned
    return bool(turned.any())


def _images(repeat: StitchChart) -> list[StitchChart]:
    """All shifts of a repeat and of its mirror, with knits and purls as they are and swapped."""
    grids = [repeat.purl, repeat.purl[:, ::-1]]
    images = [
        StitchChart(np.roll(grid, (down, across), axis=(0, 1)) ^ swapped)
        for grid in grids
        for down in range(repeat.rows)
        for across in range(repeat.columns)
        for swapped in (False, True)
    ]
    return list(dict.fromkeys(images))
