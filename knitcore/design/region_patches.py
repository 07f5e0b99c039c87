"""Choose patches of an atlas's repeats so that they meet a map of target moduli."""

import numpy as np
import scipy

from knitcore.base.arrays import Array, Indices
from knitcore.chart.phases import surroundings
from knitcore.design.atlas import Atlas
from knitcore.mechanics.local_moduli import StitchTable

MAX_LABELS = 48
"""Most repeats in one chart."""
_BIN = 0.02
"""Targets that differ by less than this (in logarithms) are looked up together."""
EVENNESS = 0.002
"""Weight of unevenness: it counts at most as much as an error of 4.5 % in one modulus."""
_SWEEPS = 6


def unevenness(atlas: Atlas, table: StitchTable) -> Array:
    """Difference of the local moduli in each repeat from its effective ones, at most 1.

    Mean squares of logarithms: 0 for pure fabrics, large where unlike stitches alternate.
    """
    local, own = table.log_moduli, atlas.log_moduli.T
    squares = [
        float(((local[:, surroundings(atlas.chart(k), periodic=True)].T - own[:, k]) ** 2).mean())
        for k in range(len(atlas))
    ]
    return np.minimum(squares, 1.0)


def best_labels(
    atlas: Atlas, uneven: Array, log_course: Array, log_wale: Array
) -> tuple[Indices, Array]:
    """The best repeats for a map, and the cost of each at every stitch.

    Parameters
    ----------
    atlas : repeats to choose from.
    uneven : see :func:`unevenness`; of repeats about equally near the most even one is taken.
    log_course, log_wale : (rows, columns) logarithms of the target moduli; NaN without a target.

    Returns
    -------
    indices into the atlas (labels,), and (labels, rows, columns) squared deviations.
    """
    have, price = atlas.log_moduli.T, EVENNESS * uneven
    binned = np.stack([np.round(log_course / _BIN), np.round(log_wale / _BIN)]).reshape(2, -1)
    kinds, counts = np.unique(np.nan_to_num(binned, nan=1e9), axis=1, return_counts=True)
    kinds = np.where(kinds == 1e9, np.nan, kinds) * _BIN
    off = np.nansum((have[:, :, None] - kinds[:, None, :]) ** 2, axis=0) + price[:, None]
    # Small repeats come first in an atlas, so argmin prefers them among equals.
    best = np.argmin(off.round(6), axis=0)
    votes = np.bincount(best, weights=counts, minlength=len(atlas))
    chosen = np.argsort(-votes, kind="stable")[:MAX_LABELS]
    chosen = np.sort(chosen[votes[chosen] > 0])
    target = np.stack([log_course, log_wale])
    cost = np.nansum((have[:, chosen, None, None] - target[:, None]) ** 2, axis=0)
    return chosen, cost + price[chosen, None, None]


def smooth(cost: Array, smallest: int) -> Indices:
    """Labels (rows, columns) of low cost in patches of at least smallest x smallest stitches.

    Starts from the cheapest label of every stitch, lets neighbours agree where that costs little,
    and gives patches that are too small to their cheapest neighbour.
    """
    labels: Indices = cost.argmin(axis=0)
    if len(cost) == 1:
        return labels
    fine = np.partition(cost, 1, axis=0)
    weight = float(np.median(fine[1] - fine[0])) / 4
    for _ in range(_SWEEPS):
        agree = np.stack([_neighbours_like(labels, label) for label in range(len(cost))])
        updated = (cost - weight * agree).argmin(axis=0)
        if np.array_equal(updated, labels):
            break
        labels = updated
    return _absorb(labels, cost, smallest)


def connected(labels: Indices) -> Indices:
    """Connected patches of one label, numbered from 0."""
    numbered = np.zeros(labels.shape, dtype=np.intp)
    count = 0
    for label in np.unique(labels):
        parts, added = scipy.ndimage.label(labels == label)
        numbered[parts > 0] = parts[parts > 0] - 1 + count
        count += added
    return numbered


def _neighbours_like(labels: Indices, label: int) -> Indices:
    like = np.pad((labels == label).astype(np.intp), 1)
    total: Indices = like[:-2, 1:-1] + like[2:, 1:-1] + like[1:-1, :-2] + like[1:-1, 2:]
    return total


def _absorb(labels: Indices, cost: Array, smallest: int) -> Indices:
    """Give patches that are too small to the neighbour that suits them best, smallest first."""
    labels = labels.copy()
    least = np.minimum(smallest, labels.shape)
    while True:
        patches = connected(labels)
        sizes = np.bincount(patches.ravel())
        too_small = (sizes < least.prod()) | (_sides(patches) < least).any(axis=1)
        small = np.flatnonzero(too_small & (sizes < labels.size)).tolist()
        if not small:
            return labels
        index = min(small, key=lambda i: (sizes[i], i))
        cells = patches == index
        beside = scipy.ndimage.binary_dilation(cells) & ~cells
        choices = np.unique(labels[beside])
        labels[cells] = choices[np.argmin(cost[choices][:, cells].sum(axis=1))]


def _sides(numbered: Indices) -> Indices:
    """(numbers, 2) rows and columns that each number extends over."""
    boxes = scipy.ndimage.find_objects(numbered + 1)
    return np.array([[side.stop - side.start for side in box] for box in boxes], dtype=np.intp)
