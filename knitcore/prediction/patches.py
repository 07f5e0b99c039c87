"""Large charts: patches of stitches, each with its own prediction, that pull on each other.

A repeat of at most :data:`SIDE` stitches a side is one patch. A larger chart is cut at its middle
and in steps of that size from there. The densities of a patch are means over the window of that
size around it, of stitches that know their neighbours beyond the window: the last row of a hem
counts as one row of it, not as a texture of its own. The patches at the ends are smaller than their
windows and grow with the chart, so one row more changes little. Up to twice that size, densities
pass gradually from those of the whole chart to those of patches. They are shifted so that their
mean is the whole chart's: a cut across a repeat then does not change the result for the whole.

Patches form lines along the pull: in a line all patches carry the same force per row (wale), and
their stretched sizes add up; all lines are strained alike, and their forces add up.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain, pairwise, product
from operator import attrgetter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.base.arrays import Array, Indices
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.law.response import Response, response_through
from knitcore.materials import Interval, Material
from knitcore.materials.interval_parts import Variances, added, deviation, shared_out
from knitcore.prediction.densities import Densities, densities, densities_of
from knitcore.prediction.learned import packaged_model
from knitcore.prediction.mixed import predict_mixed
from knitcore.prediction.prediction import Along, Prediction
from knitcore.prediction.size import RelaxedSize

SIDE = 16
"""Stitches along the side of a patch and of its window."""
MAX_SIDE = 8
"""Patches along each side of a chart, at most; they are larger where that is not enough."""

_FORCES_N: Array = np.geomspace(1e-6, 30.0, 200)


@dataclass(frozen=True, eq=False)
class Patches:
    """A chart in patches, each with its prediction.

    Attributes
    ----------
    rows, columns : where patches begin and end, from 0, in stitches, or in shares of a line; one
        more than there are patches.
    predictions : of each patch, [row][column].
    alike : share of the whole chart in the densities of each patch.
    """

    rows: NDArray[Any]
    columns: NDArray[Any]
    predictions: tuple[tuple[Prediction, ...], ...]
    alike: float = 1.0

    @classmethod
    def whole(cls, chart: StitchChart, prediction: Prediction) -> Patches:
        """Take a chart as one patch."""
        return cls(np.array([0, chart.rows]), np.array([0, chart.columns]), ((prediction,),))

    @property
    def _flat(self) -> list[Prediction]:
        return [prediction for line in self.predictions for prediction in line]

    @property
    def _share(self) -> Array:
        """Share of each patch in the chart's stitches."""
        counts = np.outer(np.diff(self.rows), np.diff(self.columns)).ravel()
        return np.asarray(counts / counts.sum())

    def relaxed_mm(self, direction: Direction) -> float:
        """Extent of the mean stitch at rest."""
        return float(self._share @ [patch.along(direction).relaxed_mm for patch in self._flat])

    def together(self) -> Prediction:
        """Combine the patches to the prediction of the whole chart."""
        first = self.predictions[0][0]
        if len(self.predictions) == len(self.predictions[0]) == 1:
            return first
        flat, share = self._flat, self._share
        course, wale = (self._along(flat, share, direction) for direction in Direction)

        def together(words: Callable[[Prediction], tuple[str, ...]]) -> tuple[str, ...]:
            return tuple(dict.fromkeys(chain.from_iterable(map(words, flat))))

        # the least certain source, and the errors and notes of all
        learned = (patch for patch in flat if patch.provenance.startswith("learned"))
        return replace(
            next(learned, first),
            course=course,
            wale=wale,
            shear_modulus_n_per_mm=float(share @ [patch.shear_modulus_n_per_mm for patch in flat]),
            method=f"{len(self.predictions[0])} x {len(self.predictions)} patches, in series along "
            "the pull and side by side across it; mixed ones estimated from simulations",
            stretch_errors=together(lambda patch: patch.stretch_errors),
            size_errors=together(lambda patch: patch.size_errors),
            notes=together(lambda patch: patch.notes),
        )

    def lines(self, direction: Direction, count: int) -> tuple[Prediction, ...]:
        """Predict each row of the chart for a course-wise pull, or each column for a wale-wise one.

        They change gradually, as if a line were knitted partly as the one patch, partly as the
        next. A chart of ``count`` rows or columns goes on beyond its repeat.
        """
        by_row = direction is Direction.COURSE
        cuts, across = (self.rows, self.columns) if by_row else (self.columns, self.rows)
        grid = self.predictions if by_row else tuple(zip(*self.predictions, strict=True))

        @cache
        def line(shares: tuple[float, ...]) -> Prediction:
            near = tuple(each for each, share in zip(grid, shares, strict=True) if share)
            parts = np.cumsum([0.0, *filter(None, shares)])
            if by_row:
                return Patches(parts, across, near).together()
            return Patches(across, parts, tuple(zip(*near, strict=True))).together()

        return tuple(line(tuple(shares)) for shares in shares_of_patches(cuts, count).tolist())

    def _along(self, flat: list[Prediction], share: Array, direction: Direction) -> Along:
        parts = [patch.along(direction) for patch in flat]

        def mean(of: Callable[[Along], float]) -> float:
            return float(share @ [of(part) for part in parts])

        def together(of: Callable[[Along], Variances]) -> Variances:
            """Variances of patches that err alike: the deviations have a mean."""
            each = [of(part) for part in parts]
            mean_sd = np.tensordot(share, [deviation(part) for part in each], axes=1)
            weighted = [
                {name: s * of for name, of in part.items()}
                for s, part in zip(share, each, strict=True)
            ]
            return shared_out(np.square(mean_sd), added(weighted))

        def across(stress: ArrayLike) -> Array:
            return np.tensordot(share, [part.across(stress) for part in parts], axes=1)

        response, stiff, soft, held = (
            self._response(direction, attrgetter(kind))
            for kind in ("response", "stiff", "soft", "held")
        )
        modulus = response.modulus_n_per_mm
        return Along(
            response,
            stiff,
            soft,
            across,
            held,
            poisson=mean(lambda part: part.poisson),
            poisson_parts=together(lambda part: part.poisson_parts),
            relaxed_mm=self.relaxed_mm(direction),
            relaxed_parts=together(lambda part: part.relaxed_parts),
            strain_parts=lambda stress: together(lambda part: part.strain_parts(stress)),
            bounds_n_per_mm=Interval(
                min(modulus, *(part.bounds_n_per_mm.low for part in parts)),
                max(modulus, *(part.bounds_n_per_mm.high for part in parts)),
            ),
        )

    def _response(self, direction: Direction, kind: Callable[[Along], Response]) -> Response:
        """One curve of the whole chart from that of its patches."""
        grid, along, across = self.predictions, np.diff(self.columns), np.diff(self.rows)
        if direction is Direction.WALE:
            grid, along, across = tuple(zip(*grid, strict=True)), across, along

        @cache  # patches of one fabric share its prediction
        def strains_of(response: Response, width: float) -> Array:
            return response.strain(_FORCES_N / width)

        heights, curves = [], []
        for line in grid:
            lengths = along * [a.along(direction).relaxed_mm for a in line]
            widths = [a.along(direction.other).relaxed_mm for a in line]
            strains = [
                strains_of(kind(a.along(direction)), width)
                for a, width in zip(line, widths, strict=True)
            ]
            curves.append(lengths @ np.array(strains) / lengths.sum())
            heights.append(float(along @ widths / along.sum()))
        common = np.geomspace(
            max(curve[0] for curve in curves), min(curve[-1] for curve in curves), 200
        )
        force = across @ np.array([np.interp(common, curve, _FORCES_N) for curve in curves])
        return response_through(force / float(across @ np.array(heights)), common)


def is_large(repeat: StitchChart) -> bool:
    """Say whether a repeat is larger than one patch."""
    return max(repeat.rows, repeat.columns) > SIDE


def in_patches(
    repeat: StitchChart, material: Material, size: RelaxedSize | None = None, most: int = MAX_SIDE
) -> Patches:
    """Predict a large repeat patch by patch.

    Parameters
    ----------
    repeat : the repeat, or a whole piece.
    material : a yarn at one setting.
    size : relaxed size of the whole chart's mean stitch, if known.
    most : patches along each side, at most.

    Raises
    ------
    InputError
        If the repeat needs a pure fabric that the material lacks.
    """
    rows, columns = _cuts(repeat.rows, most), _cuts(repeat.columns, most)
    cells = product(pairwise(rows.tolist()), pairwise(columns.tolist()))
    parts = [repeat.region(slice(*up), slice(*along)) for up, along in cells]
    whole = densities(repeat)
    # a chart slightly larger than one patch gets almost the prediction of one patch
    alike = max(2 - max(repeat.rows, repeat.columns) / SIDE, 0.0)
    compositions = _densities_of(repeat, whole, rows, columns).towards(whole, alike)

    def predicted(sizes: Sequence[RelaxedSize | None]) -> Patches:
        learned = packaged_model().responses(compositions, material, sizes)
        flat = [
            predict_mixed(part, composition, material, response, known)
            for part, composition, response, known in zip(
                parts, compositions, learned, sizes, strict=True
            )
        ]
        wide = len(columns) - 1
        lines = (tuple(flat[k : k + wide]) for k in range(0, len(flat), wide))
        return Patches(rows, columns, tuple(lines), alike)

    free = predicted([None] * len(parts))
    if size is None:
        return free
    wider, higher = (size.extent_mm(d) / free.relaxed_mm(d) for d in Direction)
    return predicted(
        [
            replace(
                size,
                course_mm=patch.course.relaxed_mm * wider,
                wale_mm=patch.wale.relaxed_mm * higher,
            )
            for line in free.predictions
            for patch in line
        ]
    )


def _cuts(stitches: int, most: int = MAX_SIDE) -> Indices:
    """Where patches begin and end: the middle and steps from there, as far as there are stitches.

    Examples
    --------
    >>> _cuts(16).tolist(), _cuts(20).tolist(), _cuts(40).tolist()
    ([0, 16], [0, 10, 20], [0, 4, 20, 36, 40])
    """
    if stitches <= SIDE:
        return np.array([0, stitches])
    step = max(SIDE, stitches / most)
    steps = step * np.arange(1, most)
    inside = stitches / 2 + np.concatenate([-steps, [0.0], steps])
    return np.unique(np.clip(np.append(inside.round(), [0, stitches]), 0, stitches)).astype(np.intp)


def _densities_of(
    repeat: StitchChart, whole: Densities, rows: Indices, columns: Indices
) -> Densities:
    """Densities of the patches, row by row, as means over the window of each.

    They are shifted so that the mean of all patches is that of the whole repeat.
    """
    up, along = _windows(rows), _windows(columns)
    own = densities_of(repeat.purl, lambda values: (up @ values.astype(float) @ along.T).ravel())
    counts = np.outer(np.diff(rows), np.diff(columns)).ravel()
    shares, excess, straight, even_changes, ways = (
        values + mean - np.average(values, axis=0, weights=counts)
        for values, mean in zip(own.arrays, whole.arrays, strict=True)
    )
    straight = np.clip(straight, 0.0, 1.0)
    return Densities(_shares(shares), excess, straight, even_changes, _shares(ways))


def _windows(cuts: Indices) -> Array:
    """(patches, stitches) weights that take the mean over the window of each patch."""
    weights = np.zeros((len(cuts) - 1, end := int(cuts[-1])))
    for own, (low, high) in zip(weights, pairwise(cuts.tolist()), strict=True):
        size = min(max(SIDE, high - low), end)
        start = min(max((low + high - size) // 2, 0), end - size)
        own[start : start + size] = 1 / size
    return weights


def shares_of_patches(cuts: Indices, count: int) -> Array:
    """Shares (count, patches) of the patches in the cloth around each stitch along a side.

    They are means over as many stitches as the widest patch has, so they change gradually, and each
    patch has its own size of the whole. Beyond its ends a chart goes on as its mirror image, or as
    its repeat if it has more stitches than that.

    Examples
    --------
    >>> shares_of_patches(np.array([0, 12, 24]), 24)[[0, 5, 11, 12, 23], 0].round(2).tolist()
    [1.0, 1.0, 0.54, 0.46, 0.0]
    """
    sizes = np.diff(cuts)
    widest = int(sizes.max())
    around = np.ones(widest // 2 * 2 + 1)
    around[[0, -1]] -= (len(around) - widest) / 2  # an even width ends within stitches
    own = np.repeat(np.eye(len(sizes)), sizes, axis=0)
    period = len(own)
    own = np.pad(own, ((widest, widest), (0, 0)), "wrap" if count > period else "symmetric")
    mean = around / widest
    shares = np.stack([np.convolve(column, mean, "same") for column in own.T], axis=1)
    shares = shares[widest : widest + period]
    return np.asarray(shares[np.arange(count) % period])


def _shares(values: Array) -> Array:
    """Shares that add up to 1, none of them below 0."""
    values = np.maximum(values, 0.0)
    return np.asarray(values / values.sum(axis=-1, keepdims=True))
