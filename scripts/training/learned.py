"""Fit the learned model: ``python -m scripts.training.learned``.

Reads the packaged store and the training library and writes the library's ``learned.npz``:
samples, settings (largest marginal likelihood), slopes, and scales calibrated on charts left out in
ten folds. Prints the errors for the charts left out. A minute of CPU time.
"""

import sys
from collections.abc import Iterator
from dataclasses import astuple, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, cho_solve, cholesky
from scipy.optimize import linprog, minimize

from knitcore.base.arrays import Array
from knitcore.base.gaussian_process import KernelModel, KernelSettings, Samples, noisy_covariance
from knitcore.chart.fabric import PHASES, Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import FabricRecord, Material, Yarn, load_library
from knitcore.materials.law_uncertainty import COVERAGE, Z_SCORE
from knitcore.prediction.densities import FEATURES, Densities, densities
from knitcore.prediction.learned import STRESS_GRID, follows
from knitcore.prediction.mixture import Mixture, yarn_numbers
from knitcore.prediction.swept import STRESS, of_law, over_mixture, simulated_record
from knitcore.yarn.library.store import MATERIALS, stored_charts, stored_stitch
from knitcore.yarn.model.yarn_model import YarnModel
from scripts.training.entries import TrainingEntry, training_entries

FILE = Path(__file__).parents[2] / "knitcore" / "prediction" / "data" / "learned.npz"

NUMBER_CENTRE = np.array([np.log(0.056), np.log(0.0255), np.log(0.25), 2.65])
NUMBER_SCALE = np.array([0.15, 0.12, 1.0, 0.25])
"""Middle and spread of the library's yarns: ln r/L, ln core/L, ln k r⁴L/B, contact exponent."""

_FOLDS = 10
_FIRST_SLOPE = -0.8
_TUNED = [2, 3, 4, 8, 9, 10]
"""Outputs that decide the settings: strains from 0.05 N/mm on, where stored laws are right."""
_FOLDING_COVERAGE = np.array([0.94, 0.94, 0.96, 0.96])
"""Shares of left-out sizes inside their intervals, by ways. Errors of folding have long tails that
strains amplify; with these shares the intervals of strains cover about 90 %."""
_WEIGHTS = {
    "shares": 2.7,
    "sides": 1.0,
    "products of two": 0.25,
    "products of four": 2.5,
    "plates": 2.25,
    "smoothed": 1.6,
}
"""Weights of the kinds of features, in units of their spread: rounded from the largest marginal
likelihood, and similar for both regressions."""
_START = KernelSettings(1.0, 0.1, 0.5, 2.0, 2.0, 0.05)
_BOUNDS = ((-8, 5), (-8, 3), (-8, 5), (-1.5, 5), (-1.5, 5), (-6, 1))
"""Bounds of the logarithms of the settings."""


@dataclass(frozen=True, eq=False)
class Row:
    """One chart of one yarn.

    Attributes
    ----------
    chart : its repeat.
    yarn_name : its yarn.
    features, numbers : as the model takes them, in their own units.
    fold : (2,) ln of size over the mixture's.
    ratio : (14,) ln of strain over the mixture's, and Poisson's ratios less the mixture's; nan
        where it was not stretched.
    uncertainty : (4,) see :class:`knitcore.prediction.densities.Densities`.
    follows : (14,) see :func:`knitcore.prediction.learned.follows`.
    """

    chart: StitchChart
    yarn_name: str
    features: Array
    numbers: Array
    fold: Array
    ratio: Array
    uncertainty: Array
    follows: Array

    @property
    def pure(self) -> bool:
        """Tell whether the chart is a pure fabric."""
        return self.chart in _PURE


_PURE = {StitchChart.of_fabric(fabric).canonical(): fabric for fabric in PHASES}


def simulated_materials() -> dict[str, Material]:
    """Yarns of the store and of the training library as materials, by name.

    Their pure fabrics have the yarn level's sizes and laws, with which mixed charts of the same
    yarn are compared.
    """
    records: dict[str, dict[Fabric, FabricRecord]] = {}
    for name in MATERIALS:
        for chart, fabric in _PURE.items():
            stored = stored_stitch(chart, name)
            if stored is not None and stored.law is not None:
                size = stored.cell_course_mm, stored.cell_wale_mm
                record = simulated_record(fabric, size, stored.law, stored.loop_length_mm)
                records.setdefault(name, {})[fabric] = record
    for entry in training_entries():
        pure = _PURE.get(entry.chart.canonical())
        if pure is not None and entry.law is not None and entry.cell_mm is not None:
            record = simulated_record(pure, entry.cell_mm, entry.law, entry.loop_length_mm)
            records.setdefault(entry.yarn_name, {}).setdefault(pure, record)
    return {name: Material(name, name, Yarn(), fabrics) for name, fabrics in records.items()}


def rows() -> list[Row]:
    """All charts that relaxed, with raw curves where there are any, else the store's laws; and the
    pure fabrics of the library's materials.
    """
    materials = simulated_materials()
    by_chart: dict[tuple[str, str], Row] = {}
    for entry in training_entries():
        if entry.cell_mm is None or not entry.converged:
            continue
        key = entry.yarn_name, entry.chart.canonical().key
        if key not in by_chart or entry.curves:
            row = _row_of_entry(entry, materials)
            if row is not None:
                by_chart[key] = row
    for name in MATERIALS:
        for chart in stored_charts(name):
            key = name, chart.key
            stored = stored_stitch(chart, name)
            if key in by_chart or stored is None or not stored.converged or stored.law is None:
                continue
            mixture, made_of = _mixture(chart, materials[name])
            size = stored.cell_course_mm, stored.cell_wale_mm
            by_chart[key] = _row(chart, name, mixture, made_of, size, *of_law(stored.law))
    return [*by_chart.values(), *_exact()]


def _exact() -> Iterator[Row]:
    """Pure fabrics of the library's materials: each is its own mixture, whatever the yarn."""
    for own in load_library().values():
        for chart, fabric in _PURE.items():
            if fabric in own.fabrics:
                mixture, made_of = _mixture(chart, own)
                if np.isfinite(mixture.numbers).all():
                    nothing = np.zeros(2), np.zeros(2 * len(STRESS_GRID) + 2)
                    described = made_of.features, mixture.numbers, *nothing, made_of.uncertainty
                    yield Row(chart, own.identifier, *described, follows(mixture)[:, 0])


def _row_of_entry(entry: TrainingEntry, materials: dict[str, Material]) -> Row | None:
    own = materials.get(entry.yarn_name)
    if own is None or entry.cell_mm is None:
        return None
    shares = densities(entry.chart).shares
    if any(PHASES[phase] not in own.fabrics for phase in np.flatnonzero(shares)):
        return None
    mixture, made_of = _mixture(entry.chart, own, entry.yarn, entry.loop_length_mm)
    strains, poisson = [], []
    for direction in Direction:
        curve = entry.curves.get(direction)
        strains.append(np.full(len(STRESS), np.nan) if curve is None else curve.strain_at(STRESS))
        poisson.append(np.nan if curve is None else curve.poisson())
    ratios = poisson[0], poisson[1]
    return _row(entry.chart, entry.yarn_name, mixture, made_of, entry.cell_mm, strains, ratios)


def _mixture(
    chart: StitchChart, own: Material, yarn: YarnModel | None = None, loop_length_mm: float = 0.0
) -> tuple[Mixture, Densities]:
    composition = densities(chart)
    mixture = Mixture.of(composition.shares, own)
    if own.identifier not in MATERIALS and yarn is not None:  # one yarn for all fabrics
        numbers = yarn_numbers(yarn, loop_length_mm)
        mixture = Mixture(mixture.parts, numbers[:-1], float(np.exp(numbers[-1])))
    return mixture, composition


def _row(
    chart: StitchChart, yarn_name: str, mixture: Mixture, made_of: Densities,
    size_mm: tuple[float, float], strains: list[Array], poisson: tuple[float, float],
) -> Row:  # fmt: skip
    fold, outputs = over_mixture(mixture, size_mm, strains, poisson)
    if len(mixture.parts) == 1:  # a pure fabric is its own mixture; the rest is its law's misfit
        fold, outputs = np.zeros_like(fold), np.zeros_like(outputs)
    return Row(
        chart.canonical(),
        yarn_name,
        made_of.features,
        mixture.numbers,
        fold,
        outputs,
        made_of.uncertainty,
        follows(mixture)[:, 0],
    )


def arrays_of(every: list[Row]) -> dict[str, NDArray[np.generic]]:
    """All arrays of the model."""
    features = np.array([row.features for row in every])
    scale = features.std(axis=0)
    scale /= np.repeat([_WEIGHTS[kind] for kind in FEATURES], list(FEATURES.values()))
    charts = np.array([row.chart.key for row in every])
    samples = Samples(
        features / scale,
        (np.array([row.numbers for row in every]) - NUMBER_CENTRE) / NUMBER_SCALE,
        np.array([row.pure for row in every]),
    )
    fold = np.array([row.fold for row in every])
    ratio = np.array([row.ratio for row in every])
    follow = np.array([row.follows for row in every])
    swept = np.isfinite(ratio).all(axis=1)
    uncertainty = np.array([row.uncertainty for row in every])
    folds = _folds(charts)

    folding = _settings(samples, fold)
    fold_missed, fold_variance = _left_out(folding, samples, fold, folds)
    slopes = _slopes(samples[swept], fold[swept], ratio[swept], follow[swept])
    rest = ratio - follow * (fold @ slopes.T)
    unfolding = _settings(samples[swept], rest[swept][:, _TUNED])
    rest_missed, rest_variance = _left_out(unfolding, samples[swept], rest[swept], folds[swept])
    return {
        "charts": charts,
        "features": samples.features,
        "numbers": samples.numbers,
        "pure": samples.pure,
        "folding": fold,
        "unfolding": rest,
        "feature_scale": scale,
        "number_centre": NUMBER_CENTRE,
        "number_scale": NUMBER_SCALE,
        "folding_settings": np.array(astuple(folding)),
        "unfolding_settings": np.array(astuple(unfolding)),
        "slopes": slopes,
        "folding_scale": _scale(fold_missed, fold_variance, uncertainty, _FOLDING_COVERAGE),
        "unfolding_scale": _scale(
            rest_missed, rest_variance, uncertainty[swept], np.full(4, COVERAGE)
        ),
        "folding_missed": fold_missed,
        "unfolding_missed": _scattered(rest_missed, swept),
        "ratio": ratio,
        "follows": follow,
        "uncertainty": uncertainty,
        "folding_variance": fold_variance,
        "unfolding_variance": _scattered(rest_variance[:, None], swept)[:, 0],
    }


def _folds(charts: NDArray[np.str_]) -> NDArray[np.int64]:
    """A fold for each row; all rows of a chart, and of the same upside down, are in one."""
    families = np.array([_family(text) for text in charts])
    names = np.unique(families)
    fold = np.random.default_rng(0).permutation(len(names)) % _FOLDS
    return np.asarray(fold[np.searchsorted(names, families)])


def _family(text: str) -> str:
    chart = StitchChart.parse(text)
    return min(chart.canonical().key, StitchChart(chart.purl[::-1]).canonical().key)


def _settings(samples: Samples, targets: Array) -> KernelSettings:
    """Settings of largest marginal likelihood, the outputs scaled to one."""
    scaled = targets / targets.std(axis=0)

    def cost(logs: Array) -> float:
        matrix = noisy_covariance(KernelSettings(*np.exp(logs)), samples)
        try:
            factor = cholesky(matrix, lower=True)
        except LinAlgError:
            return 1e10
        fit = float(np.sum(scaled * cho_solve((factor, True), scaled)))
        return float(0.5 * fit + scaled.shape[1] * np.log(np.diag(factor)).sum())

    best = minimize(cost, np.log(astuple(_START)), method="L-BFGS-B", bounds=_BOUNDS)
    return KernelSettings(*map(float, np.exp(best.x)))


def _slopes(samples: Samples, fold: Array, ratio: Array, follow: Array) -> Array:
    """(outputs, 2) by generalised least squares: how the outputs follow ln width and ln height."""
    along = np.repeat(fold, len(STRESS_GRID), axis=1)  # course's strains by width, wale's by height
    about = ratio[:, : along.shape[1]] - _FIRST_SLOPE * follow[:, : along.shape[1]] * along
    settings = _settings(samples, about[:, _TUNED])
    factor = cholesky(noisy_covariance(settings, samples), lower=True), True
    slopes = []
    for values, by in zip(ratio.T, follow.T, strict=True):
        regressors = fold * by[:, None]
        weighted = cho_solve(factor, regressors)
        slopes.append(np.linalg.solve(regressors.T @ weighted, weighted.T @ values))
    return np.array(slopes)


def _left_out(
    settings: KernelSettings, samples: Samples, targets: Array, folds: NDArray[np.int64]
) -> tuple[Array, Array]:
    """Errors of models fitted without the row's chart, and their variances."""
    missed, variance = np.zeros_like(targets), np.zeros(len(targets))
    for fold in range(_FOLDS):
        out = folds == fold
        model = KernelModel.fit(settings, samples[~out], targets[~out])
        mean, variance[out] = model(samples[out])
        missed[out] = targets[out] - mean
    return missed, variance


def _scale(missed: Array, variance: Array, uncertainty: Array, coverage: Array) -> Array:
    """(4, outputs) scales for which 90 % intervals cover these parts of left-out values, by ways.

    Quantile regression: Koenker and Bassett, *Econometrica* 46 (1978), 33.
    """
    mixed = uncertainty.any(axis=1)
    needed = np.abs(missed[mixed]) / np.sqrt(variance[mixed, None]) / Z_SCORE
    of = uncertainty[mixed]
    part = of @ coverage / of.sum(axis=1)
    cost = np.concatenate([np.zeros(len(coverage)), part, 1 - part])
    met = np.hstack([of, np.eye(len(of)), -np.eye(len(of))])
    scales = [np.asarray(linprog(cost, A_eq=met, b_eq=total).x) for total in needed.T]
    return np.transpose(scales)[: len(coverage)]


def _scattered(values: Array, rows_: NDArray[np.bool_]) -> Array:
    full = np.full((len(rows_), values.shape[1]), np.nan)
    full[rows_] = values
    return full


Table = tuple[str, list[list[str]]]
"""The line of heads of a table, and the cells of its rows."""


def report(arrays: dict[str, NDArray[np.generic]], yarns: list[str]) -> tuple[Table, Table]:
    """Two tables: median and 90 % quantile of the factor by which left-out charts are missed, and
    the share of them inside the 90 % interval. The second compares 2-D charts with a null model:
    the mixture, times the mean factor of the class.
    """
    kinds = np.array([kind_of(StitchChart.parse(str(text))) for text in arrays["charts"]])
    values = {name: np.asarray(arrays[name], dtype=float) for name in _REPORTED}
    fold, rest = values["folding_missed"], values["unfolding_missed"]
    slopes = values["follows"][:, :, None] * values["slopes"]
    fold_sd = values["uncertainty"] @ values["folding_scale"]
    fold_sd = fold_sd * np.sqrt(values["folding_variance"])[:, None]
    rest_sd = values["uncertainty"] @ values["unfolding_scale"]
    rest_sd = rest_sd * np.sqrt(values["unfolding_variance"])[:, None]
    strain = rest + np.einsum("njk,nk->nj", slopes, fold)
    strain_sd = np.sqrt(rest_sd**2 + np.einsum("njk,nk->nj", slopes**2, fold_sd**2))
    at = {direction: len(STRESS_GRID) * direction.axis for direction in Direction}

    of_kinds = []
    yarn_names = np.array(yarns)
    groups = {kind: kinds == kind for kind in _KINDS}
    groups |= {f"2-D, {yarn}": groups["2-D"] & (yarn_names == yarn) for yarn in _YARNS}
    for name, of in groups.items():
        pairs = [(fold[of, i], fold_sd[of, i]) for i in range(2)]
        for missed, spread in ((strain, strain_sd), (rest, rest_sd)):
            pairs += [(missed[of, first + 2], spread[of, first + 2]) for first in at.values()]
        cells = (_factors(*pair) for pair in pairs)
        of_kinds.append([name, f"{np.count_nonzero(of):,}", *cells])
    of_stresses = []
    two = groups["2-D"]
    for i, stress in _REPORTED_AT.items():
        logs = []
        for first in at.values():
            ratio = values["ratio"][two, first + i]
            logs += [ratio - np.nanmean(ratio), strain[two, first + i], rest[two, first + i]]
        of_stresses.append([f"{stress:g} N/mm", *map(_factors, logs)])
    return (_HEADS, of_kinds), (_HEADS_OF_STRESSES, of_stresses)


_HEADS = (
    "| at 0.05 N/mm | charts × yarns | width | height | course strain | wale strain "
    "| course, known size | wale, known size |"
)
_HEADS_OF_STRESSES = (
    "| 2-D charts at | course: null | learned | known size | wale: null | learned | known size |"
)
_REPORTED_AT = {0: 0.01, 2: 0.05, 5: 0.3}
"""Stresses of the grid, and about what they are in N/mm."""


_KINDS = ("rib", "welt", "2-D")
_YARNS = ("acrylic", "cotton", "middle")


def kind_of(chart: StitchChart) -> str:
    """``pure``, ``rib``, ``welt`` or ``2-D``."""
    repeat = chart.repeat()
    if repeat.canonical() in _PURE:
        return "pure"
    return "rib" if repeat.rows == 1 else "welt" if repeat.columns == 1 else "2-D"


def _factors(logs: Array, spread: Array | None = None) -> str:
    known = np.isfinite(logs)
    off = np.abs(logs[known])
    median, most = np.exp(np.quantile(off, (0.5, 0.9)))
    if spread is None:
        return f"{median:.2f}/{most:.2f}"
    inside = np.mean(off <= Z_SCORE * spread[known])
    return f"{median:.2f}/{most:.2f} ({100 * inside:.0f} %)"


def main() -> None:
    """Run ``python -m scripts.training.learned``."""
    every = rows()
    arrays = arrays_of(every)
    for heads, cells in report(arrays, [row.yarn_name for row in every]):
        sys.stdout.write("\n".join([heads, *(f"| {' | '.join(row)} |" for row in cells), ""]))
    kept = {name: values for name, values in arrays.items() if name not in _REPORTED_ONLY}
    np.savez_compressed(FILE, **kept)  # type: ignore[arg-type]


_REPORTED_ONLY = (
    "folding_missed",
    "unfolding_missed",
    "ratio",
    "follows",
    "folding_variance",
    "unfolding_variance",
    "uncertainty",
)


_REPORTED = (*_REPORTED_ONLY, "slopes", "folding_scale", "unfolding_scale")


if __name__ == "__main__":
    main()
