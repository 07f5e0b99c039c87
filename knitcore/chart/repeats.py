"""All K/P repeats of a size, one of each kind.

Repeats that differ by a translation, by a mirror (left to right) or by turning the cloth over are
the same fabric. Upside down it is another one, because loops point upwards. A repeat is primitive
if no smaller rectangle tiles it.
"""

from collections.abc import Iterator
from functools import lru_cache
from itertools import combinations
from math import prod

import numpy as np

from knitcore.base.arrays import Indices
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.chart.patterns import PATTERNS, rib, welt
from knitcore.chart.stitch_chart import StitchChart

LARGEST = 16
"""Stitches of the largest repeats that are enumerated: 2^16 charts."""


@lru_cache(maxsize=64)
def primitive_repeats(rows: int, columns: int) -> tuple[StitchChart, ...]:
    """One chart of each primitive repeat of exactly this size.

    Raises
    ------
    InputError
        If there are more than 16 stitches.

    Examples
    --------
    >>> [chart.text for chart in primitive_repeats(1, 3)]
    ['KKP']
    """
    stitches = rows * columns
    if rows < 1 or columns < 1 or stitches > LARGEST:
        problem = f"{columns}x{rows} stitches cannot be enumerated."
        raise InputError("repeat", problem, f"Use at most {LARGEST} stitches, such as 4x4.")
    codes = np.arange(2**stitches)
    weights = 1 << np.arange(stitches)[::-1]  # the order of codes is that of StitchChart.canonical
    bits = (codes[:, None] & weights) > 0
    smallest = codes.copy()
    primitive = np.ones(len(codes), dtype=bool)
    for order, shift in _symmetries(rows, columns):
        image = bits[:, order] @ weights
        if shift is not None:
            primitive &= image != codes
        np.minimum(smallest, image, out=smallest)
        np.minimum(smallest, 2**stitches - 1 - image, out=smallest)
    chosen = codes[primitive & (smallest == codes)]
    grids = bits[chosen].reshape(-1, rows, columns)
    return tuple(StitchChart(grid) for grid in grids)


def repeats_up_to(rows: int, columns: int, *, stitches: int = LARGEST) -> tuple[StitchChart, ...]:
    """All primitive repeats up to these numbers of rows, columns and stitches, small ones first.

    Examples
    --------
    >>> len(repeats_up_to(3, 3))
    36
    """
    sizes = [(r, c) for r in range(1, rows + 1) for c in range(1, columns + 1)]
    small = sorted((size for size in sizes if prod(size) <= stitches), key=prod)
    return tuple(chart for size in small for chart in primitive_repeats(*size))


def known_larger_repeats() -> tuple[StitchChart, ...]:
    """List larger repeats: ribs, welts and baskets up to 8 stitches a side, and named patterns."""
    sides = [(a, b) for a in range(1, 8) for b in range(1, a + 1) if 4 < a + b <= 8]
    charts = [*(rib(a, b) for a, b in sides), *(welt(a, b) for a, b in sides)]
    checks = [(a, b) for a in range(1, 5) for b in range(1, 5) if max(a, b) > 2]
    charts += [StitchChart(np.kron(np.eye(2)[::-1], np.ones(check)) > 0) for check in checks]
    charts += [p.chart for p in PATTERNS if max(p.chart.purl.shape) > 4]
    return tuple(dict.fromkeys(chart.canonical() for chart in charts))


def striped_repeats() -> tuple[StitchChart, ...]:
    """Two of the four fabrics side by side or on each other, in repeats up to 8 stitches long.

    In stiffness they lie between their fabrics, each a step from the next.
    """
    distinct = dict.fromkeys(chart.canonical() for chart in _stripes())
    return tuple(chart for chart in distinct if max(chart.purl.shape) > 4)


def _symmetries(rows: int, columns: int) -> Iterator[tuple[Indices, tuple[int, int] | None]]:
    """Orders of the cells under all translations, each also mirrored.

    The second value is the shift of a translation that would make a repeat smaller: one along a
    single axis, without a mirror. A slanted shift makes no smaller rectangle.
    """
    index = np.arange(rows * columns).reshape(rows, columns)
    for down in range(rows):
        for across in range(columns):
            moved = np.roll(index, (down, across), axis=(0, 1))
            along_one_axis = (down == 0) != (across == 0)
            yield moved.ravel(), (down, across) if along_one_axis else None
            yield moved[:, ::-1].ravel(), None


def _stripes() -> Iterator[StitchChart]:
    for first, second in combinations(Fabric, 2):
        for total in (6, 8):
            for width in range(2, total - 1):
                fabrics = [
                    StitchChart.of_fabric(fabric, rows=8, columns=8).purl
                    for fabric in (first, second)
                ]
                upright = np.where(np.arange(8) < width, *fabrics)[:2, :total]
                level = np.where(np.arange(8)[:, None] < width, *fabrics)[:total, :2]
                yield from (StitchChart(upright), StitchChart(level))
