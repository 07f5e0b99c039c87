"""A law fitted to force and waist of stretch tests together, by simulating the tests.

A strip held by its clamps strains unevenly, and how much depends on its size. So the unknowns -
C_xxxx, C_yyyy, one coupling, alpha, beta and kappa of both directions, and the shear modulus - are
chosen such that the finite elements of :mod:`knitcore.swatch`, on a strip of the measured width and
length, give the measured force and the measured waist at the measured clamp-to-clamp strains, in
both tests at once (least squares, priors on kappa and the shear modulus, which tests along course
and wale hardly see). Where the distance of the clamps is unknown the ends are left free to narrow,
so that the strip strains evenly.

Uncertainty, each to first order about the fit:

- between pulls, by the jackknife;
- misfit of the law, by the scatter about the fit, a few neighbouring points counting as one;
- reading errors of width and length (:data:`LOG_WIDTH_READING`, :data:`LOG_LENGTH_READING`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares

from knitcore.errors import CancelledError, InputError
from knitcore.fabric import Direction
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials.uncertainty import CurveUncertainty, LawUncertainty
from knitcore.measure.law_fit import fit_direction
from knitcore.measure.median_curve import median_curve
from knitcore.measure.stretch_test import StretchRun, StretchTest, check_pair
from knitcore.measure.uniaxial import LawFit, Reduction, Residuals, fit_law
from knitcore.measure.uniaxial_files import read_stretch_test
from knitcore.swatch.grid import QuarterGrid
from knitcore.swatch.models import SheetModel
from knitcore.swatch.sheet import Sheet
from knitcore.swatch.strip import LOCK_UP_SHARE, Clamps, pull

Array = NDArray[np.float64]

LEVELS = 14
"""Strains at which force and waist are compared."""
BINS = 80
"""Strain intervals over which a pull is averaged first."""
CELLS = 10
"""Cells across the shorter side of the strip."""
ROUGH_CELLS = 6
"""The same while the best of several starts is sought."""
MOST_CELLS = 60
ROUGH_STEPS = 8
MOST_STEPS = 40
KAPPA_STARTS = ((0.4, 0.02), (0.05, 0.4))
"""Starts of kappa_xx and kappa_yy besides their prior: the sum of squares has several minima."""
FORCE_NOISE = 0.04
"""Relative error of a force that a fit may leave, above about ``QUIET_STRESS``."""
QUIET_STRESS_N_PER_MM = 0.03
WAIST_NOISE = 0.015
"""Error of a measured waist strain that a fit may leave."""
LOG_SHEAR_PRIOR = (math.log(0.02), 0.4)
"""Mean and standard deviation of ln(C_xyxy / (N/mm)): from a displacement field of acrylic garter,
give or take a factor of 1.5."""
KAPPA_PRIOR = (0.2, 0.5)
"""Mean and standard deviation."""
COUPLING_PRIOR = (0.3, 1.0)
"""The same of artanh(C_xxyy / sqrt(C_xxxx C_yyyy))."""
LIKENESS = {"kappa": 0.1, "coupling": 0.2}
"""Standard deviations about the law of the same fabric in another yarn, where that is a prior."""
NEIGHBOURS = 3.5
"""Neighbouring points err alike; so many count as one."""
LOG_WIDTH_READING = 0.03
"""Standard deviation of the logarithm of a clamped width read from a picture."""
LOG_LENGTH_READING = 0.015
"""The same of the length that strain is referred to."""
ALPHA_SHARE = 0.97
"""Largest alpha times the largest strain, so that the law can follow the whole test."""

_UNKNOWNS = 10
"""Logarithms of C_xxxx and C_yyyy, artanh of the coupling, logarithms of alpha_xx, alpha_yy,
beta_xx and beta_yy, kappa_xx, kappa_yy, and the logarithm of C_xyxy."""
_KAPPAS, _SHEAR = slice(7, 9), 9
_PRIORS = (2, 7, 8, 9)
"""Unknowns with a prior; the last residuals are theirs."""
_CONSTANTS = tuple(field.name for field in fields(ConstitutiveLaw))
_SCALE = np.array([0.2, 0.2, 0.2, 0.1, 0.1, 0.3, 0.3, 0.1, 0.1, 0.5])
STOPPED_SHORT = 3.0
"""Added to the residual of a force that the simulation does not reach."""


@dataclass(frozen=True, eq=False)
class MeasuredStrip:
    """A test as the fit sees it.

    Attributes
    ----------
    direction : of the pull.
    width_mm, length_mm : of the strip at rest; length None where it is unknown.
    strain : (levels,) clamp to clamp, increasing.
    stress_n_per_mm, waist : (pulls, levels); NaN where a pull does not reach.
    waist_noise : error of a waist strain that a fit may leave.
    """

    direction: Direction
    width_mm: float
    length_mm: float | None
    strain: Array
    stress_n_per_mm: Array
    waist: Array
    waist_noise: float = WAIST_NOISE

    @classmethod
    def of(cls, test: StretchTest, direction: Direction) -> MeasuredStrip:
        """A test at equal steps of strain, as far as half of its pulls go.

        Raises
        ------
        InputError
            If no pull covers that range.
        """
        ends = sorted(float(run.strain_along.max()) for run in test.runs)
        top = ends[(len(ends) - 1) // 2]
        strain = np.linspace(0.08, 0.995, LEVELS) * top
        columns = [_resampled(run, strain, top) for run in test.runs]
        stress, waist = (np.array(part) for part in zip(*columns, strict=True))
        if not np.all(np.isfinite(stress).any(axis=0)):
            raise InputError(
                test.source,
                "has no readings over part of the pull.",
                "Give readings from rest to the largest force.",
            )
        return cls(direction, float(np.mean(test.width_mm)), test.length_mm, strain, stress, waist)

    def without(self, index: int) -> MeasuredStrip:
        """The test with one pull left out."""
        keep = np.arange(len(self.stress_n_per_mm)) != index
        return replace(self, stress_n_per_mm=self.stress_n_per_mm[keep], waist=self.waist[keep])

    @property
    def pulls(self) -> int:
        """How many there are."""
        return len(self.stress_n_per_mm)

    @property
    def means(self) -> tuple[Array, Array]:
        """Mean stress and waist over the pulls, (levels,); NaN where none reaches."""
        reached = np.isfinite(self.stress_n_per_mm).sum(axis=0)
        with np.errstate(invalid="ignore"):
            stress, waist = (
                np.nansum(values, axis=0) / reached for values in (self.stress_n_per_mm, self.waist)
            )
        return np.asarray(stress), np.asarray(waist)

    def sheet(self, law: ConstitutiveLaw, cells: int = CELLS) -> Sheet:
        """A strip of the measured size."""
        if self.length_mm is None:  # strains evenly, so that any mesh is exact
            return Sheet(QuarterGrid.uniform(2, 2, 10.0, 10.0), [law], SheetModel())
        sides = (self.length_mm, self.width_mm)
        width, height = sides if self.direction is Direction.COURSE else sides[::-1]
        step = min(sides) / cells
        columns, rows = (min(MOST_CELLS, round(side / step)) for side in (width, height))
        return Sheet(QuarterGrid.uniform(columns, rows, width, height), [law], SheetModel())

    def simulate(
        self, law: ConstitutiveLaw, strain: Array | None = None, cells: int = CELLS
    ) -> tuple[Array, Array]:
        """Stress (N/mm) and waist strain at the test's strains; NaN beyond what converges."""
        levels = self.strain if strain is None else strain
        clamps = Clamps.SLIDING if self.length_mm is None else Clamps.CLAMPED
        found = pull(self.sheet(law, cells), self.direction, levels, clamps=clamps)
        stress, waist = np.full(len(levels), np.nan), np.full(len(levels), np.nan)
        stress[: found.steps], waist[: found.steps] = found.stress_n_per_mm, found.waist_strain
        return stress, waist


def _resampled(run: StretchRun, strain: Array, top: float) -> tuple[Array, Array]:
    place = np.digitize(run.strain_along, np.linspace(0.0, top, BINS + 1)) - 1
    inside = (place >= 0) & (place < BINS)
    count = np.bincount(place[inside], minlength=BINS)
    used = count > 0
    along, stress, waist = (
        np.bincount(place[inside], values[inside], minlength=BINS)[used] / count[used]
        for values in (run.strain_along, run.stress, run.strain_across)
    )
    if not len(along):
        return np.full(len(strain), np.nan), np.full(len(strain), np.nan)
    outside = (strain < along[0] - top / LEVELS) | (strain > along[-1] + top / BINS)
    return tuple(
        np.where(outside, np.nan, np.interp(strain, along, values)) for values in (stress, waist)
    )  # type: ignore[return-value]


@dataclass(frozen=True, eq=False)
class StripFit:
    """A law fitted to simulated tests.

    Attributes
    ----------
    law : with kappa and shear modulus.
    covariance : (10, 10) of the unknowns, all sources.
    uncertainty : of moduli and curves.
    errors : standard errors by the law's field names, ratios and moduli.
    stress, waist : simulated, per test, at the tests' strains.
    evaluations : simulated pairs of tests.
    """

    law: ConstitutiveLaw
    covariance: Array
    uncertainty: LawUncertainty
    errors: dict[str, float]
    stress: tuple[Array, ...]
    waist: tuple[Array, ...]
    evaluations: int


def fit_tests(
    course: Path,
    wale: Path,
    *,
    reduction: Reduction = Reduction.RECOMMENDED,
    file_format: str | None = None,
    width_course_mm: float | None = None,
    width_wale_mm: float | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> LawFit:
    """Fit a law to two files (see :mod:`knitcore.measure.uniaxial_files` for their layout).

    Parameters
    ----------
    course, wale : files of the tests along the rows and along the columns.
    reduction : how points become constants.
    file_format : ``"h5"`` or ``"csv"``; found out from the content if None.
    width_course_mm, width_wale_mm : clamped widths, in place of those in the files.
    cancelled : asked between simulated tests.

    Raises
    ------
    InputError
        If a file cannot be used, or the two do not belong together.
    CancelledError
        If ``cancelled`` returned True.
    """
    tests = [
        read_stretch_test(path, gauge=reduction.gauge, file_format=file_format)
        for path in (course, wale)
    ]
    widths = (width_course_mm, width_wale_mm)
    tests = [t if w is None else t.with_width(w) for t, w in zip(tests, widths, strict=True)]
    if reduction is Reduction.RECOMMENDED:
        return fit_simulated(tests[0], tests[1], cancelled=cancelled)
    return fit_law(tests[0], tests[1], reduction=reduction)


def fit_simulated(
    course: StretchTest, wale: StretchTest, *, cancelled: Callable[[], bool] | None = None
) -> LawFit:
    """Fit a law to two tests by simulating them.

    Raises
    ------
    InputError
        If the tests do not belong together.
    CancelledError
        If ``cancelled`` returned True.
    """
    notes = [*course.notes, *wale.notes, *check_pair(course, wale)]
    tests = (course, wale)
    strips = [MeasuredStrip.of(t, d) for t, d in zip(tests, Direction, strict=True)]
    for test, strip in zip(tests, strips, strict=True):
        if strip.length_mm is None:
            notes.append(
                f"{test.source} does not say how far apart the clamps are (length_mm), so the"
                " fabric is taken to narrow evenly."
            )
        if strip.pulls == 1:
            notes.append(f"{test.source} has one pull: the spread between pulls is missing.")
    found = fit_strips(strips, cancelled=cancelled)
    residuals = {
        d: _residuals(test, strip, simulated)
        for d, test, strip, simulated in zip(Direction, tests, strips, found.stress, strict=True)
    }
    rms = {d: _rms(r.stress - r.fitted) for d, r in residuals.items()}
    return LawFit(
        law=found.law,
        standard_errors=found.errors,
        reduction=Reduction.RECOMMENDED,
        rms_n_per_mm=_rms(np.concatenate([r.stress - r.fitted for r in residuals.values()])),
        rms_course_n_per_mm=rms[Direction.COURSE],
        rms_wale_n_per_mm=rms[Direction.WALE],
        largest_strain={d: t.largest_strain for d, t in zip(Direction, tests, strict=True)},
        residuals=residuals,
        curves={d: median_curve(t) for d, t in zip(Direction, tests, strict=True)},
        runs={d: len(t.runs) for d, t in zip(Direction, tests, strict=True)},
        error_method="jackknife over pulls, scatter about the fit, readings of width and length",
        notes=tuple(notes),
        uncertainty=found.uncertainty,
        waist_rms={
            d: _rms((w - strip.means[1])[np.isfinite(w)])
            for d, w, strip in zip(Direction, found.waist, strips, strict=True)
        },
    )


def fit_strips(
    strips: Sequence[MeasuredStrip],
    *,
    like: ConstitutiveLaw | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> StripFit:
    """Fit a law to a course-wise and a wale-wise strip.

    Parameters
    ----------
    strips : the tests.
    like : law of the same fabric in another yarn, whose couplings are taken to be similar.
    cancelled : asked between simulated tests.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    problem = _Problem(strips, _priors(like), cancelled or (lambda: False))
    tried = [problem.solve(start, ROUGH_CELLS, ROUGH_STEPS) for start in problem.starts]
    best = min(tried, key=lambda found: float(found.cost))
    fit = problem.solve(best.x, CELLS, MOST_STEPS)
    law = _law(fit.x)
    simulated = [strip.simulate(law) for strip in strips]
    jacobian = np.asarray(fit.jac, dtype=float)
    covariance = _covariance(problem, np.asarray(fit.fun), jacobian)
    return StripFit(
        law=law,
        covariance=covariance,
        uncertainty=_uncertainty(problem, fit.x, np.asarray(fit.fun), jacobian, covariance),
        errors=_errors(fit.x, covariance),
        stress=tuple(stress for stress, _ in simulated),
        waist=tuple(waist for _, waist in simulated),
        evaluations=problem.evaluations,
    )


class _Problem:
    """Residuals of the unknowns, each about 1 where the fit is as good as it may be."""

    def __init__(
        self, strips: Sequence[MeasuredStrip], priors: Array, cancelled: Callable[[], bool]
    ) -> None:
        self.strips, self.priors, self.cancelled = tuple(strips), priors, cancelled
        self.evaluations = 0

    def solve(self, start: Array, cells: int, steps: int) -> OptimizeResult:
        """Least squares from a start."""
        low, high = self.bounds
        return least_squares(
            self.residuals,
            np.clip(start, low + 1e-6, high - 1e-6),
            bounds=(low, high),
            args=(cells,),
            diff_step=np.array(1e-3),
            x_scale=_SCALE,
            xtol=1e-4,
            ftol=1e-4,
            max_nfev=steps,
        )

    @property
    def starts(self) -> tuple[Array, ...]:
        """From each direction separately, straining evenly, and several couplings."""
        logs = []
        for strip in self.strips:
            stress, waist = strip.means
            fit = fit_direction(strip.strain, waist, stress, np.ones(LEVELS), 0.0)
            share = min(fit.alpha, 0.9 / float(strip.strain[-1]))
            floor = 1e-3 * float(stress.max())
            logs.append(np.log([max(fit.stiffness, floor), share, max(fit.beta, floor)]))
        x, y = logs
        unknowns = np.array([x[0], y[0], 0, x[1], y[1], x[2], y[2], 0, 0, 0])
        unknowns[list(_PRIORS)] = self.priors[0]
        apart = [unknowns.copy() for _ in KAPPA_STARTS]
        for start, kappa in zip(apart, KAPPA_STARTS, strict=True):
            start[_KAPPAS] = kappa
        return unknowns, *apart

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Of the unknowns."""
        most = [math.log(ALPHA_SHARE * LOCK_UP_SHARE / strip.strain[-1]) for strip in self.strips]
        low = [-14, -14, -1, most[0] - 3, most[1] - 3, -14, -14, 0, 0, math.log(1e-4)]
        high = [4, 4, 1.8, *most, 2, 2, 1.5, 1.5, 0.0]
        return np.array(low, dtype=float), np.array(high, dtype=float)

    def residuals(self, unknowns: Array, cells: int) -> Array:
        """Of force and waist of all tests, and of the priors."""
        if self.cancelled():
            raise CancelledError("The caller stopped the fit.")
        self.evaluations += 1
        law = _law(unknowns)
        parts = [np.concatenate(_residual(strip, law, cells)) for strip in self.strips]
        means, deviations = self.priors
        return np.concatenate([*parts, (unknowns[list(_PRIORS)] - means) / deviations])

    def rows(self, test: int) -> slice:
        """Of a test's forces among the residuals; its waists follow."""
        return slice(2 * LEVELS * test, 2 * LEVELS * test + LEVELS)


def _priors(like: ConstitutiveLaw | None) -> Array:
    """Means and standard deviations of the unknowns that have a prior."""
    if like is None:
        pairs = (COUPLING_PRIOR, KAPPA_PRIOR, KAPPA_PRIOR, LOG_SHEAR_PRIOR)
    else:
        mean = math.sqrt(like.stiffness_xxxx * like.stiffness_yyyy)
        pairs = (
            (math.atanh(like.stiffness_xxyy / mean), LIKENESS["coupling"]),
            (like.kappa_xx, LIKENESS["kappa"]),
            (like.kappa_yy, LIKENESS["kappa"]),
            LOG_SHEAR_PRIOR,
        )
    return np.array(pairs).T


def _residual(strip: MeasuredStrip, law: ConstitutiveLaw, cells: int) -> tuple[Array, Array]:
    """Of force and waist; where the simulation stops short, of a strip that strains evenly."""
    stress, waist = strip.simulate(law, cells=cells)
    failed = ~np.isfinite(stress)
    if failed.any():
        even = uniaxial_response(law, strip.direction, strip.strain[failed])
        stress[failed], waist[failed] = even.stress, even.transverse_strain
    wanted_stress, wanted_waist = strip.means
    force = (stress - wanted_stress) / _force_noise(wanted_stress)
    narrowing = (waist - wanted_waist) / strip.waist_noise
    return force + STOPPED_SHORT * failed, narrowing


def _force_noise(stress: Array) -> Array:
    return np.asarray(FORCE_NOISE * np.hypot(stress, QUIET_STRESS_N_PER_MM))


def _law(unknowns: Array) -> ConstitutiveLaw:
    xxxx, yyyy, alpha_x, alpha_y, beta_x, beta_y = np.exp(unknowns[[0, 1, 3, 4, 5, 6]]).tolist()
    coupling = math.tanh(unknowns[2]) * math.sqrt(xxxx * yyyy)
    kappa_x, kappa_y = np.maximum(unknowns[_KAPPAS], 0.0).tolist()
    return ConstitutiveLaw(
        stiffness_xxxx=xxxx,
        stiffness_yyyy=yyyy,
        stiffness_xxyy=coupling,
        stiffness_yyxx=coupling,
        alpha_xx=alpha_x,
        alpha_yy=alpha_y,
        beta_xx=beta_x,
        beta_yy=beta_y,
        shear_modulus=math.exp(unknowns[_SHEAR]),
        kappa_xx=kappa_x,
        kappa_yy=kappa_y,
    )


# -- uncertainty ---------------------------------------------------------------------------------


def _covariance(problem: _Problem, residuals: Array, jacobian: Array) -> Array:
    """Of the unknowns: between pulls, scatter, and readings."""
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    scatter = float(residuals @ residuals) / max(len(residuals) - _UNKNOWNS, 1)
    weak = jacobian.copy()
    weak[: -len(_PRIORS)] /= math.sqrt(NEIGHBOURS * max(scatter, 0.1))
    total = np.linalg.pinv(weak.T @ weak)
    for shift, weight in _shifts(problem, jacobian):
        step = inverse @ (jacobian.T @ shift)
        total = total + weight * np.outer(step, step)
    return np.asarray(total)


def _shifts(problem: _Problem, jacobian: Array) -> Iterable[tuple[Array, float]]:
    """Changes of the residuals by each independent cause, and the weight of its square."""
    for test, strip in enumerate(problem.strips):
        rows = problem.rows(test)
        waists = slice(rows.stop, rows.stop + LEVELS)
        stress, waist = strip.means
        noise = _force_noise(stress)
        slope, narrowing = (np.gradient(values, np.log(strip.strain)) for values in strip.means)
        width, length = np.zeros(len(jacobian)), np.zeros(len(jacobian))
        width[rows] = LOG_WIDTH_READING * stress / noise
        length[rows] = LOG_LENGTH_READING * slope / noise
        length[waists] = LOG_LENGTH_READING * narrowing / strip.waist_noise
        yield width, 1.0
        yield length, 1.0
        for index in range(strip.pulls if strip.pulls > 1 else 0):
            less_stress, less_waist = strip.without(index).means
            shift = np.zeros(len(jacobian))
            shift[rows] = np.nan_to_num((less_stress - stress) / noise)
            shift[waists] = np.nan_to_num((less_waist - waist) / strip.waist_noise)
            yield shift, (strip.pulls - 1) / strip.pulls


def _uncertainty(
    problem: _Problem, unknowns: Array, residuals: Array, jacobian: Array, covariance: Array
) -> LawUncertainty:
    errors = _errors(unknowns, covariance)
    law = _law(unknowns)
    fitted = np.sqrt(np.einsum("ij,jk,ik->i", jacobian, covariance, jacobian))
    curves, waists = [], []
    for test, strip in enumerate(problem.strips):
        rows = problem.rows(test)
        stress, waist = strip.means
        share = _force_noise(stress) / stress
        loaded = stress > QUIET_STRESS_N_PER_MM
        loaded = loaded if loaded.any() else np.ones(LEVELS, dtype=bool)
        total = np.hypot(fitted[rows], residuals[rows])[loaded] * share[loaded]
        lock_up = math.sqrt(covariance[3 + test, 3 + test])
        curves.append(CurveUncertainty(_rms(total), 0.0, lock_up))
        after = slice(rows.stop, rows.stop + LEVELS)
        narrowed = strip.waist_noise * np.hypot(fitted[after], residuals[after])
        waists.append(_rms(narrowed) / max(_rms(waist), 1e-3))
    return LawUncertainty(
        log_modulus_course=errors["modulus_course"] / law.modulus_course,
        log_modulus_wale=errors["modulus_wale"] / law.modulus_wale,
        # such that the waist is as uncertain as the tests leave it
        poisson_yx=abs(law.poisson_yx) * waists[0],
        poisson_xy=abs(law.poisson_xy) * waists[1],
        source="between pulls, scatter about the simulated tests, readings of width and length",
        curve_course=curves[0],
        curve_wale=curves[1],
        log_shear=math.sqrt(covariance[_SHEAR, _SHEAR]),
    )


def _errors(unknowns: Array, covariance: Array) -> dict[str, float]:
    """Standard errors of constants, ratios and moduli, to first order."""
    names = (*_CONSTANTS, "poisson_yx", "poisson_xy", "modulus_course", "modulus_wale")

    def values(at: Array) -> Array:
        law = _law(at)
        return np.array([getattr(law, name) for name in names])

    step = 1e-5
    slopes = np.array(
        [
            (values(unknowns + d) - values(unknowns - d)) / (2 * step)
            for d in step * np.eye(_UNKNOWNS)
        ]
    )
    variances = np.einsum("ji,jk,ki->i", slopes, covariance, slopes)
    return dict(zip(names, np.sqrt(variances).tolist(), strict=True))


def _residuals(test: StretchTest, strip: MeasuredStrip, simulated: Array) -> Residuals:
    points = test.pooled()
    inside = points.strain_along <= strip.strain[-1]
    along = points.strain_along[inside]
    fitted = np.interp(along, np.append(0.0, strip.strain), np.append(0.0, simulated))
    return Residuals(along, points.strain_across[inside], points.stress[inside], fitted)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
