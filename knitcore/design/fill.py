"""Fill a field: a chart whose local moduli follow a map of targets.

A map that is (nearly) some chart's own gives that chart back (:mod:`knitcore.design.readback`). Any
other map is filled by patches (:mod:`knitcore.design.region_patches`): every region gets the repeat
with the nearest effective moduli, from an atlas or a mixture of two of its repeats
(:mod:`knitcore.design.mixtures`). Patches are fitted to their neighbours
(:mod:`knitcore.design.patch_placing`), measured in the finite swatch
(:mod:`knitcore.design.patch_check`), and chosen again where one misses its target there. The same
seed gives the same chart.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, InputError, SearchProgress
from knitcore.chart.stitch_chart import StitchChart, check_chart_size
from knitcore.cloth.flat.grid import check_cloth
from knitcore.design.atlas import Atlas
from knitcore.design.atlas_build import entry_of, predict_repeat
from knitcore.design.explain import OFF, Patch, unreached
from knitcore.design.mixtures import Mixer
from knitcore.design.patch_check import finite_size
from knitcore.design.patch_placing import placed
from knitcore.design.readback import EXACT, deviation, nearest_chart
from knitcore.design.region_patches import best_labels, connected, smooth, unevenness
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Interval
from knitcore.mechanics.local_moduli import LocalModuli, local_moduli, stitch_table

CLOSE = 0.03
"""A repeat of the atlas nearer than this (in logarithms) is taken as it is."""
MAX_MIXED = 8
"""Most patches that may hold a mixture of two repeats; the largest come first."""
MIN_MIXED = 48
"""Fewest stitches of a patch with a mixture."""
MAX_CHECKED = 20_000
"""Stitches of the largest chart that is pulled in the finite swatch."""
_CHECKS = 3
_NEARLY = 0.25
"""Largest rms deviation (in logarithms) of a map that is nearly a chart's own."""
_AS_GOOD = 1.25
"""A chart read back stitch by stitch may miss the map by this much more than patches do, as it
cannot fit a rough map by chance, but by no more than the map varies inside the patches: where a map
is even it asks for one stiffness, not for a rough chart."""


@dataclass(frozen=True, eq=False)
class FilledField:
    """A chart for a map.

    Attributes
    ----------
    chart : the stitches.
    patches : number of the patch of every stitch, into ``regions``; the number after the last for
        stitches that were kept.
    regions : the patches; none if the map is (nearly) a chart's own and was read back.
    local : local moduli of the chart.
    off_share : share of the stitches with a target that miss it by more than 10 % in either
        direction. Patches are judged by their effective moduli in the swatch (a single patch by
        those in a large cloth, because free edges are not part of it), a chart that was read back
        by its local moduli.
    messages : on targets that were not met.
    """

    chart: StitchChart
    patches: Indices
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
    parts: Indices | None = None,
    kept: StitchChart | None = None,
    stitch: Mask | None = None,
    smallest_patch: int = 4,
    scattered: bool = True,
    seed: int = 0,
    check: bool = True,
    progress: Callable[[float], None] | None = None,
    cancelled: Cancelled | None = None,
) -> FilledField:
    """A chart for target moduli.

    Parameters
    ----------
    modulus_course_n_per_mm, modulus_wale_n_per_mm : (rows, columns), row 0 at the bottom; NaN where
        there is no target.
    material : one yarn for the whole chart.
    atlas : of that material.
    parts : (rows, columns) numbers from 0 of the parts that were given one by one
        (:func:`knitcore.design.part_targets.target_parts`); a part narrower than a patch is one.
    kept : a chart whose stitches without a target stay as they are; the others are fitted to them
        and judged among them. Without it all stitches are filled.
    stitch : bool (rows, columns), where a shaped piece has stitches; elsewhere there is no target
        and no neighbour. All by default.
    smallest_patch : smallest side of a patch in stitches, where its part is not smaller.
    scattered : single stitches may be turned where that comes nearer; otherwise every patch is a
        repeat of the atlas, or stripes of two.
    seed : of the order in which stitches are tried.
    check : pull the chart in the finite swatch, and choose again where the result differs.
    progress : called with the share done.
    cancelled : asked between steps.

    Raises
    ------
    InputError
        If the maps do not fit or have no target, or the atlas is another material's.
    CancelledError
        If it was asked to stop.
    """
    target = _checked(modulus_course_n_per_mm, modulus_wale_n_per_mm, smallest_patch)
    if kept is not None and kept.purl.shape != target[0].shape:
        rows, columns = target[0].shape
        raise InputError(
            "chart",
            f"it has {kept.columns}x{kept.rows} stitches, the targets are for {columns}x{rows}.",
            "Give the chart that the targets were drawn on.",
        )
    if stitch is not None:
        check_cloth(stitch, *target[0].shape)
        if np.isnan(target[:, stitch]).all():
            raise InputError(
                "target", "there is no target inside the outline.", "Paint a target there."
            )
    atlas.check_material(material)
    if parts is None:
        parts = np.zeros(target.shape[1:], dtype=np.intp)
    watch = SearchProgress(progress, cancelled)
    fill = _Fill(target, parts, kept, stitch, material, atlas, scattered, seed, watch)
    return fill.run(smallest_patch, check=check and target[0].size <= MAX_CHECKED)


@dataclass(frozen=True)
class _Choice:
    """A repeat for a patch, with its effective moduli."""

    repeat: StitchChart
    log_moduli: Array


@dataclass(frozen=True, eq=False)
class _Trial:
    """A chart of chosen repeats, and each patch's finite-size factors (logarithms)."""

    chart: StitchChart
    choices: tuple[_Choice, ...]
    factors: Array
    score: float


class _Fill:
    """A single run that fills a field."""

    def __init__(
        self,
        target: Array,
        parts: Indices,
        kept: StitchChart | None,
        stitch: Mask | None,
        material: Material,
        atlas: Atlas,
        scattered: bool,
        seed: int,
        progress: SearchProgress,
    ) -> None:
        inside = np.ones(target.shape[1:], dtype=bool) if stitch is None else stitch
        self._target_map = np.where(inside, target, np.nan)
        self._parts, self._scattered = parts, scattered
        self._material, self._atlas, self._stitch = material, atlas, inside
        no_target = np.isnan(self._target_map).all(axis=0)
        self._fixed = ~inside if kept is None else no_target
        around = np.zeros_like(inside) if kept is None else kept.purl
        self._kept = StitchChart(around & inside)
        self._has_target = ~no_target
        self._seed, self._progress = seed, progress
        self._table = stitch_table(material)
        self._mixer: Mixer | None = None

    def run(self, smallest_patch: int, *, check: bool) -> FilledField:
        self._progress.look(0.01)
        own = self._beside_kept(nearest_chart(self._target_map, self._table))
        exact = float(np.nanmax(np.abs(deviation(own, self._target_map, self._table))))
        if exact <= EXACT:
            return self._read_back(own, "The map is exactly that of a chart, which was read back.")
        uneven = unevenness(self._atlas, self._table)
        chosen, cost = best_labels(self._atlas, uneven, *self._target_map)
        labels = smooth(cost, smallest_patch, self._parts)
        effective = self._atlas.log_moduli[chosen[labels]].transpose(2, 0, 1)
        patches = connected(np.where(self._fixed, len(chosen), labels))
        count = len(np.unique(patches[~self._fixed]))
        patches[self._fixed] = count  # labels are in order, so these were last
        first = np.unique(patches, return_index=True)[1][:count]
        medians = _spread(self._targets(patches, count), patches)
        rough = self._rms(deviation(own, self._target_map, self._table))
        uneven_map = self._rms(medians - self._target_map)
        if rough <= min(
            _NEARLY,
            _AS_GOOD * self._rms(effective - self._target_map),
            _AS_GOOD * uneven_map + EXACT,
        ):
            return self._read_back(own, "The map is nearly that of a chart, which was read back.")
        choices = [self._of_atlas(int(entry)) for entry in chosen[labels.ravel()[first]]]
        choices = self._mixed(patches, choices)
        best = self._trial(patches, choices, 0.45, check=check)
        for turn in range(1, _CHECKS if check else 1):
            again = self._chosen_again(patches, best)
            if again is None:
                break
            trial = self._trial(patches, again, 0.45 + 0.5 * turn / _CHECKS, check=True)
            if trial.score >= best.score:
                break
            best = trial
        return self._filled(patches, best, check=check)

    def _of_atlas(self, entry: int) -> _Choice:
        return _Choice(self._atlas.chart(entry), self._atlas.log_moduli[entry])

    def _mixed(self, patches: Indices, choices: list[_Choice]) -> list[_Choice]:
        """Mixtures, where they come nearer than repeats of the atlas."""
        targets = self._targets(patches, len(choices))
        off = np.nan_to_num(np.abs(np.stack([c.log_moduli for c in choices]) - targets)).max(axis=1)
        sizes = np.bincount(patches.ravel())
        large = [k for k in np.argsort(-sizes[: len(choices)]) if sizes[k] >= MIN_MIXED]
        poor = [k for k in large if off[k] > CLOSE][:MAX_MIXED]
        known: dict[tuple[float, ...], _Choice | None] = {}
        improved = list(choices)
        for count, patch in enumerate(poor):
            self._progress.look(0.45 * count / len(poor))
            rows, columns = _extent(patches == patch)
            key = (*np.nan_to_num(targets[patch].round(3)).tolist(), rows, columns)
            if key not in known:
                known[key] = self._mixture(targets[patch], rows, columns, off[patch])
            improved[patch] = known[key] or choices[patch]
        return improved

    def _mixture(self, target: Array, rows: int, columns: int, off: float) -> _Choice | None:
        if self._mixer is None:
            self._mixer = Mixer(self._atlas, self._material)
        mixture = self._mixer.nearest(
            *np.exp(target).tolist(),
            most_rows=min(rows, 12),
            most_columns=min(columns, 12),
            scattered=self._scattered,
            look=self._progress.stop_if_asked,
        )
        if mixture is None or mixture.off > 0.8 * off:
            return None
        return _Choice(mixture.repeat, mixture.log_moduli)

    def _chosen_again(self, patches: Indices, last: _Trial) -> list[_Choice] | None:
        """The nearest repeats, given each patch's factors in the swatch; None if none changes."""
        targets = self._targets(patches, len(last.choices)) - last.factors
        if self._is_alone(last.choices):
            return None
        improved = list(last.choices)
        for patch, choice in enumerate(last.choices):
            off = np.nan_to_num(np.abs(self._atlas.log_moduli - targets[patch])).max(axis=1)
            entry = int(off.argmin())
            own = float(np.nan_to_num(np.abs(choice.log_moduli - targets[patch])).max())
            if own > CLOSE and off[entry] < 0.8 * own:
                improved[patch] = self._of_atlas(entry)
        changed = any(a is not b for a, b in zip(improved, last.choices, strict=True))
        return improved if changed else None

    def _trial(
        self, patches: Indices, choices: list[_Choice], start: float, *, check: bool
    ) -> _Trial:
        repeats = [choice.repeat for choice in choices]
        chart = placed(
            patches,
            repeats,
            self._target_map,
            self._table,
            kept=self._kept,
            stitch=self._stitch,
            scattered=self._scattered,
            seed=self._seed,
            look=lambda share: self._progress.look(start + 0.15 * share),
        )
        factors = np.zeros((len(choices), 2))
        if check:
            factors = np.log(
                finite_size(
                    chart,
                    self._material,
                    patches,
                    repeats,
                    stitch=self._stitch,
                    cancelled=self._progress.cancelled,
                )
            )
        off = _spread(self._judged(choices, factors), patches) - self._target_map
        return _Trial(chart, tuple(choices), factors, self._off_share(off) + 0.1 * self._rms(off))

    def _targets(self, patches: Indices, count: int) -> Array:
        """(patches, 2) medians of the targets' logarithms, NaN where a patch has none."""
        medians = np.full((count, 2), np.nan)
        for patch in range(count):
            for axis, target in enumerate(self._target_map):
                here = target[patches == patch]
                if not np.isnan(here).all():
                    medians[patch, axis] = np.nanmedian(here)
        return medians

    def _rms(self, off: Array) -> float:
        return float(np.sqrt(np.nanmean(off**2)))

    def _read_back(self, chart: StitchChart, message: str) -> FilledField:
        self._progress.look(1.0)
        off = deviation(chart, self._target_map, self._table)
        return FilledField(
            chart,
            np.zeros(chart.purl.shape, dtype=np.intp),
            (),
            local_moduli(chart, self._material),
            self._off_share(off),
            (message,),
        )

    def _filled(self, patches: Indices, trial: _Trial, *, check: bool) -> FilledField:
        moduli = np.stack([choice.log_moduli for choice in trial.choices])
        targets = self._targets(patches, len(trial.choices))
        off, there = np.expm1(moduli - targets), np.full(moduli.shape, np.nan)
        if check:
            there = np.expm1(moduli + trial.factors - targets)
        judged = self._judged(trial.choices, trial.factors)
        regions = []
        for patch, choice in enumerate(trial.choices):
            cells = patches == patch
            row, column = np.argwhere(cells)[0].tolist()
            repeat = choice.repeat.key, int(cells.sum()), row, column
            course, wale = off[patch].tolist()
            swatch_course, swatch_wale = there[patch].tolist()
            deviations = course, wale, swatch_course, swatch_wale
            regions.append(Patch(*repeat, *deviations, *self._moduli(choice, judged[patch])))
        self._progress.look(1.0)
        return FilledField(
            trial.chart,
            patches,
            tuple(regions),
            local_moduli(trial.chart, self._material),
            self._off_share(_spread(judged, patches) - self._target_map),
            tuple(unreached(regions, targets, np.expm1(judged - targets), self._atlas.log_moduli)),
        )

    def _moduli(self, choice: _Choice, judged: Array) -> tuple[float, Interval, float, Interval]:
        """Moduli of a patch, with intervals from those of a large cloth to those of the patch."""
        entry = self._atlas.index_of(choice.repeat)
        row = (
            entry_of(predict_repeat(choice.repeat, self._material)).values
            if entry is None
            else self._atlas.values[entry].tolist()
        )
        course, wale = np.exp(judged).tolist()
        by_course, by_wale = np.exp(judged - choice.log_moduli).tolist()
        return course, _reaching(row[1:3], by_course), wale, _reaching(row[4:6], by_wale)

    def _beside_kept(self, chart: StitchChart) -> StitchChart:
        """The chart, or its K/P exchange, where there are targets; the kept chart elsewhere."""
        if not self._fixed.any():
            return chart
        charts = [
            StitchChart(np.where(self._fixed, self._kept.purl, chart.purl ^ swap))
            for swap in (False, True)
        ]
        return min(charts, key=lambda c: self._rms(deviation(c, self._target_map, self._table)))

    def _off_share(self, off: Array) -> float:
        """Share of stitches with a target that miss it by more than 10 % (logarithms)."""
        missed = (np.abs(np.expm1(off)) > OFF).any(axis=0)
        return float(np.mean(missed, where=self._has_target))

    def _is_alone(self, choices: Sequence[_Choice]) -> bool:
        """Say whether a single patch covers all stitches."""
        return len(choices) == 1 and not self._fixed.any()

    def _judged(self, choices: Sequence[_Choice], factors: Array) -> Array:
        """(patches, 2) logarithms of moduli in the swatch; of a lone patch, in a large cloth."""
        moduli = np.stack([choice.log_moduli for choice in choices])
        return moduli if self._is_alone(choices) else moduli + factors


def _spread(values: Array, patches: Indices) -> Array:
    """(2, rows, columns) of values (patches, 2); NaN at stitches that are kept."""
    known = np.vstack([values, np.full(2, np.nan)])
    return known[patches].transpose(2, 0, 1)


def _reaching(ends: Sequence[float], factor: float) -> Interval:
    """The interval of a large cloth, widened as far as the factor of a small patch moves it."""
    low, high = ends
    return Interval(low * min(factor, 1.0), high * max(factor, 1.0))


def _extent(cells: Mask) -> tuple[int, int]:
    rows, columns = (np.flatnonzero(cells.any(axis=axis)) for axis in (1, 0))
    return int(np.ptp(rows)) + 1, int(np.ptp(columns)) + 1


def _checked(course: Array, wale: Array, smallest_patch: int) -> Array:
    maps = [np.asarray(course, dtype=float), np.asarray(wale, dtype=float)]
    if maps[0].ndim != 2 or maps[0].shape != maps[1].shape:
        raise InputError("target", "the two maps differ in size.", "Give rows x columns for both.")
    check_chart_size(*maps[0].shape)
    both = np.stack(maps)
    if np.isnan(both).all():
        raise InputError("target", "there is no target anywhere.", "Paint at least one stitch.")
    given = both[~np.isnan(both)]
    if not (np.isfinite(given).all() and (given > 0).all()):
        raise InputError("target", "a target modulus is not positive.", "Give N/mm above 0.")
    check_range("smallest_patch", smallest_patch, 1, 100, what="a size")
    logarithms: Array = np.log(both)
    return logarithms
