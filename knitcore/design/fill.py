"""Fill a field: a chart whose local moduli follow a map of targets.

A map that is (nearly) some chart's own gives that chart back (:mod:`knitcore.design.readback`). Any
other map is filled by patches (:mod:`knitcore.design.region_patches`): every region gets the repeat
with the nearest effective moduli, from an atlas or a mixture of two of its repeats
(:mod:`knitcore.design.mixtures`). Patches are fitted to their neighbours
(:mod:`knitcore.design.patch_placing`), measured in the finite swatch
(:mod:`knitcore.design.patch_check`), and chosen again where one misses its target there. Parts with
a target each (:mod:`knitcore.design.part_targets`) are patches by themselves; a part that cannot be
brought nearer to its target stays as it is. The same seed gives the same chart.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, InputError, SearchProgress
from knitcore.base.kinds import as_numbers
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, check_chart_size
from knitcore.cloth.flat.grid import check_cloth
from knitcore.design.atlas import Atlas
from knitcore.design.atlas_build import entry_of, predict_repeat
from knitcore.design.explain import OFF, Patch, left_alone, unreached
from knitcore.design.mixtures import Mixer
from knitcore.design.part_targets import FilledPart, PartsNow, PartTarget, target_parts
from knitcore.design.patch_check import finite_size
from knitcore.design.patch_placing import placed
from knitcore.design.readback import EXACT, deviation, nearest_chart
from knitcore.design.region_patches import EVENNESS, best_labels, connected, smooth, unevenness
from knitcore.garment.shaped import largest_rectangle
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import Interval
from knitcore.mechanics.local_moduli import LocalModuli, local_moduli, stitch_table
from knitcore.prediction.predict import predict

CLOSE = 0.03
"""A repeat of the atlas nearer than this (in logarithms) is taken as it is."""
MAX_MIXED = 8
"""Most patches that may hold a mixture of two repeats; the largest come first."""
MIN_MIXED = 48
"""Fewest stitches of a patch with a mixture."""
MAX_CHECKED = 20_000
"""Stitches of the largest chart that is pulled in the finite swatch."""
_CHECKS = 3
_TRIED = 8
"""Repeats that are tried in the size of a part."""
_NEARLY = 0.25
"""Largest rms deviation (in logarithms) of a map that is nearly a chart's own."""
_AS_GOOD = 1.25
"""A chart read back stitch by stitch may miss the map by this much more than patches do, as it
cannot fit a rough map by chance, but by no more than the map varies inside the patches: where a map
is even it asks for one stiffness, not for a rough chart."""


@dataclass(frozen=True, eq=False, repr=False)
class FilledField(Result):
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
    parts : what each part has now, beside what it had.
    messages : on targets that were not met.
    """

    chart: StitchChart
    patches: Indices
    regions: tuple[Patch, ...]
    local: LocalModuli
    off_share: float
    parts: tuple[FilledPart, ...]
    messages: tuple[str, ...]


def fill_field(
    modulus_course_n_per_mm: Array,
    modulus_wale_n_per_mm: Array,
    material: Material,
    atlas: Atlas,
    *,
    parts: Sequence[PartTarget] = (),
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
    parts : the targets that the maps were made of, if they were given part by part
        (:func:`knitcore.design.part_targets.target_maps`). Each part has a repeat of its own.
    kept : a chart whose stitches without a target stay as they are; the others are fitted to them
        and judged among them. A part that cannot be brought nearer to its target stays, too.
        Without such a chart all stitches are filled.
    stitch : bool (rows, columns), where a shaped piece has stitches; elsewhere there is no target
        and no neighbour. All by default.
    smallest_patch : smallest side of a patch in stitches, where its part is not smaller.
    scattered : single stitches may be turned where that comes nearer; otherwise every patch is a
        repeat of the atlas, or stripes of two.
    seed : of the order in which stitches are tried.
    check : pull the chart in the finite swatch, and choose again where the result differs. Parts
        are judged by what is predicted for them, as they were before.
    progress : called with the share done.
    cancelled : asked between steps.

    Raises
    ------
    InputError
        If the maps do not fit or have no target, a part lies wholly outside the piece, or the atlas
        is another material's.
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
    watch = SearchProgress(progress, cancelled)
    fill = _Fill(target, parts, kept, stitch, material, atlas, scattered, seed, watch)
    return fill.run(smallest_patch, check=check and not parts and target[0].size <= MAX_CHECKED)


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
        parts: Sequence[PartTarget],
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
        self._parts = PartsNow(parts, inside, kept, material)
        self._parts.check_inside()
        self._scattered = scattered
        self._material, self._atlas, self._stitch = material, atlas, inside
        no_target = np.isnan(self._target_map).all(axis=0)
        self._fixed = ~inside if kept is None else no_target
        around = np.zeros_like(inside) if kept is None else kept.purl
        self._kept = StitchChart(around & inside)
        self._has_target = ~no_target
        self._seed, self._progress = seed, progress
        self._table = stitch_table(material)
        self._mixer: Mixer | None = None
        self._known_cuts: dict[tuple[StitchChart, int, int], Array] = {}

    def run(self, smallest_patch: int, *, check: bool) -> FilledField:
        self._progress.look(0.01)
        if self._parts.targets:
            patches, choices = self._by_parts()
        else:
            own = self._beside_kept(nearest_chart(self._target_map, self._table))
            off = deviation(own, self._target_map, self._table)
            if float(np.nanmax(np.abs(off))) <= EXACT:
                return self._read_back(own, "exactly")
            patches, choices, even_off = self._by_map(smallest_patch)
            if self._rms(off) <= min(_NEARLY, even_off):
                return self._read_back(own, "nearly")
        plain, choices = choices, self._mixed(patches, choices)
        farther = [k for k, choice in enumerate(choices) if not self._brings(patches == k, choice)]
        patches, choices, plain = self._left_as_they_are(farther, patches, choices, plain)
        best = self._trial(patches, choices, 0.45, check=check)
        for turn in range(1, _CHECKS if check else 1):
            again = self._chosen_again(patches, best)
            if again is None:
                break
            trial = self._trial(patches, again, 0.45 + 0.5 * turn / _CHECKS, check=True)
            if trial.score >= best.score:
                break
            best = trial
        patches, best = self._without_worse(patches, best, plain)
        return self._filled(patches, best, check=check)

    def _by_map(self, smallest_patch: int) -> tuple[Indices, list[_Choice], float]:
        """Patches of a map with their repeats, and how far a chart read back may be off."""
        uneven = unevenness(self._atlas, self._table)
        chosen, cost = best_labels(self._atlas, uneven, *self._target_map)
        labels = smooth(cost, smallest_patch)
        patches, first = self._patches(labels)
        medians = _spread(self._targets(patches, len(first)), patches)
        effective = self._atlas.log_moduli[chosen[labels]].transpose(2, 0, 1)
        even_off = min(
            _AS_GOOD * self._rms(effective - self._target_map),
            _AS_GOOD * self._rms(medians - self._target_map) + EXACT,
        )
        return patches, [self._of_atlas(int(e)) for e in chosen[labels.ravel()[first]]], even_off

    def _by_parts(self) -> tuple[Indices, list[_Choice]]:
        """A patch for each connected part, with the repeat that suits it best."""
        numbers = target_parts(self._parts.targets, *self._stitch.shape)
        price = EVENNESS * unevenness(self._atlas, self._table)
        patches, first = self._patches(numbers)
        chosen = {
            number: self._nearest_entry((numbers == number) & self._stitch, price)
            for number in dict.fromkeys(numbers.ravel()[first].tolist())
        }
        return patches, [chosen[number] for number in numbers.ravel()[first].tolist()]

    def _nearest_entry(self, cells: Mask, price: Array) -> _Choice:
        """The repeat that is nearest to the target in a part of this size, where it is cut off.

        Tried are those nearest in a large cloth. Those that bring all targets nearer come first.
        """
        row, column = np.argwhere(cells)[0]
        target = self._target_map[:, row, column]
        cost = np.nansum((self._atlas.log_moduli - target) ** 2, axis=1) + price
        allowed = self._may_hold(cells, self._atlas.log_moduli)
        order = np.argsort(cost.round(6), kind="stable")
        tried = list(dict.fromkeys([*order[allowed[order]][:_TRIED], *order[:_TRIED]]))
        rows, columns = (part.stop - part.start for part in largest_rectangle(cells))
        by_place = []
        for entry in tried:
            log_moduli = self._cut(self._atlas.chart(entry), rows, columns)
            off = float(np.nansum((log_moduli - target) ** 2) + price[entry])
            by_place.append((not self._may_hold(cells, log_moduli), round(off, 6)))
        return self._of_atlas(int(tried[by_place.index(min(by_place))]))

    def _cut(self, repeat: StitchChart, rows: int, columns: int) -> Array:
        """(2,) logarithms of the moduli of a repeat in a patch of this size, where it is cut."""
        key = repeat, rows, columns
        if key not in self._known_cuts:
            cut = predict(repeat.resized(rows, columns), self._material)
            moduli = [cut.modulus_n_per_mm(direction) for direction in Direction]
            self._known_cuts[key] = np.log(moduli)
        return self._known_cuts[key]

    def _patches(self, labels: Indices) -> tuple[Indices, Indices]:
        """Connected patches of one label, fixed stitches last; and the first stitch of each."""
        last = int(labels.max()) + 1
        patches = connected(np.where(self._fixed, last, labels))
        count = len(np.unique(patches[~self._fixed]))
        patches[self._fixed] = count  # labels are in order, so these were last
        return patches, np.unique(patches, return_index=True)[1][:count]

    def _without_worse(
        self, patches: Indices, trial: _Trial, plain: list[_Choice]
    ) -> tuple[Indices, _Trial]:
        """Give back the parts that came no nearer to their targets, and fit the others again.

        A part that came no nearer with a mixture first gets its plain repeat.
        """
        while trial.choices:
            after = self._parts.log_moduli(trial.chart)
            worse = np.zeros_like(self._fixed)
            for part, cells in enumerate(self._parts.cells):
                if not self._parts.nearer(part, after[part]):
                    worse |= cells & ~self._fixed
            farther = [k for k in range(len(trial.choices)) if worse[patches == k].any()]
            if not farther:
                break
            choices = list(trial.choices)
            again = [k for k in farther if choices[k] is not plain[k]]
            for k in again:
                choices[k] = plain[k]
            if not again:
                patches, choices, plain = self._left_as_they_are(farther, patches, choices, plain)
            trial = self._trial(patches, choices, 0.8, check=False)
        return patches, trial

    def _left_as_they_are(
        self, left: list[int], patches: Indices, *choices: list[_Choice]
    ) -> tuple[Indices, list[_Choice], list[_Choice]]:
        """Fix the stitches of some patches, and number the others again."""
        self._fixed = self._fixed | np.isin(patches, left)
        staying = [k for k in range(len(choices[0])) if k not in left]
        number = np.full(len(choices[0]) + 1, len(staying))
        number[staying] = np.arange(len(staying))
        first, second = ([each[k] for k in staying] for each in choices)
        return number[patches], first, second

    def _of_atlas(self, entry: int) -> _Choice:
        return _Choice(self._atlas.chart(entry), self._atlas.log_moduli[entry])

    def _mixed(self, patches: Indices, choices: list[_Choice]) -> list[_Choice]:
        """Mixtures, where they come nearer than repeats of the atlas."""
        targets = self._targets(patches, len(choices))
        off = np.nan_to_num(np.abs(_moduli_of(choices) - targets)).max(axis=1)
        off[[not self._brings(patches == k, choice) for k, choice in enumerate(choices)]] = np.inf
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
            mixture = known[key]
            if mixture is not None and self._brings(patches == patch, mixture):
                improved[patch] = mixture
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

    def _brings(self, cells: Mask, choice: _Choice) -> bool:
        """Tell whether a repeat brings the parts of a patch of this size nearer."""
        if not self._parts.targets:
            return True
        rows, columns = (part.stop - part.start for part in largest_rectangle(cells))
        return bool(self._may_hold(cells, self._cut(choice.repeat, rows, columns)))

    def _may_hold(self, cells: Mask, log_moduli: Array) -> Mask:
        """Tell which moduli (..., 2) bring all parts of a patch nearer to their targets."""
        allowed = np.ones(log_moduli.shape[:-1], dtype=bool)
        for part in self._parts.of(*np.argwhere(cells)[0]):
            allowed &= self._parts.nearer(part, log_moduli)
        return allowed

    def _trial(
        self, patches: Indices, choices: list[_Choice], start: float, *, check: bool
    ) -> _Trial:
        if not choices:
            return _Trial(self._kept, (), np.zeros((0, 2)), 0.0)
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

    def _read_back(self, chart: StitchChart, how: str) -> FilledField:
        self._progress.look(1.0)
        off = deviation(chart, self._target_map, self._table)
        return FilledField(
            chart,
            np.zeros(chart.purl.shape, dtype=np.intp),
            (),
            local_moduli(chart, self._material),
            self._off_share(off),
            (),
            (f"The map is {how} that of a chart, which was read back.",),
        )

    def _filled(self, patches: Indices, trial: _Trial, *, check: bool) -> FilledField:
        moduli = _moduli_of(trial.choices)
        targets = self._targets(patches, len(trial.choices))
        off, there = np.expm1(moduli - targets), np.full(moduli.shape, np.nan)
        if check:
            there = np.expm1(moduli + trial.factors - targets)
        judged = self._judged(trial.choices, trial.factors)
        predicted = self._parts.log_moduli(trial.chart)
        regions = []
        for patch, choice in enumerate(trial.choices):
            cells = patches == patch
            row, column = np.argwhere(cells)[0].tolist()
            name = ""
            for part in self._parts.of(row, column):
                name, judged[patch] = self._parts.targets[part].name, predicted[part]
            repeat = name, choice.repeat.key, int(cells.sum()), row, column
            course, wale = off[patch].tolist()
            swatch_course, swatch_wale = there[patch].tolist()
            deviations = course, wale, swatch_course, swatch_wale
            regions.append(Patch(*repeat, *deviations, *self._moduli(choice, judged[patch])))
        have = self._atlas.log_moduli
        messages = unreached(regions, targets, np.expm1(judged - targets), have)
        now = _spread(judged, patches)
        repainted = np.array([(c & ~self._fixed).any() for c in self._parts.cells], dtype=bool)
        parts = self._parts.filled(predicted, repainted, self._atlas)
        for part in np.flatnonzero(~repainted).tolist():
            name, target = self._parts.targets[part].name, self._parts.log_target[part]
            log_now, nearest = self._parts.log_now[part], parts[part].nearest
            messages.append(left_alone(name, target, log_now, nearest))
            left = self._parts.cells[part] & self._fixed
            now[:, left] = self._parts.log_now[part][:, None]
        self._progress.look(1.0)
        return FilledField(
            trial.chart,
            patches,
            tuple(regions),
            local_moduli(trial.chart, self._material),
            self._off_share(now - self._target_map),
            parts,
            tuple(messages),
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
        moduli = _moduli_of(choices)
        return moduli if self._is_alone(choices) else moduli + factors


def _moduli_of(choices: Sequence[_Choice]) -> Array:
    """(choices, 2) logarithms of their moduli."""
    return np.array([choice.log_moduli for choice in choices]).reshape(-1, 2)


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
    remedy = "Give rows x columns of N/mm for both."
    maps = [as_numbers("target", values, remedy) for values in (course, wale)]
    if maps[0].ndim != 2 or maps[0].shape != maps[1].shape:
        raise InputError("target", "the two maps differ in size.", remedy)
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
