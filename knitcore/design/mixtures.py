"""Fabrics between those of an atlas: stripes of two repeats.

The moduli of two sheets side by side follow from theirs (stress common across the joint, strain
along it; docs/predict.md). This estimate ranks all stripes at once. The best are then predicted as
repeats, and the errors that the estimate makes at the joints are corrected on the way. If none is
near, single stitches, rows and columns of the nearest charts are turned.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from knitcore.base.arrays import Array, Indices
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.phases import quarter_phases
from knitcore.chart.stitch_chart import StitchChart
from knitcore.design.atlas import Atlas
from knitcore.design.atlas_build import predict_repeat
from knitcore.materials import Material
from knitcore.mechanics.lamination import laminated

CLOSE = 0.02
"""A mixture nearer than this (in logarithms) is taken at once."""
MAX_PREDICTED = 100
"""Most mixtures that are predicted for one target."""
MAX_TURNED = 200
"""Most charts with turned stitches that are predicted for one target, if no mixture is near."""
NEAR = 0.045
"""Single stitches are not turned if a mixture is nearer than this (in logarithms)."""
_PARTNERS = 140
_MIN_WIDTH, _MAX_WIDTH = 1, 9
_MAX_SIDE = 12


@dataclass(frozen=True)
class Stripes:
    """Stripes of two repeats.

    Attributes
    ----------
    repeat : the stripes, once.
    modulus_course_n_per_mm, modulus_wale_n_per_mm : predicted.
    off : largest deviation from the targets, in logarithms.
    """

    repeat: StitchChart
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    off: float

    @property
    def log_moduli(self) -> Array:
        """(2,) logarithms of the moduli."""
        return np.log([self.modulus_course_n_per_mm, self.modulus_wale_n_per_mm])


class Mixer:
    """All stripes of small repeats of an atlas.

    Parameters
    ----------
    atlas, material : of one yarn.
    """

    def __init__(self, atlas: Atlas, material: Material) -> None:
        self._atlas, self._material = atlas, material
        self._partners = _partners(atlas)
        self._charts: dict[tuple[Direction, bytes, bytes], StitchChart] = {}
        self._estimates: list[_Estimates] = []
        if len(self._partners) > 1:
            self._estimates = [self._estimate(direction) for direction in Direction]

    def nearest(
        self,
        course_n_per_mm: float,
        wale_n_per_mm: float,
        *,
        most_rows: int = _MAX_SIDE,
        most_columns: int = _MAX_SIDE,
        scattered: bool = True,
        look: Callable[[], None] = lambda: None,
    ) -> Stripes | None:
        """The mixture nearest to a target (NaN is none); None if there is no room for one.

        Parameters
        ----------
        most_rows, most_columns : of the mixture's repeat.
        scattered : single stitches may be turned where no stripes come near.
        look : called between predictions; may raise to stop.
        """
        target = np.log([course_n_per_mm, wale_n_per_mm])
        tables = [table.within(most_rows, most_columns) for table in self._estimates]
        best: Stripes | None = None
        learnt = np.zeros(2)
        tried: set[StitchChart] = set()
        for _ in range(MAX_PREDICTED):
            look()
            candidate = self._next(tables, target - learnt, tried)
            if candidate is None:
                break
            chart, estimated = candidate
            tried.add(chart)
            mixture = self._predicted(chart, target)
            if best is None or mixture.off < best.off:
                best = mixture
            if best.off < CLOSE:
                return best
            learnt += 0.3 * (mixture.log_moduli - estimated - learnt)
        if scattered and (best is None or best.off > NEAR):
            best = self._turned(best, target, (most_rows, most_columns), look)
        return best

    def _predicted(self, chart: StitchChart, target: Array) -> Stripes:
        predicted = predict_repeat(chart, self._material)
        moduli = predicted.modulus_course_n_per_mm, predicted.modulus_wale_n_per_mm
        return Stripes(chart, *moduli, float(np.nanmax(np.abs(np.log(moduli) - target))))

    def _turned(
        self, best: Stripes | None, target: Array, most: tuple[int, int], look: Callable[[], None]
    ) -> Stripes | None:
        """The best mixtures and repeats, improved by turning a stitch, row or column at a time."""
        rng = np.random.default_rng(0)
        near = np.argsort(np.nan_to_num(np.abs(self._atlas.log_moduli - target)).max(axis=1))[:4]
        starts = [self._atlas.chart(int(k)) for k in near]
        starts = [chart for chart in starts if chart.rows <= most[0] and chart.columns <= most[1]]
        pool = [] if best is None else [best]
        pool += [self._predicted(chart, target) for chart in starts]
        for _ in range(MAX_TURNED if pool else 0):
            look()
            pool = sorted(pool, key=lambda mixture: mixture.off)[:4]
            if pool[0].off < NEAR:
                break
            start = pool[int(rng.integers(len(pool)))].repeat
            pool.append(self._predicted(_turn_some(start, most, rng), target))
        return min(pool, key=lambda mixture: mixture.off, default=None)

    def _next(
        self, tables: list[_Estimates], target: Array, tried: set[StitchChart]
    ) -> tuple[StitchChart, Array] | None:
        """The stripes with the nearest estimates that have not been tried."""
        ranked: list[tuple[float, StitchChart, Array]] = []
        for table in tables:
            off = np.maximum(*np.nan_to_num(np.abs(table.log_moduli - target)).T)
            count = min(len(tried) + 1, len(off))
            for k in np.argpartition(off, count - 1)[:count].tolist() if count else []:
                chart = self._chart(table, k)
                if chart not in tried:
                    ranked.append((float(off[k]), chart, table.log_moduli[k]))
        if not ranked:
            return None
        _, chart, estimated = min(ranked, key=lambda entry: entry[0])
        return chart, estimated

    def _chart(self, table: _Estimates, index: int) -> StitchChart:
        """The stripes of an estimate; a search asks for the nearest ones again and again."""
        partners, widths = table.partners[index], table.widths[index]
        key = table.direction, partners.tobytes(), widths.tobytes()
        if key not in self._charts:
            self._charts[key] = self._striped(table, index)
        return self._charts[key]

    def _striped(self, table: _Estimates, index: int) -> StitchChart:
        first, second = (self._atlas.chart(int(k)) for k in table.partners[index])
        a, b = (int(width) for width in table.widths[index])
        if table.direction is Direction.COURSE:
            rows = int(np.lcm(first.rows, second.rows))
            grids = [first.resized(rows, a).purl, second.resized(rows, b).purl]
            return StitchChart(np.concatenate(grids, axis=1)).repeat()
        columns = int(np.lcm(first.columns, second.columns))
        grids = [first.resized(a, columns).purl, second.resized(b, columns).purl]
        return StitchChart(np.concatenate(grids, axis=0)).repeat()

    def _estimate(self, direction: Direction) -> _Estimates:
        """Moduli of all stripes stacked along a direction."""
        atlas, chosen = self._atlas, self._partners
        along, across = direction, direction.other
        both = np.clip(atlas.column("poisson_yx") * atlas.column("poisson_xy"), 0, 0.95)
        stiff = {d: atlas.modulus(d) / (1 - both) for d in Direction}
        coupling = np.sqrt(both * stiff[along] * stiff[across])
        pairs = np.array(list(combinations(chosen.tolist(), 2)))
        grids = [atlas.chart(int(k)).purl.shape for k in range(len(atlas))]
        side = np.array([shape[direction.other.axis == 0] for shape in grids])
        sizes = _sizes(atlas, self._material, direction)
        common = np.lcm(side[pairs[:, 0]], side[pairs[:, 1]])
        pairs = pairs[common <= _MAX_SIDE]
        span = np.arange(_MIN_WIDTH, _MAX_WIDTH + 1)
        widths = np.array([(a, b) for a in span for b in span if 4 <= a + b <= _MAX_SIDE])
        partners = np.repeat(pairs, len(widths), axis=0)
        widths = np.tile(widths, (len(pairs), 1))
        share = widths * sizes[partners]
        share = share / share.sum(axis=1, keepdims=True)
        crosswise, lengthwise, mixed = laminated(
            stiff[along][partners], stiff[across][partners], coupling[partners], share
        )
        moduli = {
            along: crosswise - mixed**2 / lengthwise,
            across: lengthwise - mixed**2 / crosswise,
        }
        return _Estimates(
            direction,
            partners,
            widths,
            np.lcm(side[partners[:, 0]], side[partners[:, 1]]),
            np.log(np.stack([moduli[d] for d in Direction], axis=1)),
        )


@dataclass(frozen=True, eq=False)
class _Estimates:
    """Stripes stacked along a direction, arrays of one length."""

    direction: Direction
    partners: Indices
    widths: Indices
    side: Indices
    log_moduli: Array

    def within(self, most_rows: int, most_columns: int) -> _Estimates:
        """The stripes that fit."""
        course = self.direction is Direction.COURSE
        length, side = (most_columns, most_rows) if course else (most_rows, most_columns)
        fits = (self.widths.sum(axis=1) <= length) & (self.side <= side)
        return _Estimates(
            self.direction,
            self.partners[fits],
            self.widths[fits],
            self.side[fits],
            self.log_moduli[fits],
        )


def _turn_some(chart: StitchChart, most: tuple[int, int], rng: np.random.Generator) -> StitchChart:
    """Charts with a stitch, or a whole row or column, turned; small charts are tiled first."""
    rows, columns = (
        side * int(rng.integers(1, max(min(limit, 8) // side, 1) + 1))
        for side, limit in zip((chart.rows, chart.columns), most, strict=True)
    )
    purl = chart.resized(rows, columns).purl.copy()
    row, column = int(rng.integers(rows)), int(rng.integers(columns))
    kind = int(rng.integers(4))
    purl[row if kind != 1 else slice(None), column if kind != 2 else slice(None)] ^= True
    return StitchChart(purl).repeat()


def _partners(atlas: Atlas) -> Indices:
    small = sorted(range(len(atlas)), key=lambda k: (int(atlas.stitches[k]), k))
    return np.array(small[:_PARTNERS], dtype=np.intp)


def _sizes(atlas: Atlas, material: Material, direction: Direction) -> Array:
    """Flat size of each repeat's mean stitch along a direction."""
    own = np.array([material.record(fabric).stitch_size_mm(direction) for fabric in PHASES])
    return np.array(
        [own[quarter_phases(atlas.chart(k), periodic=True)].mean() for k in range(len(atlas))]
    )
