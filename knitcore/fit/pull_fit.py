"""From two stretch tests to the eight constants of a constitutive law (the paper's Note 7).

Reductions by name:

``published``
    As it reproduces the paper's tables: strain from the fabric's centre to the lower clamp,
    referred to the first frame of the first pull; Poisson ratios by straight lines with an
    intercept through all points; plain least squares over all points in the range of strain that
    every complete pull covers, with the strain across taken from the straight line.
``uniform``
    Strain from clamp to clamp; Poisson ratios through the origin; every pull counts the same, and
    within a pull every strain interval, whatever the number of frames. The fabric is assumed to
    strain evenly, as if the clamps did not restrain it.
``recommended``
    The test is simulated between its clamps, and force and waist are fitted together:
    :mod:`knitcore.fit.strip_fit`.

Standard errors by the jackknife over pulls (over blocks of strain when there is one pull only).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from typing import Any

import numpy as np

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.least_squares import (
    ALPHA_SHARE_LIMIT,
    DirectionFit,
    fit_direction,
    law_of_directions,
)
from knitcore.materials.law_uncertainty import LawUncertainty
from knitcore.materials.measured_curves import MeasuredCurve
from knitcore.measure.plausibility import check_units
from knitcore.measure.stretch_test import StretchRun, StretchTest, check_pair
from knitcore.measure.uniaxial_files import Marks

BINS = 40
"""Strain intervals of a pull in the uniform reduction."""
CURVE_POINTS = 60
"""Strains of a median curve."""
BLOCKS = 10
"""Blocks of the jackknife when there is one pull only."""
COMPLETE_SHARE = 0.9
"""A pull is complete when it reaches this share of the largest stress."""
SHARED_SHARE = 0.5
"""Least common range of strain, over the whole, to which pulls are cut."""


class Reduction(StrEnum):
    """Reduction of points to constants."""

    PUBLISHED = "published"
    UNIFORM = "uniform"
    RECOMMENDED = "recommended"

    @property
    def marks(self) -> Marks:
        """The tracked points that give the strain along the pull."""
        return Marks.CENTRE if self is Reduction.PUBLISHED else Marks.CLAMPS


@dataclass(frozen=True, eq=False)
class Residuals:
    """Points of one test with the law's stress, for plots; arrays of one length.

    Attributes
    ----------
    strain_along, strain_across : dimensionless.
    stress, fitted : N/mm.
    """

    strain_along: Array
    strain_across: Array
    stress: Array
    fitted: Array

    @classmethod
    def of(
        cls, test: StretchTest, largest_strain: float, law: Callable[[Array, Array], Array]
    ) -> Residuals:
        """The points of a test up to a strain; ``law`` gives the stress by both strains."""
        points = test.pooled()
        points = points.only(points.strain_along <= largest_strain)
        along, across = points.strain_along, points.strain_across
        return cls(along, across, points.stress, law(along, across))


@dataclass(frozen=True, eq=False, repr=False)
class LawFit(Result):
    """A law with its uncertainty.

    Attributes
    ----------
    law : the eight constants.
    standard_errors : by the law's field names, and for ``poisson_yx``, ``poisson_xy``,
        ``modulus_course``, ``modulus_wale`` (each carried through the jackknife, correlations
        included).
    reduction : its name.
    rms_n_per_mm : of all residuals; ``rms_course_n_per_mm`` and ``rms_wale_n_per_mm`` of one test.
    largest_strain : fitted range per direction.
    residuals : data for plots, per direction.
    curves : median curve of the pulls per direction, to be kept with the law.
    runs : number of pulls used per direction.
    error_method : how the standard errors were found.
    notes : readings left out, and constants that the tests do not determine.
    uncertainty : of moduli and whole curves (recommended reduction).
    waist_rms : simulated minus measured strain of the waist, per direction (recommended reduction).
    """

    law: ConstitutiveLaw
    standard_errors: dict[str, float]
    reduction: Reduction
    rms_n_per_mm: float
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float
    largest_strain: dict[Direction, float]
    residuals: dict[Direction, Residuals]
    curves: dict[Direction, MeasuredCurve]
    runs: dict[Direction, int]
    error_method: str
    notes: tuple[str, ...]
    uncertainty: LawUncertainty | None = None
    waist_rms: dict[Direction, float] | None = None

    @classmethod
    def of(
        cls, tests: Sequence[StretchTest], residuals: dict[Direction, Residuals], **more: Any
    ) -> LawFit:
        """The fit of a course-wise and a wale-wise test; ``more`` are its other fields."""
        off = {d: r.stress - r.fitted for d, r in residuals.items()}
        by_direction = dict(zip(Direction, tests, strict=True))
        return cls(
            rms_n_per_mm=rms(np.concatenate([*off.values()])),
            rms_course_n_per_mm=rms(off[Direction.COURSE]),
            rms_wale_n_per_mm=rms(off[Direction.WALE]),
            residuals=residuals,
            curves={d: median_curve(test) for d, test in by_direction.items()},
            runs={d: len(test.runs) for d, test in by_direction.items()},
            **more,
        )


def fit_law(
    course: StretchTest, wale: StretchTest, *, reduction: Reduction = Reduction.UNIFORM
) -> LawFit:
    """Fit the eight constants to a course-wise and a wale-wise test, assuming even strain.

    Raises
    ------
    InputError
        If the tests do not belong together, no stable law describes them, or the reduction is the
        recommended one, which needs simulated tests (:func:`knitcore.fit.strip_fit.fit_tests`).
    """
    if reduction is Reduction.RECOMMENDED:
        problem = "the recommended reduction needs simulated tests."
        raise InputError("reduction", problem, "Call knitcore.fit.strip_fit.fit_tests.")
    notes = [*course.notes, *wale.notes, *check_pair(course, wale), *check_units(course, wale)]
    fits, ratios, law = _fit(course, wale, reduction)
    replicates = [
        [_quantities(_fit(c, w, reduction)[2]) for c, w in replicas]
        for replicas in _replicas(course, wale)
    ]
    errors = _jackknife(replicates)
    residuals = {
        d: Residuals.of(test, fit.largest_strain, partial(fit.stress, poisson_coupling=ratio))
        for d, test, fit, ratio in zip(Direction, (course, wale), fits, ratios[::-1], strict=True)
    }
    for direction, fit in zip(Direction, fits, strict=True):
        notes += _range_notes(direction, fit)
    single = [t.source for t in (course, wale) if len(t.runs) == 1]
    return LawFit.of(
        (course, wale),
        residuals,
        law=law,
        standard_errors=errors,
        reduction=reduction,
        largest_strain={d: f.largest_strain for d, f in zip(Direction, fits, strict=True)},
        error_method="jackknife over pulls"
        if not single
        else f"jackknife over blocks of strain ({', '.join(single)}); scatter of pulls unknown",
        notes=tuple(notes),
    )


def _fit(
    course: StretchTest, wale: StretchTest, reduction: Reduction
) -> tuple[tuple[DirectionFit, DirectionFit], tuple[float, float], ConstitutiveLaw]:
    """Fits (course, wale), Poisson ratios (yx, xy), law."""
    tests = (course, wale)
    for test in tests:
        if not np.isfinite(test.pooled().strain_across).all():
            remedy = f"Measure it, or use the {Reduction.RECOMMENDED} reduction."
            raise InputError(test.source, "has no strain across the pull.", remedy)
    ratios = tuple(_poisson_ratio(test, reduction) for test in tests)
    fits = tuple(
        fit_direction(*_points(test, reduction), poisson_coupling=ratios[1 - axis])
        for axis, test in enumerate(tests)
    )
    x, y = fits
    if ratios[0] * ratios[1] >= 1:
        raise InputError(
            f"{course.source}, {wale.source}",
            f"give Poisson ratios {ratios[0]:.3f} and {ratios[1]:.3f}, whose product is not"
            " below 1: no stable sheet has them.",
            "Check that both tests are of the same fabric and that strain_across is right.",
        )
    return (x, y), (ratios[0], ratios[1]), law_of_directions(x, y, *ratios)


def _poisson_ratio(test: StretchTest, reduction: Reduction) -> float:
    if reduction is Reduction.PUBLISHED:
        return float(-_poisson_line(test)[0])
    along, across, _, weight = _points(test, reduction)
    return float(-np.sum(weight * along * across) / np.sum(weight * along**2))


def _poisson_line(test: StretchTest) -> tuple[float, float]:
    """Slope and intercept of the strain across over the strain along, through all points."""
    points = test.pooled()
    along, across = points.strain_along, points.strain_across
    centred = along - along.mean()
    slope = float(np.sum(centred * across) / np.sum(centred**2))
    return slope, float(across.mean() - slope * along.mean())


def _points(test: StretchTest, reduction: Reduction) -> tuple[Array, Array, Array, Array]:
    """(strain along, strain across, stress, weight) of the points that the fit sees."""
    if reduction is Reduction.PUBLISHED:
        points = test.pooled()
        inside = _shared_range(test, points.strain_along)
        along = points.strain_along[inside]
        slope, intercept = _poisson_line(test)
        across = intercept + slope * along
        return along, across, points.stress[inside], np.ones(len(along))
    columns = [np.concatenate(parts) for parts in zip(*map(_binned, test.runs), strict=True)]
    return columns[0], columns[1], columns[2], columns[3]


def _shared_range(test: StretchTest, strain: Array) -> Mask:
    """Points between the strains where every complete pull has begun and none has ended."""
    peak = test.peak_stress
    complete = [r for r in test.runs if r.stress.max() >= COMPLETE_SHARE * peak]
    low = max(float(r.strain_along[0]) for r in complete)
    high = min(float(r.strain_along.max()) for r in complete)
    if high - low < SHARED_SHARE * np.ptp(strain):
        return np.ones(len(strain), dtype=bool)
    return np.asarray((strain >= low) & (strain <= high))


def _binned(run: StretchRun) -> tuple[Array, Array, Array, Array]:
    """Means over strain intervals of equal size; the weights of a run add up to one."""
    mean = run.averaged(BINS, float(run.strain_along.max()), below=True)
    weights = np.full(mean.length, 1.0 / mean.length)
    return mean.strain_along, mean.strain_across, mean.stress, weights


def _replicas(
    course: StretchTest, wale: StretchTest
) -> Iterator[list[tuple[StretchTest, StretchTest]]]:
    """Both tests with one part of one of them left out."""
    yield [(part, wale) for part in _reduced(course)]
    yield [(course, part) for part in _reduced(wale)]


def _reduced(test: StretchTest) -> list[StretchTest]:
    if len(test.runs) > 1:
        return [test.without(i) for i in range(len(test.runs))]
    run = test.runs[0]
    # The end points stay, so that a block removes information but not the range.
    edges = np.linspace(run.strain_along.min(), run.strain_along.max(), BLOCKS + 1)
    block = np.clip(np.digitize(run.strain_along, edges) - 1, 0, BLOCKS - 1)
    last = np.argmax(run.strain_along)
    parts = []
    for index in range(BLOCKS):
        keep = block != index
        keep[last] = True
        if keep.sum() >= 10 and not keep.all():
            parts.append(replace(test, runs=(run.only(keep),)))
    return parts


def _quantities(law: ConstitutiveLaw) -> dict[str, float]:
    names = (
        "stiffness_xxxx stiffness_yyyy stiffness_xxyy stiffness_yyxx alpha_xx alpha_yy beta_xx"
        " beta_yy poisson_yx poisson_xy modulus_course modulus_wale"
    )
    return {name: float(getattr(law, name)) for name in names.split()}


def _jackknife(replicates: list[list[dict[str, float]]]) -> dict[str, float]:
    """Standard errors from estimates with one part left out, summed over independent tests."""
    if min(len(test) for test in replicates) < 2:
        remedy = "Give pulls with readings all the way from rest to the largest force."
        raise InputError("tests", "have too few different readings for a standard error.", remedy)
    errors = {}
    for name in replicates[0][0]:
        variance = 0.0
        for test in replicates:
            values = np.array([replica[name] for replica in test])
            n = len(values)
            variance += (n - 1) / n * float(np.sum((values - values.mean()) ** 2))
        errors[name] = float(np.sqrt(variance))
    return errors


def median_curve(test: StretchTest) -> MeasuredCurve:
    """Median stress of the pulls at equal steps of strain.

    Each pull is first averaged over steps of strain, which removes the camera's noise.
    The curve goes as far as at least half of the pulls do.

    Raises
    ------
    InputError
        If the pulls have no range of strain in common.

    Examples
    --------
    >>> from knitcore.measure.stretch_test import StretchRun
    >>> strain = np.linspace(0, 0.5, 200)
    >>> runs = tuple(StretchRun("", strain, -strain, k * strain) for k in (0.9, 1.0, 2.0))
    >>> curve = median_curve(StretchTest("", "", runs, (70.0,) * 3))
    >>> round(curve.strain[-1], 3), round(curve.stress_n_per_mm[-1], 2), curve.pulls
    (0.496, 0.5, 3)
    """
    centres = (np.arange(CURVE_POINTS) + 0.5) / CURVE_POINTS * test.usual_strain
    stresses = np.full((len(test.runs), CURVE_POINTS), np.nan)
    for stress, run in zip(stresses, test.runs, strict=True):
        mean = run.averaged(CURVE_POINTS, test.usual_strain)
        outside = (centres < run.strain_along.min()) | (centres > run.strain_along.max())
        stress[:] = np.where(outside, np.nan, np.interp(centres, mean.strain_along, mean.stress))
    known = np.isfinite(stresses).sum(axis=0) * 2 >= len(test.runs)
    median = np.nanmedian(stresses[:, known], axis=0)
    return MeasuredCurve(
        tuple(centres[known].round(5).tolist()), tuple(median.round(6).tolist()), len(test.runs)
    )


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def _range_notes(direction: Direction, fit: DirectionFit) -> list[str]:
    share = fit.alpha * fit.largest_strain
    if fit.stress_scale <= 0 or share < 0.01:
        return [f"The {direction} test shows no stiffening: alpha and beta are not determined."]
    if share > 0.99 * ALPHA_SHARE_LIMIT:
        return [f"The {direction} test ends at its lock-up: alpha is a bound, not an estimate."]
    if fit.stiffness <= 0.02 * fit.stress_scale / fit.largest_strain:
        return [f"The {direction} test has hardly a linear part: its stiffness is uncertain."]
    return []
