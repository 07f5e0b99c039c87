"""How far the stitches of a sheet turn at rest, and how large they are, so that folds are as wide
as the resolver says.

Free, stockinette turns by more than a radian from stitch to stitch. Between opposite folds it
cannot: a row of n like stitches between others turns only until the cloth is as narrow as
the relaxed sizes of its surroundings (:mod:`knitcore.answer.neighbourhood`). n stitches of which
each turns by θ against the last span the share sin(nθ/2) / (n sin(θ/2)) of their length, about
1 − (n² − 1) θ²/24. What the surroundings say beyond that is the size of the stitches themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.answer.neighbourhood import neighbourhood_folds, neighbourhood_sizes
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.fabric import Fabric
from knitcore.materials import Material
from knitcore.phases import quarter_phases

MIN_FOLD = 0.3
"""Share of its length by which a row of opposed runs would fold by itself, at least. For the
resolver baskets have about the size of flat cloth; they pillow all the same, about as much as
relaxed baskets at the yarn level."""


@dataclass(frozen=True, eq=False)
class Folds:
    """Stitches of a sheet.

    Parameters
    ----------
    share : (rows, columns) of the free turn of stockinette that a stitch has.
    sizes_mm : (rows, columns, 2) width and height.
    """

    share: Array
    sizes_mm: Array


def folds_of(chart: StitchChart, material: Material, free: Array) -> Folds:
    """Folds of a piece.

    Parameters
    ----------
    free : (2,) turn of stockinette at rest where nothing opposes it, along the rows and along the
        columns, rad.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    span = np.minimum(neighbourhood_folds(chart, material), 1.0 - MIN_FOLD)
    side = turning(chart)
    run = np.stack([opposed(side), opposed(side.T).T], axis=-1)
    folded = run > 1
    count = np.where(folded, run, 2)
    turn = np.minimum(np.sqrt(24.0 * (1.0 - span) / (count**2 - 1.0)), np.pi / count)
    # what folds in one direction does not roll up in the other
    share = np.where(folded, turn / free, 1.0).min(axis=-1).clip(max=1.0)
    turn = np.where(folded, share[..., None] * free, 0.0)
    folds_to = np.sinc(0.5 * count * turn / np.pi) / np.sinc(0.5 * turn / np.pi)
    # a sheet that is to fold in both directions would have to stretch, and hardly gets narrower
    both = folded.all(axis=-1, keepdims=True)
    return Folds(share, neighbourhood_sizes(chart, material) / np.where(both, 1.0, folds_to))


def turning(chart: StitchChart) -> NDArray[np.int8]:
    """Side to which stitches turn, (rows, columns): 1 for knits, -1 for purls, 0 for those without
    a quarter of stockinette.
    """
    curls = quarter_phases(chart) == Fabric.STOCKINETTE.phase
    any_of = curls.reshape(chart.rows, 2, chart.columns, 2).any(axis=(1, 3))
    return np.where(any_of, np.where(chart.purl, -1, 1), 0).astype(np.int8)


def opposed(side: NDArray[np.int8]) -> NDArray[np.int64]:
    """Lengths of the runs of stitches of a row that turn to one side, between others that turn to
    the other, (rows, columns).

    A single stitch that does not turn opposes its neighbours, too, as the purls of a 5x1 rib do;
    more of them, such as a border, do not. A run at an edge is opposed if it is no longer than the
    one beside it. 0 where nothing opposes.
    """
    rows, columns = side.shape
    begins = np.ones((rows, columns), dtype=bool)
    begins[:, 1:] = side[:, 1:] != side[:, :-1]
    run = np.cumsum(begins.ravel()) - 1
    start = np.flatnonzero(begins)
    count = np.diff(np.append(start, rows * columns))
    first, last = start % columns == 0, (start + count) % columns == 0
    turns = side.ravel()[start] != 0
    holds = turns | ((count == 1) & ~first & ~last)
    before = np.where(first | ~np.roll(holds, 1), 0, np.roll(count, 1))
    after = np.where(last | ~np.roll(holds, -1), 0, np.roll(count, -1))
    held = np.where((before > 0) & (after > 0), True, count <= np.maximum(before, after))
    return np.asarray(np.where(turns & held, count, 0)[run].reshape(rows, columns))
