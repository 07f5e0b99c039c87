"""A chart that takes a target outline when it is stretched.

The swatch is pulled between two clamps, and the target is its width, line by line: row by row under
a wale-wise pull, column by column under a course-wise one. It is made of bands across the pull,
each of one repeat of the atlas. All bands carry one force, so each stretches by its own curve and
narrows by its Poisson ratio: that gives the first choice. The finite swatch is then pulled, the
target of each band is shifted by its error in the swatch, and the bands are chosen again; finally
single bands are changed where that helps. Results are judged by the outline of the swatch, never by
the estimate.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array, Indices
from knitcore.base.bounds import check_positive, check_range
from knitcore.base.errors import Cancelled, InputError, SearchProgress
from knitcore.base.kinds import as_numbers
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, check_chart_size
from knitcore.cloth.flat import strip_test
from knitcore.design.atlas import STRESS_N_PER_MM, Atlas
from knitcore.materials import Material

FORCES_N_PER_MM = (0.01, 0.05, 0.2)
"""First guesses of the common force, since soft and stiff bands can narrow alike."""
ROUNDS = 4
"""Rounds of choosing and pulling all bands, from each first guess."""
TRIES = 72
"""Changes of one or two bands that are tried after that."""
_STEPS = 4
_PALETTE = 40
_DAMPING = 0.8
MAX_SHAPED_STITCHES = 10_000
OFF = 0.03
"""Smallest error of a width, over the width at rest, that a message reports."""


@dataclass(frozen=True)
class Band:
    """Lines of one repeat.

    Attributes
    ----------
    repeat : its key.
    first, lines : from 1, at the bottom (wale-wise pull) or the left.
    """

    repeat: str
    first: int
    lines: int


@dataclass(frozen=True, eq=False, repr=False)
class ShapedSwatch(Result):
    """A chart and the outline that it takes.

    Attributes
    ----------
    chart : the stitches.
    bands : of one repeat each, from the bottom or the left.
    width : (lines,) stretched width over width at rest, from the swatch.
    target : target width over width at rest, (lines,), NaN where there was none.
    rms, largest : of the differences.
    force_n : at the clamps.
    pulls : number of swatches that were pulled.
    messages : on targets that were not met.
    """

    chart: StitchChart
    bands: tuple[Band, ...]
    width: Array
    target: Array
    rms: float
    largest: float
    force_n: float
    pulls: int
    messages: tuple[str, ...]


def fill_shape(
    width: Sequence[float] | Array,
    across: int,
    direction: Direction,
    strain: float,
    material: Material,
    atlas: Atlas,
    *,
    smallest_band: int = 4,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
    cancelled: Cancelled | None = None,
) -> ShapedSwatch:
    """A chart whose outline follows a profile when it is stretched.

    Parameters
    ----------
    width : target width over width at rest of every line across the pull, from the bottom or the
        left; NaN where there is none. Near 1 at the clamps, which hold the ends.
    across : stitches of a line.
    direction : of the pull.
    strain : from clamp to clamp.
    material, atlas : of one yarn.
    smallest_band : fewest lines in a band.
    seed : of the order in which bands are changed.
    progress : called with the share done.
    cancelled : asked between and within pulls.

    Raises
    ------
    InputError
        If the profile cannot be used, or no chart can be stretched so far.
    CancelledError
        If it was asked to stop.
    """
    target = _checked(width, across, strain, smallest_band, direction)
    atlas.check_material(material)
    run = _Run(target, across, direction, strain, material, atlas, smallest_band, cancelled)
    return run.solve(np.random.default_rng(seed), progress)


@dataclass(frozen=True, eq=False)
class _Pulled:
    """Bands, and the outline of their swatch."""

    labels: tuple[int, ...]
    chart: StitchChart
    width: Array
    force_n: float
    error: float


class _Run:
    """A search for the bands."""

    def __init__(
        self,
        target: Array,
        across: int,
        direction: Direction,
        strain: float,
        material: Material,
        atlas: Atlas,
        smallest_band: int,
        cancelled: Cancelled | None,
    ) -> None:
        self._target, self._across, self._direction = target, across, direction
        self._strain, self._material, self._atlas = strain, material, atlas
        self._cancelled = cancelled
        count = max(len(target) // smallest_band, 1)
        self._edges = np.linspace(0, len(target), count + 1).round().astype(int)
        self._palette = _palette(atlas, direction, strain, across)
        self._curves = atlas.strains(direction)[self._palette]
        self._poisson = atlas.poisson(direction)[self._palette]
        self._pulls = 0

    def solve(
        self, rng: np.random.Generator, progress: Callable[[float], None] | None
    ) -> ShapedSwatch:
        """Choose, pull and correct; then change single bands."""
        chosen = ROUNDS * len(FORCES_N_PER_MM)
        total = chosen + TRIES

        watch = SearchProgress(progress, self._cancelled)
        target = self._by_band(1 - self._target)
        best: _Pulled | None = None
        aim = target
        for turn in range(chosen):
            watch.look(turn / total)
            if turn % ROUNDS == 0:
                aim = target
            pulled = self._pull(self._choose(aim, FORCES_N_PER_MM[turn // ROUNDS]))
            if pulled is None:
                aim = _DAMPING * aim  # too far for some band: try less
                continue
            if best is None or pulled.error < best.error:
                best = pulled
            aim = aim + _DAMPING * np.nan_to_num(target - self._by_band(1 - pulled.width))
        if best is None:
            raise InputError(
                "strain",
                f"no swatch of this yarn with this outline can be stretched to {self._strain:g} "
                f"{self._direction}-wise.",
                "Ask for a smaller strain.",
            )
        best = self._change_bands(best, rng, lambda turn: watch.look((chosen + turn) / total))
        watch.look(1.0)
        return self._result(best)

    def _choose(self, aim: Array, force: float) -> tuple[int, ...]:
        """Labels whose narrowing at the common force is nearest to the targets."""
        heights = np.diff(self._edges)
        labels = np.zeros(len(aim), dtype=int)
        for _ in range(4):
            narrowing = self._poisson * self._strains(force)
            off = np.abs(narrowing[:, None] - np.nan_to_num(aim, nan=float(np.nanmean(aim))))
            labels = off.argmin(axis=0)
            force = self._force(labels, heights)
        return tuple(labels.tolist())

    def _strains(self, force: float) -> Array:
        """Strain of every repeat of the palette at a stress, N/mm."""
        return np.array([np.interp(force, STRESS_N_PER_MM, curve) for curve in self._curves])

    def _force(self, labels: NDArray[np.int_], heights: Array) -> float:
        """Stress (N/mm) that stretches the bands together by the strain of the test."""

        def excess(force: float) -> float:
            mean = np.average(self._strains(force)[labels], weights=heights)
            return float(mean) - self._strain

        last = float(STRESS_N_PER_MM[-1])
        return (
            last if excess(last) < 0 else float(scipy.optimize.brentq(excess, 0.0, last, xtol=1e-4))
        )

    def _pull(self, labels: tuple[int, ...]) -> _Pulled | None:
        """The outline of these bands; None if the swatch cannot be stretched so far."""
        chart = self._chart(labels)
        self._pulls += 1
        try:
            test = strip_test(
                chart,
                self._material,
                self._direction,
                self._strain,
                steps=_STEPS,
                cancelled=self._cancelled,
            )
        except InputError:
            return None
        if not test.converged:
            return None
        rest, moved = self._direction.of(
            (test.y_mm, test.uy_mm[-1]), (test.x_mm.T, test.ux_mm[-1].T)
        )
        lines = slice(1, None, 2)  # nodes in the middle of a line of stitches
        size = rest[-1, lines] - rest[0, lines]
        width = 1 + (moved[-1, lines] - moved[0, lines]) / size
        error = float(np.sqrt(np.nanmean((width - self._target) ** 2)))
        return _Pulled(labels, chart, width, float(test.force_n[-1]), error)

    def _change_bands(
        self, best: _Pulled, rng: np.random.Generator, look: Callable[[int], None]
    ) -> _Pulled:
        """Change one or two bands to a repeat that narrows slightly more or less, or any other."""
        narrowing = self._poisson * self._strains(0.05)
        rank = np.argsort(narrowing, kind="stable")
        place = np.argsort(rank)
        tried = {best.labels}
        for turn in range(TRIES):
            look(turn)
            off = np.abs(np.nan_to_num(self._by_band(best.width - self._target))) + 1e-6
            labels = list(best.labels)
            band = int(rng.choice(len(off), p=off / off.sum()))
            if rng.random() < 0.5:
                step = int(rng.integers(1, 4)) * (1 if rng.random() < 0.5 else -1)
                other = int(rank[np.clip(place[labels[band]] + step, 0, len(rank) - 1)])
            else:
                other = int(rng.integers(len(rank)))
            for changed in range(band, min(band + int(rng.integers(1, 3)), len(labels))):
                labels[changed] = other
            if tuple(labels) in tried:
                continue
            tried.add(tuple(labels))
            pulled = self._pull(tuple(labels))
            if pulled is not None and pulled.error < best.error:
                best = pulled
        return best

    def _chart(self, labels: tuple[int, ...]) -> StitchChart:
        course = self._direction is Direction.COURSE
        parts = []
        for label, lines in zip(labels, np.diff(self._edges).tolist(), strict=True):
            repeat = self._atlas.chart(int(self._palette[label]))
            rows, columns = (self._across, lines) if course else (lines, self._across)
            parts.append(repeat.resized(rows, columns).purl)
        return StitchChart(np.concatenate(parts, axis=1 if course else 0))

    def _by_band(self, values: Array) -> Array:
        """Means over the lines of each band, NaN where all lines are NaN."""
        return np.array(
            [
                np.nan if np.isnan(part).all() else float(np.nanmean(part))
                for part in np.split(values, self._edges[1:-1])
            ]
        )

    def _result(self, best: _Pulled) -> ShapedSwatch:
        off = best.width - self._target
        keys = [self._atlas.keys[int(self._palette[label])] for label in best.labels]
        bands: list[Band] = []
        for key, first, last in zip(keys, self._edges[:-1], self._edges[1:], strict=True):
            lines = int(last - first)
            if bands and bands[-1].repeat == key:
                bands[-1] = Band(key, bands[-1].first, bands[-1].lines + lines)
            else:
                bands.append(Band(key, int(first) + 1, lines))
        return ShapedSwatch(
            chart=best.chart,
            bands=tuple(bands),
            width=best.width,
            target=self._target,
            rms=best.error,
            largest=float(np.nanmax(np.abs(off))),
            force_n=best.force_n,
            pulls=self._pulls,
            messages=tuple(self._messages(best.width, off)),
        )

    def _messages(self, width: Array, off: Array) -> list[str]:
        worst = int(np.nanargmax(np.abs(off)))
        if abs(off[worst]) <= OFF:
            return []
        narrowing = self._poisson * np.array(
            [min(self._strain, float(curve[-1])) for curve in self._curves]
        )
        line = self._direction.of("column", "row")
        return [
            f"{line.capitalize()} {worst + 1} is {off[worst]:+.0%} of the width off. Far from the "
            f"clamps and from other bands, this yarn narrows to {1 - narrowing.max():.2f} to "
            f"{1 - narrowing.min():.2f} of its width at a strain of {self._strain:g}; the clamps "
            "hold the ends, and the width changes gradually between bands. Try a longer swatch, a "
            "smoother profile or another strain."
        ]


def _palette(atlas: Atlas, direction: Direction, strain: float, across: int) -> Indices:
    """Repeats that stretch and narrow differently."""
    shapes = np.array([atlas.chart(k).purl.shape for k in range(len(atlas))])
    side = direction.of(shapes[:, 0], shapes[:, 1])
    usable = np.flatnonzero((side <= across) & (shapes.max(axis=1) <= 4))
    stretch = atlas.strain_at(direction, 0.05)[usable]
    narrowing = atlas.poisson(direction)[usable] * np.minimum(stretch, 2 * strain)
    points = np.stack([np.log(stretch), 3 * narrowing / max(np.ptp(narrowing), 1e-9)], axis=1)
    # Farthest-point choice: each one is the least like those already chosen.
    pure = [atlas.index_of(StitchChart.of_fabric(fabric, rows=2, columns=2)) for fabric in Fabric]
    chosen = [k for k, entry in enumerate(usable.tolist()) if entry in pure] or [0]
    while len(chosen) < min(_PALETTE, len(usable)):
        away = ((points[:, None] - points[chosen]) ** 2).sum(axis=2).min(axis=1)
        chosen.append(int(away.argmax()))
    return usable[chosen]


def _checked(
    width: Sequence[float] | Array,
    across: int,
    strain: float,
    smallest_band: int,
    direction: Direction,
) -> Array:
    remedy = "Give the width of at least three lines."
    target = as_numbers("width", width, remedy)
    if target.ndim != 1 or len(target) < 3 or np.isnan(target).all():
        raise InputError("width", "is not a profile.", remedy)
    given = target[~np.isnan(target)]
    if not (np.isfinite(given).all() and (given > 0.05).all() and (given < 3).all()):
        problem = "is outside 0.05 to 3 times the width at rest."
        raise InputError("width", problem, "Give every width as a multiple of the width at rest.")
    lines = (across, len(target)) if direction is Direction.COURSE else (len(target), across)
    check_chart_size(*lines)
    if across < 3 or across * len(target) > MAX_SHAPED_STITCHES:
        problem = f"{across} x {len(target)} stitches are too many to pull repeatedly."
        remedy = f"Use at least 3 across and at most {MAX_SHAPED_STITCHES} stitches."
        raise InputError("across", problem, remedy)
    check_positive("strain", strain, what="a stretch", most=5)
    check_range("smallest_band", smallest_band, 1, len(target), "lines")
    return target
