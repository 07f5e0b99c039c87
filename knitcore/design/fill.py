"""Fill a field: a chart whose local moduli follow a map of wanted ones.

A map that is some chart's own gives that chart back (:mod:`knitcore.design.readback`). Any other
map is filled by patches (:mod:`knitcore.design.patches`): every region gets the repeat of an atlas
whose effective moduli are nearest. Then every patch is shifted or turned over so that it fits its
neighbours, and at last single stitches along the borders are turned where that brings the local
moduli of the quarter-cell composite nearer to the map. The same seed gives the same chart.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from knitcore.chart import StitchChart, check_size
from knitcore.design.atlas import Atlas
from knitcore.design.patches import patches_of, smooth, unevenness, wanted_labels
from knitcore.design.readback import chart_of_local_moduli
from knitcore.errors import CancelledError, InputError
from knitcore.fabric import Direction
from knitcore.materials import Material
from knitcore.mechanics.local import LocalModuli, local_moduli, stitch_table
from knitcore.phases import surroundings

Array = NDArray[np.float64]
Grid = NDArray[np.bool_]

OFF = 0.10
"""Relative deviation above which a stitch counts as off."""
BORDER = 2
"""Stitches on each side of a border that may be turned one by one."""
_SWEEPS = 6


@dataclass(frozen=True)
class Patch:
    """A region of one repeat.

    Attributes
    ----------
    repeat : its key.
    stitches : how many.
    row, column : of its first stitch, from 1 at the bottom left.
    deviation_course, deviation_wale : the repeat's effective modulus over the median of the
        wanted ones, minus one; NaN without a wish.
    """

    repeat: str
    stitches: int
    row: int
    column: int
    deviation_course: float
    deviation_wale: float


@dataclass(frozen=True, eq=False)
class FilledField:
    """A chart for a map.

    Attributes
    ----------
    chart : the stitches.
    patches : number of the patch of every stitch, into ``regions``.
    regions : the patches; none if the map is a chart's own and was read back.
    local : local moduli of the chart.
    off_share : share of the stitches whose local moduli are off by more than 10 % in a wanted
        direction. Inside a repeat that mixes fabrics local moduli alternate, so for such repeats
        look at the deviations of the regions instead.
    messages : what was not reached.
    """

    chart: StitchChart
    patches: NDArray[np.intp]
    regions: tuple[Patch, ...]
    local: LocalModuli
    off_share: float
    messages: tuple[str, ...]


def fill_field(
    modulus_course_n_per_mm: Array,
    modulus_wale_n_per_mm: Array,
    material: Material,
    atlas: Atlas,
    *,
    smallest_patch: int = 4,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> FilledField:
    """A chart for wanted moduli.

    Parameters
    ----------
    modulus_course_n_per_mm, modulus_wale_n_per_mm : (rows, columns), row 0 at the bottom; NaN
        where nothing is wanted.
    material : one yarn for the whole chart.
    atlas : of that material.
    smallest_patch : smallest side of a patch in stitches.
    seed : of the order in which stitches are tried.
    progress : called with the share done.
    cancelled : asked between steps.

    Raises
    ------
    InputError
        If the maps do not fit, wish for nothing, or the atlas is another material's.
    CancelledError
        If it was asked to stop.
    """
    wanted = _checked(modulus_course_n_per_mm, modulus_wale_n_per_mm, smallest_patch)
    if atlas.material != material.identifier:
        raise InputError(
            "atlas", f"it is of {atlas.material}, not of {material.identifier}.", "Build its atlas."
        )
    table = stitch_table(material)
    own = chart_of_local_moduli(wanted, table)
    if own is not None:
        return _read_back(own, material, wanted)
    chosen, cost = wanted_labels(atlas, unevenness(atlas, table), *wanted)
    labels = smooth(cost, smallest_patch)
    patches = patches_of(labels)
    first = np.unique(patches, return_index=True)[1]
    entries = chosen[labels.ravel()[first]].tolist()
    charts = [atlas.chart(entry) for entry in entries]
    work = _Work(material, wanted, progress, cancelled)
    rng = np.random.default_rng(seed)
    purl = np.zeros(labels.shape, dtype=bool)
    for patch, repeat in enumerate(charts):
        purl[patches == patch] = _tiled(repeat, purl)[patches == patch]
    _place(purl, patches, charts, work, rng)
    _turn(purl, patches, work, rng)
    chart = StitchChart(purl)
    local = local_moduli(chart, material)
    regions = _regions(patches, entries, atlas, wanted)
    return FilledField(chart, patches, regions, local, off_share(local, wanted), _messages(regions))


def _read_back(chart: StitchChart, material: Material, wanted: Array) -> FilledField:
    local = local_moduli(chart, material)
    return FilledField(
        chart,
        np.zeros(chart.purl.shape, dtype=np.intp),
        (),
        local,
        off_share(local, wanted),
        ("The map is that of a chart, which was read back stitch by stitch.",),
    )


def off_share(local: LocalModuli, wanted: Array) -> float:
    """Share of stitches off by more than 10 % (``wanted``: logarithms (2, rows, columns))."""
    have = np.log(np.stack([local.modulus_course_n_per_mm, local.modulus_wale_n_per_mm]))
    ratio = np.exp(have - wanted)
    return float((np.abs(ratio - 1) > OFF).any(axis=0).mean())  # NaN compares as not off


class _Work:
    """Costs of charts against the map, by windows."""

    def __init__(
        self,
        material: Material,
        wanted: Array,
        progress: Callable[[float], None] | None,
        cancelled: Callable[[], bool] | None,
    ) -> None:
        table = stitch_table(material)
        have = np.log(np.stack([table.modulus_n_per_mm(d) for d in Direction]))  # (2, 16)
        self._cost = np.nansum((have[:, None, None, :] - wanted[..., None]) ** 2, axis=0)
        self._progress, self._cancelled = progress, cancelled

    def step(self, done: float) -> None:
        """Tell the progress, and stop if asked to."""
        if self._cancelled is not None and self._cancelled():
            raise CancelledError(f"stopped after {done:.0%}")
        if self._progress is not None:
            self._progress(done)

    def around(self, purl: Grid, rows: slice, columns: slice) -> float:
        """Cost of all stitches whose surroundings a change inside the window can alter."""
        (row, far_row), (column, far_column) = (
            _window(s, n) for s, n in zip((rows, columns), purl.shape, strict=True)
        )
        codes = surroundings(StitchChart(purl[far_row, far_column]))[
            row.start - far_row.start : row.stop - far_row.start,
            column.start - far_column.start : column.stop - far_column.start,
        ]
        costs = self._cost[row, column]
        return float(np.take_along_axis(costs, codes[..., None].astype(np.intp), axis=2).sum())


def _window(touched: slice, size: int) -> tuple[slice, slice]:
    """Stitches whose codes change, and those that decide them (an edge borrows from inside)."""
    changed = slice(max(touched.start - 1, 0), min(touched.stop + 1, size))
    return changed, slice(max(changed.start - 2, 0), min(changed.stop + 2, size))


def _place(
    purl: Grid,
    patches: NDArray[np.intp],
    repeats: list[StitchChart],
    work: _Work,
    rng: np.random.Generator,
) -> None:
    """Shift or turn every patch so that it fits its neighbours, until nothing improves."""
    boxes = ndimage.find_objects(patches + 1)
    for sweep in range(_SWEEPS):
        improved = False
        for count, patch in enumerate(rng.permutation(len(repeats)).tolist()):
            work.step(0.5 * (sweep + count / len(repeats)) / _SWEEPS)
            rows, columns = boxes[patch]
            cells = patches == patch
            best = purl[cells]
            least = work.around(purl, rows, columns)
            for image in _images(repeats[patch]):
                purl[cells] = _tiled(image, purl)[cells]
                cost = work.around(purl, rows, columns)
                if cost < least - 1e-12:
                    best, least, improved = purl[cells], cost, True
            purl[cells] = best
        if not improved:
            return


def _tiled(repeat: StitchChart, purl: Grid) -> Grid:
    rows, columns = purl.shape
    return repeat.resized(rows, columns).purl


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


def _turn(purl: Grid, patches: NDArray[np.intp], work: _Work, rng: np.random.Generator) -> None:
    """Turn single stitches, and pairs of neighbours, near borders where that lowers the cost."""
    edge = np.zeros(purl.shape, dtype=bool)
    edge[:, :-1] |= patches[:, :-1] != patches[:, 1:]
    edge[:-1] |= patches[:-1] != patches[1:]
    near = np.argwhere(ndimage.binary_dilation(edge, iterations=BORDER))
    for sweep in range(_SWEEPS):
        improved = False
        for count, (row, column) in enumerate(rng.permutation(near).tolist()):
            if count % 200 == 0:
                work.step(0.5 + 0.5 * (sweep + count / len(near)) / _SWEEPS)
            for height, width in ((1, 1), (1, 2), (2, 1)):
                rows = slice(row, min(row + height, purl.shape[0]))
                columns = slice(column, min(column + width, purl.shape[1]))
                before = work.around(purl, rows, columns)
                purl[rows, columns] ^= True
                if work.around(purl, rows, columns) < before - 1e-12:
                    improved = True
                    break
                purl[rows, columns] ^= True
        if not improved:
            return


def _checked(course: Array, wale: Array, smallest_patch: int) -> Array:
    maps = [np.asarray(course, dtype=float), np.asarray(wale, dtype=float)]
    if maps[0].ndim != 2 or maps[0].shape != maps[1].shape:
        raise InputError("target", "the two maps differ in size.", "Give rows x columns for both.")
    check_size(*maps[0].shape)
    both = np.stack(maps)
    if np.isnan(both).all():
        raise InputError("target", "nothing is wanted anywhere.", "Paint at least one stitch.")
    given = both[~np.isnan(both)]
    if not (np.isfinite(given).all() and (given > 0).all()):
        raise InputError("target", "a wanted modulus is not positive.", "Give N/mm above 0.")
    if not 1 <= smallest_patch <= 100:
        raise InputError("smallest_patch", f"{smallest_patch} is no size.", "Give 1 to 100.")
    logarithms: Array = np.log(both)
    return logarithms


def _regions(
    patches: NDArray[np.intp], entries: list[int], atlas: Atlas, wanted: Array
) -> tuple[Patch, ...]:
    names = ("modulus_course_n_per_mm", "modulus_wale_n_per_mm")
    have = [np.log(atlas.column(name)) for name in names]
    found = []
    for patch, entry in enumerate(entries):
        cells = patches == patch
        row, column = np.argwhere(cells)[0] + 1
        off = []
        for logs, wish in zip(have, wanted, strict=True):
            wishes = wish[cells][~np.isnan(wish[cells])]
            off.append(float(np.expm1(logs[entry] - np.median(wishes))) if len(wishes) else np.nan)
        found.append(
            Patch(atlas.keys[entry], int(cells.sum()), int(row), int(column), off[0], off[1])
        )
    return tuple(found)


def _messages(regions: tuple[Patch, ...]) -> tuple[str, ...]:
    said = []
    for region in regions:
        for direction in ("course", "wale"):
            deviation = getattr(region, f"deviation_{direction}")
            if abs(deviation) > OFF:
                said.append(
                    f"The patch of {region.stitches} stitches from row {region.row}, column "
                    f"{region.column} is {deviation:+.0%} off {direction}-wise: {region.repeat} is "
                    "the nearest in this atlas. Search more repeats, yarns or needles."
                )
    return tuple(said)
