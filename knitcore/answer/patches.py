"""Large charts: patches of stitches, each with its own answer, that pull on each other.

A repeat of at most :data:`SIDE` stitches a side, a rib or a welt is one patch. A larger chart is
cut at its middle and in steps of that size from there. Each patch has the answer of the window of
that size around it, a pure fabric or a mixed chart of its own. The patches at the ends are smaller
than their windows and grow with the chart, so one row more changes little. Up to twice that size,
the densities of patches pass gradually from those of the whole chart to their own. The densities of
mixed patches are shifted so that their mean is the whole chart's: a cut across a repeat then does
not change the result for the whole.

Patches form lines along the pull: in a line all patches carry the same force per row (wale), and
their stretched sizes add up; all lines are strained alike, and their forces add up.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import pairwise, product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.answer.answer import Along, Answer
from knitcore.answer.densities import Densities, densities
from knitcore.answer.learned import SweptChart, packaged_model
from knitcore.answer.measured import measured
from knitcore.answer.mixed import mixed
from knitcore.answer.relaxed import RelaxedSize
from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.fabric import Direction, Fabric
from knitcore.law.response import Response, response_through
from knitcore.materials import Interval, Material, Origin
from knitcore.phases import pure_fabric

SIDE = 16
"""Stitches along the side of a patch and of its window."""
MAX_SIDE = 8
"""Patches along each side of a chart, at most; they are larger where that is not enough."""

_FORCES_N: Array = np.geomspace(1e-6, 30.0, 200)


@dataclass(frozen=True, eq=False)
class Patches:
    """A chart in patches.

    Attributes
    ----------
    rows, columns : where patches begin and end, from 0; one more than there are patches.
    answers : of each patch, [row][column].
    """

    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    answers: tuple[tuple[Answer, ...], ...]

    @property
    def _flat(self) -> list[Answer]:
        return [answer for line in self.answers for answer in line]

    @property
    def _share(self) -> Array:
        """Share of each patch in the chart's stitches."""
        counts = np.outer(np.diff(self.rows), np.diff(self.columns)).ravel()
        return np.asarray(counts / counts.sum())

    def relaxed_mm(self, direction: Direction) -> float:
        """Extent of the mean stitch at rest."""
        return float(self._share @ [a.along(direction).relaxed_mm for a in self._flat])

    def together(self) -> Answer:
        """The answer of the whole chart."""
        first = self.answers[0][0]
        if len(self.answers) == len(self.answers[0]) == 1:
            return first
        flat, share = self._flat, self._share
        course, wale = (self._along(flat, share, direction) for direction in Direction)
        # the least certain source, and the notes of all
        source = next((a for a in flat if a.provenance.startswith("learned")), first)
        return replace(
            source,
            course=course,
            wale=wale,
            shear_modulus_n_per_mm=float(share @ [a.shear_modulus_n_per_mm for a in flat]),
            method=f"{len(self.answers[0])} x {len(self.answers)} patches, in series along the "
            "pull and side by side across it; mixed ones learned from yarn-level simulations",
            notes=tuple(dict.fromkeys(note for answer in flat for note in answer.notes)),
        )

    def lines(self, direction: Direction) -> tuple[Answer, ...]:
        """Answers of the chart's rows (course), or of its columns, each that of its patches."""
        by_row = direction is Direction.COURSE
        cuts = self.rows if by_row else self.columns
        found: list[Answer] = []
        for k, count in enumerate(np.diff(cuts)):
            line = self.answers[k : k + 1] if by_row else tuple(r[k : k + 1] for r in self.answers)
            part = cuts[k : k + 2]
            strip = Patches(part, self.columns, line) if by_row else Patches(self.rows, part, line)
            found += [strip.together()] * int(count)
        return tuple(found)

    def _along(self, flat: list[Answer], share: Array, direction: Direction) -> Along:
        parts = [answer.along(direction) for answer in flat]

        def mean(of: Callable[[Along], float]) -> float:
            return float(share @ [of(part) for part in parts])

        def across(stress: ArrayLike) -> Array:
            return np.tensordot(share, [part.across(stress) for part in parts], axes=1)

        response, stiff, soft, held = (
            self._response(direction, kind)
            for kind in (
                lambda along: along.response,
                lambda along: along.stiff,
                lambda along: along.soft,
                lambda along: along.held,
            )
        )
        modulus = response.modulus_n_per_mm
        return Along(
            response,
            stiff,
            soft,
            across,
            held,
            poisson=mean(lambda part: part.poisson),
            poisson_sd=mean(lambda part: part.poisson_sd),
            relaxed_mm=self.relaxed_mm(direction),
            relaxed_log_sd=mean(lambda part: part.relaxed_log_sd),
            bounds_n_per_mm=Interval(
                min(modulus, *(part.bounds_n_per_mm.low for part in parts)),
                max(modulus, *(part.bounds_n_per_mm.high for part in parts)),
            ),
        )

    def _response(self, direction: Direction, kind: Callable[[Along], Response]) -> Response:
        """One curve of the whole chart from that of its patches."""
        grid, along, across = self.answers, np.diff(self.columns), np.diff(self.rows)
        if direction is Direction.WALE:
            grid, along, across = tuple(zip(*grid, strict=True)), across, along

        @cache  # patches of one fabric share its answer
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


def patches_of(
    chart: StitchChart,
    material: Material,
    gauge: RelaxedSize | None = None,
    swept: SweptChart | None = None,
    *,
    gradual: bool = True,
) -> Patches:
    """A chart in patches, each with its answer.

    Parameters
    ----------
    chart : a repeat or a whole piece, as for :func:`knitcore.answer.choose.choose`.
    gauge : measured relaxed size of the whole chart's mean stitch, if known.
    swept : sweep of its repeat on the yarn level, if there is one; a simulated material has those
        of the packaged samples.
    gradual : whether the answer is to change little with each row more. A swatch, whose textures
        have positions, does not use this: its patches are of one size and their own windows.

    Raises
    ------
    InputError
        If the chart needs a pure fabric that the material lacks.
    """
    fabric = pure_fabric(chart)
    if fabric is not None:
        answer = measured(fabric, material)
        return _one(chart, answer if gauge is None else answer.with_size(gauge))
    repeat = chart.repeat_cut()
    if swept is None and all(r.origin is Origin.SIMULATED for r in material.fabrics.values()):
        swept = packaged_model().sweep_of(repeat, material)
    small = max(repeat.rows, repeat.columns) <= SIDE or min(repeat.rows, repeat.columns) == 1
    if swept is not None or small:
        return _one(chart, mixed(repeat, densities(repeat), material, gauge, swept))
    cuts = _cuts if gradual else _even_cuts
    rows, columns = cuts(repeat.rows), cuts(repeat.columns)
    cells = list(product(_windows(rows, gradual), _windows(columns, gradual)))
    parts = [repeat.region(*cell) for cell in cells]
    found = [densities(part) for part in parts]
    counts = np.outer(np.diff(rows), np.diff(columns)).ravel()
    moved = _difference(densities(repeat), found, counts)
    shifted = [_sum(own, moved) for own in found]
    # a chart slightly larger than one patch gets almost the answer of one patch
    apart = min(max(repeat.rows, repeat.columns) / SIDE - 1, 1.0) if gradual else 1.0
    if apart < 1:
        shifted = [_between(densities(repeat), own, apart) for own in shifted]
    pure = cache(partial(measured, material=material)) if apart == 1 else None

    def answered(sizes: Sequence[RelaxedSize | None]) -> Patches:
        given = zip(parts, shifted, sizes, strict=True)
        flat = [_patch(part, own, material, size, pure) for part, own, size in given]
        wide = len(columns) - 1
        lines = (tuple(flat[k : k + wide]) for k in range(0, len(flat), wide))
        return Patches(rows, columns, tuple(lines))

    whole = answered([None] * len(parts))
    if gauge is None:
        return whole
    wider, higher = (gauge.extent_mm(d) / whole.relaxed_mm(d) for d in Direction)
    return answered(
        [
            RelaxedSize(a.relaxed_course_mm * wider, a.relaxed_wale_mm * higher, gauge.log_sd)
            for line in whole.answers
            for a in line
        ]
    )


def _patch(
    part: StitchChart,
    found: Densities,
    material: Material,
    gauge: RelaxedSize | None,
    pure: Callable[[Fabric], Answer] | None,
) -> Answer:
    fabric = pure_fabric(part)
    if fabric is None or pure is None:
        return mixed(part, found, material, gauge)
    answer = pure(fabric)
    return answer if gauge is None else answer.with_size(gauge)


def _one(chart: StitchChart, answer: Answer) -> Patches:
    return Patches(np.array([0, chart.rows]), np.array([0, chart.columns]), ((answer,),))


def _cuts(stitches: int) -> NDArray[np.intp]:
    """Where patches begin and end: the middle and steps from there, as far as there are stitches.

    Examples
    --------
    >>> _cuts(16).tolist(), _cuts(20).tolist(), _cuts(40).tolist()
    ([0, 16], [0, 10, 20], [0, 4, 20, 36, 40])
    """
    if stitches <= SIDE:
        return np.array([0, stitches])
    step = max(SIDE, stitches / MAX_SIDE)
    steps = step * np.arange(1, MAX_SIDE)
    inside = stitches / 2 + np.concatenate([-steps, [0.0], steps])
    return np.unique(np.clip(np.append(inside.round(), [0, stitches]), 0, stitches)).astype(np.intp)


def _even_cuts(stitches: int) -> NDArray[np.intp]:
    count = min(-(-stitches // SIDE), MAX_SIDE)
    return np.linspace(0, stitches, count + 1).round().astype(np.intp)


def _windows(cuts: NDArray[np.intp], gradual: bool) -> list[slice]:
    """Of each patch its stitches; a gradual one has :data:`SIDE`, if the chart has as many."""
    end, found = int(cuts[-1]), []
    for low, high in pairwise(cuts.tolist()):
        size = min(max(SIDE if gradual else 0, high - low), end)
        start = min(max((low + high - size) // 2, 0), end - size)
        found.append(slice(start, start + size))
    return found


def _difference(
    whole: Densities, parts: Sequence[Densities], counts: NDArray[np.intp]
) -> Densities:
    own = zip(*(part.arrays for part in parts), strict=True)
    means = (np.average(np.stack(values), axis=0, weights=counts) for values in own)
    return Densities(*(a - mean for a, mean in zip(whole.arrays, means, strict=True)))


def _between(whole: Densities, part: Densities, share: float) -> Densities:
    """Densities that lie between those of the whole chart (share 0) and of a part (1)."""
    pairs = zip(whole.arrays, part.arrays, strict=True)
    return Densities(*((1 - share) * one + share * other for one, other in pairs))


def _sum(own: Densities, moved: Densities) -> Densities:
    shares, ways = (np.maximum(v, 0.0) for v in (own.shares + moved.shares, own.ways + moved.ways))
    straight = np.clip(own.straight + moved.straight, 0.0, 1.0)
    return Densities(shares / shares.sum(), own.excess + moved.excess, straight, ways / ways.sum())
