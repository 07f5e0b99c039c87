"""Response of a mixed chart, learned from yarn-level simulations: milliseconds for any chart.

The mixture of the pure fabrics by their shares (:mod:`knitcore.prediction.mixture`) is corrected in
two steps, each a kernel regression on the chart's densities and the yarn's dimensionless numbers:

1. *Folding*: logarithms of relaxed width and height over those of the mixture.
2. *Unfolding*: logarithms of the strain over that of the mixture, at six stresses and in both
   directions, for a given folding. A fabric that is narrower at rest stretches further to nearly
   the same stretched size, so that d ln strain / d ln size is ``slope * (1 + e) / (e + 0.15)``,
   with slopes about -0.9.

A known size (a gauge, or a relaxation at the yarn level) replaces the first step. Stress is
compared in units of B / L³. ``scripts/training/learned.py`` fits both regressions, calibrates
their intervals on charts left out, and reports the errors for those. Real fabric folds less than
the yarn level predicts: see :data:`MAX_FOLDED`.
"""

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.base.gaussian_process import KernelModel, KernelSettings, Samples
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import Material, Origin
from knitcore.materials.interval_parts import Part, Variances, added, deviation, shared_out
from knitcore.prediction.densities import Densities, densities
from knitcore.prediction.mixture import Mixture, present, pure_numbers
from knitcore.prediction.size import RelaxedSize

STRESS_GRID = np.array([400.0, 800.0, 2000.0, 4000.0, 8000.0, 12000.0])
"""Stresses over B / L³ at which strains are learned: about 0.01 to 0.3 N/mm."""

MAX_FOLDED = 0.87
"""Knitted fabric folds less than the yarn level predicts, which has no friction and no set. In
logarithms a fold f becomes f / (1 + |f| / MAX_FOLDED), times the squared straightness of the fold
lines, since folds that cross hinder each other, and the evenness of the runs beside them, since a
short run cannot hide a long one. The number and the power were chosen on the 29 swatches of KnitDB
(studies/knitdb.py, which judges the choice on textures left out)."""

SHOWN_LOG_SD = 0.066
"""Standard deviation of the logarithm of a swatch's width or height, on those textures."""


_TOE = 0.15
"""Strain below which a fabric has not yet unfolded by as much as it was folded."""


@dataclass(frozen=True, eq=False)
class SweptChart:
    """The result of a sweep, used in place of the regressions.

    Attributes
    ----------
    folding : (2,) logarithms of width and height over those of the mixture at the yarn level.
    unfolding : (14,) logarithms of strain over the mixture's, and Poisson's ratios less the
        mixture's, without the part that follows the folding.
    """

    folding: Array
    unfolding: Array


@dataclass(frozen=True, eq=False, repr=False)
class LearnedResponse(Result):
    """Size and response of a mixed chart.

    Attributes
    ----------
    size_mm : (2,) width and height of the mean stitch at rest.
    size_parts : (2,) variances of their logarithms, by part.
    mixture : the mixture of pure fabrics that was corrected.
    log_ratio : (2, stresses) ln of strain over that of the mixture, by direction.
    log_ratio_parts : (2, stresses) its variances, by part.
    poisson : (2,) nu_yx and nu_xy: mean slopes up to 0.3 N/mm.
    poisson_parts : (2,) their variances, by part.
    """

    size_mm: Array
    size_parts: Variances
    mixture: Mixture
    log_ratio: Array
    log_ratio_parts: Variances
    poisson: Array
    poisson_parts: Variances

    @property
    def size_log_sd(self) -> Array:
        """(2,) standard deviations of the logarithms of width and height."""
        return deviation(self.size_parts)

    @property
    def log_ratio_sd(self) -> Array:
        """(2, stresses) standard deviations of the corrections."""
        return deviation(self.log_ratio_parts)

    def strain(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Strain at stresses (N/mm, at least 0)."""
        ratio = np.exp(self._at(self.log_ratio, direction, stress_n_per_mm))
        return np.asarray(ratio * self.mixture.strain(direction, stress_n_per_mm))

    def across_strain(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Strain across the pull at stresses (N/mm, at least 0).

        Poisson's ratio at first; with more stress it changes as the mixture's contraction does.
        """
        first, share = (
            self.mixture.shares_of_strain(direction, stress)[0] for stress in (0.0, stress_n_per_mm)
        )
        share = share - first - self.poisson[direction.axis]
        return np.asarray(share * self.strain(direction, stress_n_per_mm))

    def held_strain(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Strain at stresses (N/mm, at least 0) while the width is held.

        No sweep holds the width, so this takes the mixture's ratio of held to free strain.
        """
        share = self.mixture.shares_of_strain(direction, stress_n_per_mm)[1]
        return np.asarray(share * self.strain(direction, stress_n_per_mm))

    def strain_log_sd(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        """Standard deviation of the log strain: of the learning, and of the pure fabrics' laws."""
        own = self._at(self.log_ratio_sd, direction, stress_n_per_mm)
        return np.asarray(np.hypot(own, self.mixture.log_sd(direction, stress_n_per_mm)))

    def strain_parts(self, direction: Direction, stress_n_per_mm: ArrayLike) -> Variances:
        """Variances of the log strain, by part; those of the modulus where there is no stress."""
        first = STRESS_GRID[0] * self.mixture.bending_stress_n_per_mm
        stress = np.where(np.asarray(stress_n_per_mm) > 0, stress_n_per_mm, first)
        own = np.square(self._at(self.log_ratio_sd, direction, stress))
        among = {part: self._at(of, direction, stress) for part, of in self.log_ratio_parts.items()}
        return added([shared_out(own, among), *self.mixture.variances(direction, stress)])

    def modulus_n_per_mm(self, direction: Direction) -> float:
        """Initial Young's modulus."""
        ratio = np.exp(self.log_ratio[direction.axis, 0])
        return float(self.mixture.modulus_n_per_mm(direction) / ratio)

    def modulus_log_sd(self, direction: Direction) -> float:
        """Standard deviation of the log modulus."""
        first = STRESS_GRID[0] * self.mixture.bending_stress_n_per_mm
        return float(self.strain_log_sd(direction, first))

    def _at(self, values: Array, direction: Direction, stress_n_per_mm: ArrayLike) -> Array:
        stress = np.asarray(stress_n_per_mm, dtype=float) / self.mixture.bending_stress_n_per_mm
        at = np.log(np.maximum(stress, STRESS_GRID[0]))
        return np.asarray(np.interp(at, np.log(STRESS_GRID), values[direction.axis]))


def learned(
    chart: StitchChart, material: Material, size: RelaxedSize | None = None
) -> LearnedResponse:
    """Size and response of a chart that repeats indefinitely.

    Parameters
    ----------
    chart : the repeat.
    material : a yarn at one setting, with the pure fabrics that the chart is made of.
    size : its relaxed size, if known.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.

    Examples
    --------
    >>> from knitcore.materials import material
    >>> rib = learned(StitchChart.parse("KKPP"), material("acrylic"))
    >>> bool(rib.size_mm[0] < material("acrylic").record("rib").stitch_course_mm)  # folds deeper
    True
    """
    return packaged_model().response(densities(chart), material, size)


@dataclass(frozen=True, eq=False)
class LearnedModel:
    """The learned model: both regressions, with their samples and scales.

    Attributes
    ----------
    charts : text of each sample's chart, rows from the top separated by ``/``.
    feature_scale, number_centre, number_scale : units of the samples.
    folding, unfolding : the regressions; of ``unfolding`` the outputs are 12 strains and 2 Poisson
        ratios.
    slopes : (14, 2) for each output: derivatives by ln width and ln height.
    folding_scale, unfolding_scale : (4, 2), (4, 14) standard deviation over the root of the
        regression's variance, such that 90 % of the left-out values lie in their 90 % intervals,
        by ways (:class:`knitcore.prediction.densities.Densities`). A chart has their mean.
    sweeps : of each sample; None where it was only relaxed.
    """

    charts: tuple[str, ...]
    feature_scale: Array
    number_centre: Array
    number_scale: Array
    folding: KernelModel
    unfolding: KernelModel
    slopes: Array
    folding_scale: Array
    unfolding_scale: Array
    sweeps: tuple[SweptChart | None, ...]

    def response(
        self,
        composition: Densities,
        material: Material,
        size: RelaxedSize | None = None,
        swept: SweptChart | None = None,
    ) -> LearnedResponse:
        """Size and response of one chart with these densities, as :meth:`responses`."""
        alone = Densities(*(values[None] for values in composition.arrays))
        return self.responses(alone, material, [size], swept)[0]

    def responses(
        self,
        compositions: Densities,
        material: Material,
        sizes: Sequence[RelaxedSize | None],
        swept: SweptChart | None = None,
    ) -> list[LearnedResponse]:
        """Sizes and responses of several charts, by their densities and known sizes.

        The sweep of a single chart takes the place of the regressions. Its variance is their noise:
        whatever densities do not explain, such as which of several shapes the simulation settled
        in.
        """
        mixtures = Mixture.each(compositions.shares, material)
        if swept is None:
            numbers = np.array([mixture.numbers for mixture in mixtures])
            samples = self.sample(compositions.features, numbers)
            folding = [*zip(*self.folding(samples), strict=True)]
            unfolding = [*zip(*self.unfolding(samples), strict=True)]
        else:
            folding = [(swept.folding, self.folding.settings.noise)]
            unfolding = [(swept.unfolding, self.unfolding.settings.noise)]
        charts = zip(compositions, mixtures, sizes, folding, unfolding, strict=True)
        return [self._corrected(*chart) for chart in charts]

    def _corrected(
        self,
        composition: Densities,
        mixture: Mixture,
        size: RelaxedSize | None,
        folding: tuple[Array, float],
        unfolding: tuple[Array, float],
    ) -> LearnedResponse:
        """Correct a mixture, from means and variances of folding and unfolding."""
        slopes = self.slopes * follows(mixture)
        flat_mm = mixture.size_mm
        if size is not None:
            fold = np.log(np.array([size.course_mm, size.wale_mm]) / flat_mm)
            size_parts = {Part.SIZE: np.full(2, size.log_sd**2)}
        else:
            fold, fold_sd = self.folded(*folding, composition, simulated=mixture.simulated)
            size_parts = {Part.SIZE: fold_sd**2}
        mean, variance = unfolding
        values = mean + slopes @ fold
        spread = composition.uncertainty @ self.unfolding_scale
        parts = {
            Part.SIZE: slopes**2 @ size_parts[Part.SIZE],
            Part.SURROUNDINGS: spread**2 * variance,
        }
        return LearnedResponse(
            size_mm=flat_mm * np.exp(fold),
            size_parts=size_parts,
            mixture=mixture,
            log_ratio=values[:12].reshape(2, -1),
            log_ratio_parts={part: of[:12].reshape(2, -1) for part, of in parts.items()},
            poisson=mixture.poisson + values[12:],
            poisson_parts={part: of[12:] for part, of in parts.items()},
        )

    def folded(
        self, fold: Array, variance: ArrayLike, composition: Densities, *, simulated: bool
    ) -> tuple[Array, Array]:
        """Logarithms of size over the mixture's and their standard deviations, (…, 2) each.

        Parameters
        ----------
        fold, variance : (…, 2), (…) at the yarn level.
        simulated : for yarn-level fabric, which folds more than knitted fabric.
        """
        deviation = composition.uncertainty @ self.folding_scale * np.sqrt(variance)[..., None]
        if simulated:
            return fold, deviation
        shown = composition.straight**2 * composition.even / (1.0 + np.abs(fold) / MAX_FOLDED)
        rest = SHOWN_LOG_SD * np.asarray(composition.mixed)[..., None]
        return shown * fold, np.hypot(rest, shown * deviation)

    def relaxed_mm(self, composition: Densities, material: Material) -> Array:
        """(m, 2) relaxed width and height of m charts.

        Raises
        ------
        InputError
            If the material lacks a pure fabric with a share.
        """
        shares = composition.shares
        phases = present(shares)
        records = [material.record(PHASES[phase]) for phase in phases]
        flat = shares[:, phases] @ [(r.stitch_course_mm, r.stitch_wale_mm) for r in records]
        of_fabrics = pure_numbers(material, phases)[phases, :-1]
        share = shares[:, phases, None]
        numbers = np.where(share > 0, share * of_fabrics, 0.0).sum(axis=1)
        samples = self.sample(composition.features, numbers)
        simulated = all(record.origin is Origin.SIMULATED for record in records)
        fold, _ = self.folded(*self.folding(samples), composition, simulated=simulated)
        return np.asarray(flat * np.exp(fold))

    def sweep_of(self, chart: StitchChart, material: Material) -> SweptChart | None:
        """The sweep of a chart among the samples, if it was of the material's yarn."""
        composition = densities(chart)
        mixture = Mixture.of(composition.shares, material)
        yarn = self.sample(composition.features[None], mixture.numbers[None]).numbers
        key, numbers = chart.canonical().key, self.folding.samples.numbers
        return next(
            (
                sweep
                for text, own, sweep in zip(self.charts, numbers, self.sweeps, strict=True)
                if text == key and np.allclose(own, yarn)
            ),
            None,
        )

    def sample(self, features: Array, numbers: Array) -> Samples:
        """Scale features of charts (m, features) and numbers of yarns (m, 4) as the samples are.

        An unknown number (nan) of a yarn is taken as that of a yarn in the middle.
        """
        scaled = (numbers - self.number_centre) / self.number_scale
        none_pure = np.zeros(len(features), dtype=bool)
        return Samples(features / self.feature_scale, np.nan_to_num(scaled), none_pure)


def follows(mixture: Mixture) -> Array:
    """(14, 1): (1 + e) / (e + 0.15) with the mixture's strains e, and 1 for Poisson's ratios."""
    stress = STRESS_GRID * mixture.bending_stress_n_per_mm
    strains = np.concatenate([mixture.strain(d, stress) for d in Direction])
    return np.append((1.0 + strains) / (strains + _TOE), [1.0, 1.0])[:, None]


_fitting = threading.Lock()


def packaged_model(left_out: frozenset[str] = frozenset()) -> LearnedModel:
    """The model that comes with the package, fitted to its samples as it is loaded.

    Parameters
    ----------
    left_out : keys of charts (:attr:`StitchChart.key`, canonical) to leave out, for tests.
    """
    with _fitting:  # a second thread waits for the first, which takes half as long as two fits
        return _fitted(left_out)


@cache
def _fitted(left_out: frozenset[str]) -> LearnedModel:
    path = files("knitcore.prediction") / "data" / "learned.npz"
    with path.open("rb") as stream, np.load(stream) as stored:
        arrays = {name: stored[name] for name in stored.files}
    kept = ~np.isin(arrays["charts"], list(left_out))
    samples = Samples(
        np.asarray(arrays["features"], dtype=float)[kept],
        np.asarray(arrays["numbers"], dtype=float)[kept],
        np.asarray(arrays["pure"], dtype=bool)[kept],
    )
    folding = np.asarray(arrays["folding"], dtype=float)[kept]
    unfolding = np.asarray(arrays["unfolding"], dtype=float)[kept]
    swept = np.isfinite(unfolding).all(axis=1)
    return LearnedModel(
        charts=tuple(str(text) for text in arrays["charts"][kept]),
        feature_scale=np.asarray(arrays["feature_scale"], dtype=float),
        number_centre=np.asarray(arrays["number_centre"], dtype=float),
        number_scale=np.asarray(arrays["number_scale"], dtype=float),
        folding=KernelModel.fit(
            KernelSettings(*map(float, arrays["folding_settings"])), samples, folding
        ),
        unfolding=KernelModel.fit(
            KernelSettings(*map(float, arrays["unfolding_settings"])),
            samples[swept],
            unfolding[swept],
        ),
        slopes=np.asarray(arrays["slopes"], dtype=float),
        folding_scale=np.asarray(arrays["folding_scale"], dtype=float),
        unfolding_scale=np.asarray(arrays["unfolding_scale"], dtype=float),
        sweeps=tuple(
            SweptChart(*both) if both_known else None
            for *both, both_known in zip(folding, unfolding, swept, strict=True)
        ),
    )
