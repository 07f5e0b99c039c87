"""Samples of the yarn that may touch: a cell list over the periodic (mirrored) sheet.

A pair (i, j, across, up) means sample i of the cell and the image of sample j that lies ``across``
cells further along the course and ``up`` cells higher. Every pair is listed once, whatever the
size of the cell: the bins of the list are repeated as often as the reach demands.
"""

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.base.threads import on_halves
from knitcore.yarn.kernels.curve_samples import laid_out
from knitcore.yarn.kernels.structures import Ints, Pairs

Sizes = tuple[float, float]
"""Size of a stitch, course-wise and wale-wise, mm."""
Shape = tuple[int, int]
"""Rows and wales of a cell."""
EXCLUSION_RADII = 2.1
"""Samples of one yarn nearer than this many radii along it do not touch (authors' code)."""
_BINS = 3
"""Bins per reach: finer ones follow its circle more closely."""
_ROOM = 128
"""Pairs per sample for which there is room at first."""
_SAMPLES_TO_SHARE = 20_000
"""Fewest samples for which a second thread saves time."""
_LEAST_CHANGE = 1e-300
"""Smallest change that is divided by, mm."""


def neighbour_pairs(
    curve: Array, place: Array, cell: Sizes, shape: Shape, mirror: tuple[int, int], reach: float,
    exclusion: float, moving: NDArray[np.bool_], cut: tuple[bool, bool],
) -> tuple[Pairs, Ints]:  # fmt: skip
    """All pairs of samples nearer than ``reach`` of which at least one moves.

    Parameters
    ----------
    curve : (courses * S, 4, 3), positions without the drift of the cell.
    place : (S,) parameter t of the samples of a course.
    cell : size of one stitch (course, wale), mm.
    shape : (rows, wales) of the cell, in stitches.
    mirror : -1 where z changes its sign from one cell to the next (course, wale), else 1.
    reach : mm.
    exclusion : stitches of yarn within which a yarn does not touch itself.
    moving : (courses * S,) which samples move.
    cut : whether images across, and up, are left out.

    Returns
    -------
    pairs : int (n, 5): i, j, across, up, sign of z of the image of j relative to i.
    start : int (courses * S + 1): pairs start[i] … start[i + 1] belong to sample i.
    """
    room = _ROOM

    def listed(of: Ints) -> Ints:
        begins: Ints = _listed(
            curve, place, cell, shape, mirror, reach, exclusion, of, moving, cut,
            pairs[room * of[0] : room * (of[-1] + 1)],
        )  # fmt: skip
        return begins

    while True:
        # every thread writes into its part, of which only the pages that it fills take memory
        pairs = np.empty((room * len(curve), 5), np.int32)
        starts = on_halves(listed, np.arange(len(curve)), _SAMPLES_TO_SHARE)
        if all(start[-1] <= room * (len(start) - 1) for start in starts):
            break
        room *= 2
    start = starts[0]
    for later in starts[1:]:
        _move(pairs, room * (len(start) - 1), start[-1], later[-1])
        start = np.concatenate([start[:-1], later + start[-1]])
    pairs.resize((start[-1], 5), refcheck=False)  # gives the rest back
    return pairs, start


@compiled
def _move(pairs: Pairs, begin: int, to: int, count: int) -> None:
    """Move pairs towards the front."""
    for q in range(count):
        pairs[to + q] = pairs[begin + q]


@compiled
def _listed(  # noqa: PLR0912, PLR0915 - compiled: bins, then pairs
    curve: Array, place: Array, cell: Sizes, shape: Shape, mirror: tuple[int, int], reach: float,
    exclusion: float, of: Ints, moving: NDArray[np.bool_], cut: tuple[bool, bool], pairs: Pairs,
) -> Ints:  # fmt: skip
    """Fill ``pairs`` with those of the samples ``of``, and tell where each sample's begin.

    Those for which there is no room are only counted.
    """
    rows, wales = shape
    n = curve.shape[0]
    samples = place.shape[0]
    width = cell[0] * wales
    height = cell[1] * rows
    bins_x = max(1, int(_BINS * width / reach))
    bins_y = max(1, int(_BINS * height / reach))
    span_x = int(np.ceil(reach * bins_x / width))
    span_y = int(np.ceil(reach * bins_y / height))
    x, y, z = np.empty(n), np.empty(n), np.empty(n)
    image = np.empty((n, 2), np.int64)
    bin_of = np.empty(n, np.int64)
    first = np.zeros(bins_x * bins_y + 1, np.int64)
    moves = np.zeros(bins_x * bins_y, np.int64)  # how many samples of the bin do
    for i in range(n):
        z[i] = curve[i, 0, 2]
        full_x = curve[i, 0, 0] + cell[0] * place[i % samples]
        full_y = curve[i, 0, 1] + cell[1] * (i // samples)
        image[i, 0] = int(np.floor(full_x / width))
        image[i, 1] = int(np.floor(full_y / height))
        x[i] = full_x - image[i, 0] * width
        y[i] = full_y - image[i, 1] * height
        b = min(bins_y - 1, int(y[i] / height * bins_y)) * bins_x + min(
            bins_x - 1, int(x[i] / width * bins_x)
        )
        bin_of[i] = b
        first[b + 1] += 1
        moves[b] += moving[i]
    for b in range(bins_x * bins_y):
        first[b + 1] += first[b]
    # the samples bin by bin, in falling order, side by side in memory
    sample = np.empty(n, np.int64)
    there = np.empty((n, 3))
    filled = np.empty(bins_x * bins_y, np.int64)
    for b in range(bins_x * bins_y):
        filled[b] = first[b]
    for i in range(n - 1, -1, -1):
        k = filled[bin_of[i]]
        filled[bin_of[i]] += 1
        sample[k] = i
        there[k, 0], there[k, 1], there[k, 2] = x[i], y[i], z[i]
    capacity = pairs.shape[0]
    start = np.zeros(of.shape[0] + 1, np.int64)
    count = 0
    square = reach * reach
    for p in range(of.shape[0]):
        i = of[p]
        start[p] = count
        by, bx = bin_of[i] // bins_x, bin_of[i] % bins_x
        row_i, t_i = i // samples, place[i % samples]
        for v in range(by - span_y, by + span_y + 1):
            lift = v // bins_y
            for u in range(bx - span_x, bx + span_x + 1):
                shift = u // bins_x
                across_x = shift * width - x[i]
                up_y = lift * height - y[i]
                b = (v - lift * bins_y) * bins_x + (u - shift * bins_x)
                if not (moving[i] or moves[b] > 0):
                    continue
                for k in range(first[b], first[b + 1]):
                    j = sample[k]
                    if j < i:
                        break
                    dx = there[k, 0] + across_x
                    dy = there[k, 1] + up_y
                    left = square - dx * dx - dy * dy
                    if left <= 0.0 or not (moving[i] or moving[j]):
                        continue
                    across = shift - image[j, 0] + image[i, 0]
                    up = lift - image[j, 1] + image[i, 1]
                    if (cut[0] and across != 0) or (cut[1] and up != 0):
                        continue
                    flip = 1
                    if mirror[0] < 0 and across % 2 != 0:
                        flip = -flip
                    if mirror[1] < 0 and up % 2 != 0:
                        flip = -flip
                    dz = flip * there[k, 2] - z[i]
                    if dz * dz >= left:
                        continue
                    if j == i and (across < 0 or (across == 0 and up <= 0)):
                        continue
                    row_j = j // samples
                    if row_j + up * rows == row_i:
                        along = abs(place[j - row_j * samples] + across * wales - t_i)
                        if along <= exclusion:
                            continue
                    if count < capacity:
                        pairs[count, 0] = i
                        pairs[count, 1] = j
                        pairs[count, 2] = across
                        pairs[count, 3] = up
                        pairs[count, 4] = flip
                    count += 1
    start[-1] = count
    return start


@compiled
def pair_distances(curve: Array, cell: Sizes, place: Array, shape: Shape, pairs: Pairs) -> Array:
    """Length of the vector of each pair, mm.

    The vectors are linear in curve and cell: differences of both give how far the vectors change.
    """
    at = laid_out(curve, place, *cell)
    distance = np.empty(pairs.shape[0])
    for q in range(pairs.shape[0]):
        distance[q] = np.sqrt(_square(at, cell, shape, pairs, q))
    return distance


@compiled
def extremes(
    curve: Array, cell: Sizes, place: Array, shape: Shape, pairs: Pairs
) -> tuple[float, float]:
    """Least and greatest of the :func:`pair_distances`; infinite and zero without pairs."""
    at = laid_out(curve, place, *cell)
    least, greatest = np.inf, 0.0
    for q in range(pairs.shape[0]):
        square = _square(at, cell, shape, pairs, q)
        least, greatest = min(least, square), max(greatest, square)
    return np.sqrt(least), np.sqrt(greatest)


@compiled
def part_apart(
    curves: tuple[Array, Array], cells: tuple[Sizes, Sizes], place: Array, shape: Shape,
    pairs: Pairs, used: tuple[float, float], longest: float, most: float,
) -> float:  # fmt: skip
    """Part of a step, at most ``most``, on which no pair uses up its distance.

    Parameters
    ----------
    curves, cells : where the step begins, and how they change on the whole of it.
    used : distance, mm, that a pair has to keep, and part of what is beyond it that may be used.
    longest : greatest change of the vector of a pair, mm.
    """
    at, moved = laid_out(curves[0], place, *cells[0]), laid_out(curves[1], place, *cells[1])
    keep, usable = used
    part = most
    near = (keep + most * longest / usable) ** 2 * (1.0 + 1e-9)  # pairs beyond it have room
    for q in range(pairs.shape[0]):
        square = _square(at, cells[0], shape, pairs, q)
        if square <= near:
            change = max(np.sqrt(_square(moved, cells[1], shape, pairs, q)), _LEAST_CHANGE)
            part = min(part, usable * (max(np.sqrt(square) - keep, 0.0) / change))
    return part


@compiled
def _square(at: Array, cell: Sizes, shape: Shape, pairs: Pairs, q: int) -> float:
    """Square of the length of the vector of a pair, mm²."""
    i, j = pairs[q, 0], pairs[q, 1]
    x = at[j, 0] - at[i, 0] + shape[1] * pairs[q, 2] * cell[0]
    y = at[j, 1] - at[i, 1] + shape[0] * pairs[q, 3] * cell[1]
    z = pairs[q, 4] * at[j, 2] - at[i, 2]
    return float(x * x + y * y + z * z)


@compiled
def reaches(pairs: Pairs, samples: int, shape: tuple[int, int]) -> NDArray[np.int64]:
    """(2, rows, wales): how many rows, and wales, beyond itself a stitch has pairs; at least 1.

    ``samples`` are those of a stitch, ``shape`` the rows and wales of the cell.
    """
    rows, wales = shape
    out = np.ones((2, rows, wales), np.int64)
    for q in range(pairs.shape[0]):
        first, second = pairs[q, 0] // samples, pairs[q, 1] // samples
        up = abs(second // wales + rows * pairs[q, 3] - first // wales)
        across = abs(second % wales + wales * pairs[q, 2] - first % wales)
        for stitch in (first, second):
            row, wale = stitch // wales, stitch % wales
            out[0, row, wale] = max(out[0, row, wale], up)
            out[1, row, wale] = max(out[1, row, wale], across)
    return out
