"""A law fitted to force and waist of stretch tests together, by simulating the tests.

A strip held by its clamps strains unevenly, and how much depends on its size. So the unknowns -
C_xxxx, C_yyyy, one coupling, alpha, beta and kappa of both directions, and the shear modulus - are
chosen such that the finite elements of :mod:`knitcore.cloth.flat`, on a strip of the measured width
and length, give the measured force and the measured waist at the measured clamp-to-clamp strains,
in both tests at once (least squares, priors on kappa and the shear modulus, to which tests along
course and wale are hardly sensitive). The waist is read where the test reads it, between two points
inside the cloth or its edges, and up to a constant: at the start of a pull cloth that curls or has
ridges becomes flat, and thereby wider, which is not strain. Where the distance of the clamps is
unknown the ends are left free to narrow, so that the strip strains evenly.
:mod:`knitcore.fit.strip_errors` estimates the errors of the result.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, check_cancelled
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.cloth.flat.strip import LOCK_UP_SHARE
from knitcore.fit.measured_strip import CELLS, LEVELS, WAIST_NOISE, MeasuredStrip, force_noise
from knitcore.fit.pull_fit import LawFit, Reduction, Residuals, fit_law, rms
from knitcore.fit.strip_errors import LinearFit
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.least_squares import fit_direction
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials.law_uncertainty import LawUncertainty
from knitcore.measure.plausibility import check_units
from knitcore.measure.stretch_test import StretchTest, check_pair
from knitcore.measure.table_reading import TableReading
from knitcore.measure.uniaxial_files import read_stretch_test

ROUGH_CELLS = 6
"""Cells across the shorter side of the strip while the best of several starts is sought."""
ROUGH_STEPS = 8
MAX_STEPS = 40
KAPPA_STARTS = ((0.4, 0.02), (0.05, 0.4))
"""Starts of kappa_xx and kappa_yy besides their prior: the sum of squares has several minima."""
LOG_SHEAR_PRIOR = (math.log(0.2), 0.35)
"""Mean and standard deviation of ln(C_xyxy / sqrt(Y_x Y_y)): 0.15 to 0.35 in jersey pulled on the
bias (``studies/graded_jersey.py``), 0.1 to 0.2 in a displacement field of acrylic garter, 0.08 and
0.15 at the yarn level (acrylic stockinette and garter). That is a deviation of 0.7; half of it
here, because the sum of squares counts neighbouring points, which err alike, as if independent."""
SHEAR_STIFFENING = 4.0
"""1/rad², of jersey pulled on the bias: its force to 30 %. Straight pulls do not see it."""
KAPPA_PRIOR = (0.2, 0.5)
"""Mean and standard deviation."""
COUPLING_PRIOR = (0.3, 1.0)
"""Mean and standard deviation of artanh(C_xxyy / sqrt(C_xxxx C_yyyy))."""
FLATTENING = 0.015
"""Standard deviation of the waist that a test reads where flat cloth has none: 0.03, halved for the
same reason. (It is 0.038 in acrylic garter, whose displacement field starts flat.)"""
ALPHA_SHARE = 0.97
"""Largest alpha times the largest strain, so that the law can follow the whole test."""
STOPPED_SHORT = 3.0
"""Penalty added to the residual of a force that the simulation does not reach."""

# Unknowns: logarithms of C_xxxx and C_yyyy, artanh of the coupling, logarithms of alpha_xx,
# alpha_yy, beta_xx and beta_yy, kappa_xx, kappa_yy, and the logarithm of C_xyxy / sqrt(Y_x Y_y).
_ALPHAS, _KAPPAS, _SHEAR = (3, 4), slice(7, 9), 9
_PRIOR_OF = (2, 7, 8, 9)
"""Unknowns with a prior; the last residuals are theirs."""
_PRIORS = np.array([COUPLING_PRIOR, KAPPA_PRIOR, KAPPA_PRIOR, LOG_SHEAR_PRIOR]).T
_SCALE = np.array([0.2, 0.2, 0.2, 0.1, 0.1, 0.3, 0.3, 0.1, 0.1, 0.5])


@dataclass(frozen=True, eq=False, repr=False)
class StripFit(Result):
    """A law fitted to simulated tests.

    Attributes
    ----------
    law : with kappa and shear modulus.
    uncertainty : of moduli and curves.
    errors : standard errors by the law's field names, ratios and moduli.
    stress, waist : simulated, per test, at the tests' strains.
    flattening : per test, how much its waist strain exceeds the simulated one at all levels.
    evaluations : simulated pairs of tests.
    """

    law: ConstitutiveLaw
    uncertainty: LawUncertainty
    errors: dict[str, float]
    stress: tuple[Array, ...]
    waist: tuple[Array, ...]
    flattening: tuple[float, ...]
    evaluations: int


def fit_tests(
    course: Path,
    wale: Path,
    *,
    reduction: Reduction = Reduction.RECOMMENDED,
    file_format: str | None = None,
    width_course_mm: float | None = None,
    width_wale_mm: float | None = None,
    length_course_mm: float | None = None,
    length_wale_mm: float | None = None,
    columns: Mapping[str, str] | None = None,
    template_course: TableReading | None = None,
    template_wale: TableReading | None = None,
    cancelled: Cancelled | None = None,
) -> LawFit:
    """Fit a law to two files (see :mod:`knitcore.measure.uniaxial_files` for their layout).

    Parameters
    ----------
    course, wale : files of the tests along the rows and along the columns.
    reduction : how points become constants.
    file_format : ``"h5"`` or ``"csv"``; found out from the content if None.
    width_course_mm, width_wale_mm : clamped widths, in place of those in the files.
    length_course_mm, length_wale_mm : distances of the clamps at rest, in place of those there.
    columns : what a table calls our columns, such as ``{"force_n": "Channel 2 (N)"}``.
    template_course, template_wale : how each table is read, where the others say nothing.
    cancelled : called between simulated tests.

    Raises
    ------
    InputError
        If a file cannot be used, or the two do not belong together.
    CancelledError
        If ``cancelled`` returned True.
    """
    given = (
        (course, width_course_mm, length_course_mm, template_course),
        (wale, width_wale_mm, length_wale_mm, template_wale),
    )
    tests = [
        read_stretch_test(
            path, marks=reduction.marks, file_format=file_format,
            reading=TableReading(width, length, columns or {}).over(template or TableReading()),
        )
        for path, width, length, template in given
    ]  # fmt: skip
    if reduction is Reduction.RECOMMENDED:
        return fit_simulated(tests[0], tests[1], cancelled=cancelled)
    return fit_law(tests[0], tests[1], reduction=reduction)


def fit_simulated(
    course: StretchTest, wale: StretchTest, *, cancelled: Cancelled | None = None
) -> LawFit:
    """Fit a law to two tests by simulating them.

    Raises
    ------
    InputError
        If the tests do not belong together.
    CancelledError
        If ``cancelled`` returned True.
    """
    notes = [*course.notes, *wale.notes, *check_pair(course, wale), *check_units(course, wale)]
    tests = (course, wale)
    strips = [MeasuredStrip.of(t, d) for t, d in zip(tests, Direction, strict=True)]
    for test, strip in zip(tests, strips, strict=True):
        if strip.length_mm is None:
            notes.append(
                f"{test.source} does not say how far apart the clamps are (length_mm), so the"
                " fabric is assumed to narrow evenly."
            )
        if strip.pulls == 1:
            notes.append(f"{test.source} has one pull, so the scatter between pulls is unknown.")
    fit = fit_strips(strips, cancelled=cancelled)
    residuals = {
        d: Residuals.of(test, strip.strain[-1], partial(_between, strip.strain, simulated))
        for d, test, strip, simulated in zip(Direction, tests, strips, fit.stress, strict=True)
    }
    return LawFit.of(
        tests,
        residuals,
        law=fit.law,
        standard_errors=fit.errors,
        reduction=Reduction.RECOMMENDED,
        largest_strain={d: t.largest_strain for d, t in zip(Direction, tests, strict=True)},
        error_method="jackknife over pulls, scatter about the fit, readings of width",
        notes=tuple(notes),
        uncertainty=fit.uncertainty,
        waist_rms={
            d: rms(missed[np.isfinite(missed)])
            for d, w, strip in zip(Direction, fit.waist, strips, strict=True)
            for missed in [w - strip.means[1]]
            if np.isfinite(missed).any()
        },
    )


def fit_strips(strips: Sequence[MeasuredStrip], *, cancelled: Cancelled | None = None) -> StripFit:
    """Fit a law to a course-wise and a wale-wise strip.

    Parameters
    ----------
    strips : the tests.
    cancelled : called between simulated tests.

    Raises
    ------
    CancelledError
        If ``cancelled`` returned True.
    """
    problem = _Problem(tuple(strips), cancelled or (lambda: False))
    tried = [problem.solve(start, ROUGH_CELLS, ROUGH_STEPS) for start in problem.starts]
    best = min(tried, key=lambda attempt: float(attempt.cost))
    fit = problem.solve(best.x, CELLS, MAX_STEPS)
    law = _law(fit.x)
    simulated = [strip.simulate(law) for strip in strips]
    flat = tuple(
        flattening(waist, strip.means[1])
        for (_, waist), strip in zip(simulated, strips, strict=True)
    )
    about = LinearFit(problem.strips, fit.x, fit.fun, fit.jac, flat, _law, _ALPHAS, _SHEAR)
    return StripFit(
        law=law,
        uncertainty=about.uncertainty,
        errors=about.errors,
        stress=tuple(stress for stress, _ in simulated),
        waist=tuple(waist for _, waist in simulated),
        flattening=flat,
        evaluations=problem.evaluations,
    )


class _Problem:
    """Residuals of a set of unknowns, each about 1 in a good fit."""

    def __init__(self, strips: tuple[MeasuredStrip, ...], cancelled: Cancelled) -> None:
        self.strips, self.cancelled = strips, cancelled
        self.evaluations = 0

    def solve(self, start: Array, cells: int, steps: int) -> scipy.optimize.OptimizeResult:
        """Least squares from a start."""
        low, high = self.bounds
        return scipy.optimize.least_squares(
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
        """Starts: each direction fitted separately, straining evenly, with several couplings."""
        logs = []
        for strip in self.strips:
            stress, waist = strip.means
            usual = -math.tanh(COUPLING_PRIOR[0]) * strip.strain
            waist = np.where(np.isfinite(waist), waist, usual)
            fit = fit_direction(strip.strain, waist, stress, np.ones(LEVELS), 0.0)
            share = min(fit.alpha, 0.9 / float(strip.strain[-1]))
            floor = 1e-3 * float(stress.max())
            logs.append(np.log([max(fit.stiffness, floor), share, max(fit.beta, floor)]))
        x, y = logs
        unknowns = np.array([x[0], y[0], 0, x[1], y[1], x[2], y[2], 0, 0, 0])
        unknowns[list(_PRIOR_OF)] = _PRIORS[0]
        apart = [unknowns.copy() for _ in KAPPA_STARTS]
        for start, kappa in zip(apart, KAPPA_STARTS, strict=True):
            start[_KAPPAS] = kappa
        return unknowns, *apart

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the unknowns."""
        most = [math.log(ALPHA_SHARE * LOCK_UP_SHARE / strip.strain[-1]) for strip in self.strips]
        low = [-14, -14, -1, most[0] - 3, most[1] - 3, -14, -14, 0, 0, math.log(1e-3)]
        high = [4, 4, 1.8, *most, 2, 2, 1.5, 1.5, math.log(10)]
        return np.array(low, dtype=float), np.array(high, dtype=float)

    def residuals(self, unknowns: Array, cells: int) -> Array:
        """Residuals of force and waist of all tests, and of the priors."""
        check_cancelled(self.cancelled)
        self.evaluations += 1
        law = _law(unknowns)
        parts, shifts = zip(*(_residual(strip, law, cells) for strip in self.strips), strict=True)
        means, deviations = _PRIORS
        return np.concatenate([*parts, shifts, (unknowns[list(_PRIOR_OF)] - means) / deviations])


def flattening(simulated: Array, measured: Array) -> float:
    """The most likely constant difference of the measured waist strain from the simulated one."""
    apart = (measured - simulated)[np.isfinite(simulated) & np.isfinite(measured)]
    return float(apart.sum() / (len(apart) + (WAIST_NOISE / FLATTENING) ** 2))


def _residual(strip: MeasuredStrip, law: ConstitutiveLaw, cells: int) -> tuple[Array, float]:
    """Residuals of force and waist, (2 levels,), and of the flattening.

    Beyond the simulation's end they are those of a strip that strains evenly.
    """
    stress, waist = strip.simulate(law, cells=cells)
    failed = ~np.isfinite(stress)
    if failed.any():
        even = uniaxial_response(law, strip.direction, strip.strain[failed])
        stress[failed], waist[failed] = even.stress, even.transverse_strain
    measured_stress, measured_waist = strip.means
    force = (stress - measured_stress) / force_noise(measured_stress)
    flat = flattening(waist, measured_waist)
    narrowing = np.nan_to_num((waist + flat - measured_waist) / WAIST_NOISE)  # 0 where not measured
    return np.concatenate([force + STOPPED_SHORT * failed, narrowing]), flat / FLATTENING


def _law(unknowns: Array) -> ConstitutiveLaw:
    xxxx, yyyy, alpha_x, alpha_y, beta_x, beta_y = np.exp(unknowns[[0, 1, 3, 4, 5, 6]]).tolist()
    poisson = math.tanh(unknowns[2])  # geometric mean of both ratios
    stiffness = math.sqrt(xxxx * yyyy)
    kappa_x, kappa_y = np.maximum(unknowns[_KAPPAS], 0.0).tolist()
    return ConstitutiveLaw(
        stiffness_xxxx=xxxx,
        stiffness_yyyy=yyyy,
        stiffness_xxyy=poisson * stiffness,
        stiffness_yyxx=poisson * stiffness,
        alpha_xx=alpha_x,
        alpha_yy=alpha_y,
        beta_xx=beta_x,
        beta_yy=beta_y,
        shear_modulus=math.exp(unknowns[_SHEAR]) * (1 - poisson**2) * stiffness,
        shear_stiffening=SHEAR_STIFFENING,
        kappa_xx=kappa_x,
        kappa_yy=kappa_y,
    )


def _between(strain: Array, stress: Array, along: Array, _: Array) -> Array:
    """Stress at strains between those of a simulation, which begins at rest."""
    return np.asarray(np.interp(along, np.append(0.0, strain), np.append(0.0, stress)))
