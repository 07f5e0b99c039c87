"""Turn and size of the stitches of a sheet at rest, so that folded cloth is as wide as predicted.

Where nothing opposes it, stockinette turns by more than a radian from stitch to stitch. Between
opposite folds it cannot: a row of n like stitches between others turns only until the cloth is as
narrow as the relaxed sizes of its surroundings (:mod:`knitcore.prediction.neighbourhood`). n
stitches, each turned by θ against the one before, span the share sin(nθ/2) / (n sin(θ/2)) of their
length, about 1 − (n² − 1) θ²/24. The rest of the narrowing is in the size of the stitches
themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Fabric
from knitcore.chart.phases import quarter_phases
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import Material
from knitcore.prediction.neighbourhood import sizes_and_folds

MIN_FOLD = 0.2
"""Least share of its length by which a row of opposed runs folds if nothing else holds it. Baskets
are predicted about as large as flat cloth, but they pillow, about as much as baskets that are
relaxed at the yarn level."""
NO_STITCH = 2
"""Mark for a place without a stitch among the sides to which stitches turn."""


@dataclass(frozen=True, eq=False)
class Folds:
    """Stitches of a sheet.

    Parameters
    ----------
    share : (rows, columns, 2) of the free turn of stockinette that a stitch has, along the rows and
        along the columns.
    sizes_mm : (rows, columns, 2) width and height.
    """

    share: Array
    sizes_mm: Array


def folds_of(
    chart: StitchChart, material: Material, free: Array, stitches: NDArray[np.bool_] | None = None
) -> Folds:
    """Folds of a piece.

    Parameters
    ----------
    chart : continued where the piece has no stitch.
    free : (2,) turn of stockinette at rest where nothing opposes it, along the rows and along the
        columns, rad.
    stitches : (rows, columns) as for :func:`turning`.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    sizes, span = sizes_and_folds(chart, material)
    span = np.minimum(span, 1.0 - MIN_FOLD)
    side = turning(chart, stitches)
    run = np.stack([opposed(side), opposed(side.T).T], axis=-1)
    folded = run > 1
    count = np.where(folded, run, 2)
    turn = np.minimum(np.sqrt(24.0 * (1.0 - span) / (count**2 - 1.0)), np.pi / count)
    # what folds in one direction does not roll up in the other
    share = np.where(folded, turn / free, 1.0).clip(max=1.0)
    share = np.where(folded, share, share[..., ::-1])
    turn = np.where(folded, share * free, 0.0)
    folds_to = np.sinc(0.5 * count * turn / np.pi) / np.sinc(0.5 * turn / np.pi)
    # a sheet that is to fold in both directions would have to stretch, and hardly gets narrower
    both = folded.all(axis=-1, keepdims=True)
    return Folds(share, sizes / np.where(both, 1.0, folds_to))


def turning(chart: StitchChart, stitches: NDArray[np.bool_] | None = None) -> NDArray[np.int8]:
    """Side to which stitches turn, (rows, columns).

    It is 1 for knits, -1 for purls, 0 for stitches without a quarter of stockinette and `NO_STITCH`
    for places without a stitch.

    Parameters
    ----------
    stitches : (rows, columns) where the piece has stitches; all if None.
    """
    curls = quarter_phases(chart, stitch=stitches) == Fabric.STOCKINETTE.phase
    any_of = curls.reshape(chart.rows, 2, chart.columns, 2).any(axis=(1, 3))
    side = np.where(any_of, np.where(chart.purl, -1, 1), 0)
    return (side if stitches is None else np.where(stitches, side, NO_STITCH)).astype(np.int8)


@dataclass(frozen=True, eq=False)
class _Runs:
    """Runs of stitches of a row, side by side, that turn to one side; numbered along the rows.

    Parameters
    ----------
    of : (rows, columns) number of a stitch's run.
    count : (runs,) stitches.
    first, last : (runs,) whether nothing is before or after it: it begins or ends a row, or is at
        a hole.
    turns : (runs,) whether its stitches turn at all.
    """

    of: NDArray[np.int64]
    count: NDArray[np.int64]
    first: NDArray[np.bool_]
    last: NDArray[np.bool_]
    turns: NDArray[np.bool_]

    @classmethod
    def along(cls, side: NDArray[np.int8]) -> _Runs:
        rows, columns = side.shape
        begins = np.ones((rows, columns), dtype=bool)
        begins[:, 1:] = side[:, 1:] != side[:, :-1]
        start = np.flatnonzero(begins)
        count = np.diff(np.append(start, rows * columns))
        of = side.ravel()[start]
        none = of == NO_STITCH
        return cls(
            of=(np.cumsum(begins.ravel()) - 1).reshape(rows, columns),
            count=count,
            first=(start % columns == 0) | none | np.roll(none, 1),
            last=((start + count) % columns == 0) | none | np.roll(none, -1),
            turns=(of != 0) & ~none,
        )

    @property
    def single(self) -> NDArray[np.bool_]:
        """Mask (runs,) of single stitches that do not turn, but oppose their neighbours."""
        return np.asarray(~self.turns & (self.count == 1) & ~self.first & ~self.last)

    @property
    def opposed(self) -> NDArray[np.bool_]:
        """Mask (runs,) of runs that lie between others that hold them."""
        holds = self.turns | self.single
        before = np.where(self.first | ~np.roll(holds, 1), 0, np.roll(self.count, 1))
        after = np.where(self.last | ~np.roll(holds, -1), 0, np.roll(self.count, -1))
        shorter = self.count <= np.maximum(before, after)
        return np.asarray(self.turns & (((before > 0) & (after > 0)) | shorter))

    @property
    def amid(self) -> NDArray[np.bool_]:
        """Mask (runs,) of opposed runs whose neighbours are opposed, too, or single."""
        before, after = self.neighbours
        folds = self.opposed | self.single
        return np.asarray(self.opposed & folds[before] & folds[after])

    @property
    def neighbours(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Runs before and after each, (runs,); at an edge its only neighbour twice, or itself."""
        own = np.arange(len(self.count))
        before, after = np.where(self.first, own, own - 1), np.where(self.last, own, own + 1)
        return np.where(self.first, after, before), np.where(self.last, before, after)

    def around(self, of_runs: Array) -> Array:
        """Sum over each run and half of either neighbour, (runs,)."""
        before, after = self.neighbours
        return np.asarray(of_runs + 0.5 * (of_runs[before] + of_runs[after]))


def opposed(side: NDArray[np.int8]) -> NDArray[np.int64]:
    """Lengths of the runs of stitches of a row that turn to one side, between others that turn to
    the other, (rows, columns).

    A single stitch that does not turn opposes its neighbours, too, as the purls of a 5x1 rib do;
    more of them, such as a border, do not. A run at an edge is opposed if it is no longer than the
    one beside it. 0 where nothing opposes.
    """
    runs = _Runs.along(side)
    return np.asarray(np.where(runs.opposed, runs.count, 0)[runs.of])


def rest_turns(side: NDArray[np.int8], turn: Array, free: Array, stiffness: Array) -> Array:
    """Turn at rest of every line between neighbours of a row, (rows, columns - 1), rad.

    Fabric that lies flat turns back at the lines between opposed runs as far as it turns within
    them. Where knits and purls do not balance, as in a 5x1 rib, the mean moment that is left rolls
    up the whole, unless it folds across, too.

    Parameters
    ----------
    side : (rows, columns), see :func:`turning`.
    turn, free : (rows, columns - 1) turns within runs, less for folds, and where nothing opposes.
    stiffness : (rows, columns - 1) of the lines, N·mm.
    """
    runs = _Runs.along(side)
    left, right = runs.of[:, :-1], runs.of[:, 1:]
    inside = left == right

    def sums(lines: Array) -> Array:
        return np.bincount(left[inside], lines[inside], minlength=len(runs.count)).astype(float)

    folded = np.where(runs.opposed, sums(turn), 0.0)
    flat = np.where(inside, turn, -0.5 * (folded[left] + folded[right]))
    mean = runs.around(sums(stiffness * free)) / runs.around(runs.count.astype(float))
    mean[~runs.amid] = 0.0
    count = np.maximum(runs.amid[left].astype(int) + runs.amid[right], 1)
    whole = (mean[left] + mean[right]) / count / stiffness
    across = opposed(side.T).T > 0
    return np.asarray(flat + np.where(across[:, 1:] | across[:, :-1], 0.0, whole))


def balances(chart: StitchChart, stitches: NDArray[np.bool_] | None = None) -> bool:
    """Tell if no part of a piece folds and rolls up at the same time; see :func:`turning`."""
    side = turning(chart, stitches)
    return _balances(side) and _balances(side.T)


def _balances(side: NDArray[np.int8]) -> bool:
    like_before = (side[:, 1:] == side[:, :-1]) & (side[:, 1:] != NO_STITCH)
    inside = np.where(like_before, side[:, 1:], 0).astype(float)
    like = np.ones_like(inside)
    return not np.any(rest_turns(side, 0.0 * like, inside, like)[inside != 0.0])
