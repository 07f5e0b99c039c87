"""Fitting shear modulus and coupling, which a stretch test does not determine, to a field.

Unknowns are the shear modulus, a factor on both couplings C_xxyy and C_yyxx, and kappa, the
transverse coupling of the stiffening. A force curve of the pulled direction, if given, adds the
three constants of that direction, so that forces keep fitting while the coupling changes.

Measured edge motion is imposed, so that errors of the clamps do not end up in the law. The three
unknowns are correlated over a small range of stretch, where kappa hardly matters; a broad prior on
kappa and on the logarithm of the shear modulus keeps the fit from running away, and is part of the
report. The prior's centre was chosen on an acrylic garter swatch; see ``docs/swatch.md``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.errors import Cancelled, InputError, check_cancelled
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.cloth.flat.sheet_models import SheetModel
from knitcore.cloth.flat.strip import LOCK_UP_SHARE, pull
from knitcore.cloth.flat.strip_uncertainty import LOG_SHEAR_PRIOR
from knitcore.fit.field_comparison import Edges, even_sheet, field_differences, field_sheet
from knitcore.fit.measured_field import MeasuredField
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.measure.stretch_test import StretchTest

FIELD_NOISE_PERCENT = 0.12
"""Error of a measured displacement in percent of the width: half the left-right asymmetry."""
INDEPENDENT_POINTS = 50
"""Errors of neighbouring points are correlated; a frame counts as this many independent points."""
FORCE_NOISE = 0.03
"""Relative error of a mean force curve. A strip fit, which holds two tests at once, leaves 0.04
(:data:`knitcore.fit.measured_strip.FORCE_NOISE`)."""
FORCE_POINTS = 12
CURVE_BINS = 40
KAPPA_PRIOR = (0.45, 0.15)
"""Mean and standard deviation. Narrower than a strip fit's (:mod:`knitcore.fit.strip_fit`): a
field of small stretch hardly tells kappa from the coupling."""
CELLS_ACROSS = 64
SAMPLED_POINTS = 4000

_BOUNDS = {
    "shear_modulus": (1e-4, 1.0),
    "coupling_factor": (0.2, 4.0),
    "stiffening_coupling": (0.0, 1.0),
    "stiffness_factor": (0.2, 5.0),
    "alpha_factor": (0.5, 2.0),
    "beta_factor": (0.05, 20.0),
}


@dataclass(frozen=True, eq=False)
class ForceCurve:
    """Measured stress (N/mm) at clamp-to-clamp strains, and the sample's size across and along."""

    strain: Array
    stress_n_per_mm: Array
    width_mm: float
    length_mm: float

    @classmethod
    def of_test(cls, test: StretchTest, length_over_width: float) -> ForceCurve:
        """The mean curve of a test's pulls, over the strain that all of them reach.

        Raises
        ------
        InputError
            If the pulls are too short or too sparse for a curve.
        """
        top = min(float(run.strain_along.max()) for run in test.runs)
        mean = test.pooled().averaged(CURVE_BINS, top)
        if mean.length < CURVE_BINS / 2:
            remedy = f"Give a test with readings at {CURVE_BINS} evenly spread strains or more."
            raise InputError("tests", f"{test.source} has too few points.", remedy)
        width = float(np.mean(test.width_mm))
        return cls(mean.strain_along, mean.stress, width, width * length_over_width)


@dataclass(frozen=True, eq=False, repr=False)
class Calibration(Result):
    """A calibrated law.

    Attributes
    ----------
    law : the constants, with shear modulus and coupling of the stiffening.
    parameters, standard_errors : the fitted unknowns by name; factors are on the law given.
    frames : those that were fitted.
    force_ratio : simulated over measured force at ``force_strain`` (empty without a curve).
    evaluations : simulated tests.
    """

    law: ConstitutiveLaw
    parameters: dict[str, float]
    standard_errors: dict[str, float]
    frames: tuple[int, ...]
    force_strain: Array
    force_ratio: Array
    evaluations: int


def calibrate(
    field: MeasuredField,
    law: ConstitutiveLaw,
    direction: Direction,
    *,
    forces: ForceCurve | None = None,
    cancelled: Cancelled | None = None,
) -> Calibration:
    """Fit shear modulus and couplings to a measured field (and a force curve).

    Parameters
    ----------
    field : the measurement; leave pictures out (:meth:`MeasuredField.only`) to validate the fit.
    law : the law to start from, from tests or tables.
    direction : in which field and forces were measured.
    forces : force curve in the same direction.
    cancelled : called between simulated tests; True stops the fit.

    Raises
    ------
    InputError
        If the law locks up before the largest stretch of the frames.
    CancelledError
        If ``cancelled`` returned True.
    """
    names = ["shear_modulus", "coupling_factor", "stiffening_coupling"]
    start = [0.02, 1.5, KAPPA_PRIOR[0]]
    if forces is not None:
        names += ["stiffness_factor", "alpha_factor", "beta_factor"]
        start += [1.0, 1.0, 1.0]
    largest = max(field.stretch(frame) for frame in field.frames)
    if largest >= LOCK_UP_SHARE * law.lock_up_strain(direction):
        raise InputError(
            "law",
            f"it locks up {direction}-wise before the largest picture's stretch {largest:.3f}.",
            "Give a law fitted to tests of at least that stretch.",
        )
    problem = _Problem(field, law, direction, forces, tuple(names), cancelled or (lambda: False))
    low, high = np.array([_BOUNDS[name] for name in names]).T
    scaled = _to_unknowns(np.array(start))
    fit = scipy.optimize.least_squares(
        problem.residuals,
        scaled,
        bounds=(_to_unknowns(low), _to_unknowns(high)),
        diff_step=[5e-3] * len(names),
        x_scale=np.where(np.arange(len(names)) == 2, 0.3, 1.0),
        xtol=1e-4,
        ftol=1e-4,
        max_nfev=20,
    )
    values = _to_values(fit.x)
    fitted = problem.law_of(values)
    jacobian = np.asarray(fit.jac, dtype=float)
    covariance = np.linalg.pinv(jacobian.T @ jacobian)
    slopes = np.where(np.arange(len(names)) == 2, 1.0, values)  # d value / d unknown
    spread = np.sqrt(np.diag(covariance)) * slopes
    strain, ratio = problem.force_ratios(fitted)
    return Calibration(
        law=fitted,
        parameters=dict(zip(names, values.tolist(), strict=True)),
        standard_errors=dict(zip(names, spread.tolist(), strict=True)),
        frames=tuple(frame.number for frame in field.frames),
        force_strain=strain,
        force_ratio=ratio,
        evaluations=problem.evaluations,
    )


class _Problem:
    """Residuals of a set of unknowns, weighted so that each is about 1."""

    def __init__(
        self,
        field: MeasuredField,
        law: ConstitutiveLaw,
        direction: Direction,
        forces: ForceCurve | None,
        names: tuple[str, ...],
        cancelled: Cancelled,
    ) -> None:
        self.field, self.law, self.direction = field.thinned(SAMPLED_POINTS), law, direction
        self.names, self.cancelled = names, cancelled
        self.evaluations = 0
        self.strain, self.stress = np.empty(0), np.empty(0)
        self.forces = forces
        if forces is not None:
            limit = 0.9 * law.lock_up_strain(direction)
            top = min(float(forces.strain.max()), limit)
            self.strain = np.linspace(0.15 * top, top, FORCE_POINTS)
            self.stress = np.interp(self.strain, forces.strain, forces.stress_n_per_mm)

    def law_of(self, values: Array) -> ConstitutiveLaw:
        """The law of a set of values."""
        v = dict(zip(self.names, values, strict=True))
        wale = self.direction is Direction.WALE
        suffix = "yy" if wale else "xx"
        factor = v["coupling_factor"]
        constants = {
            "stiffness_xxyy": self.law.stiffness_xxyy * factor,
            "stiffness_yyxx": self.law.stiffness_yyxx * factor,
            "shear_modulus": v["shear_modulus"],
        }
        for name, key in (("stiffness", "stiffness_factor"), ("alpha", "alpha_factor")):
            field = f"{name}_{suffix * 2 if name == 'stiffness' else suffix}"
            constants[field] = getattr(self.law, field) * v.get(key, 1.0)
        constants[f"beta_{suffix}"] = getattr(self.law, f"beta_{suffix}") * v.get("beta_factor", 1)
        kappa = np.clip(v["stiffening_coupling"], 0, 1)
        constants |= {"kappa_xx": kappa, "kappa_yy": kappa}
        return replace(self.law, **{name: float(value) for name, value in constants.items()})

    def residuals(self, unknowns: Array) -> Array:
        """Weighted differences; large ones where the law is unstable or does not converge."""
        check_cancelled(self.cancelled)
        self.evaluations += 1
        values = _to_values(unknowns)
        prior = np.array(
            [
                (np.log(values[0]) - LOG_SHEAR_PRIOR[0]) / LOG_SHEAR_PRIOR[1],
                (values[2] - KAPPA_PRIOR[0]) / KAPPA_PRIOR[1],
            ]
        )
        counts = [2 * len(frame.points) for frame in self.field.frames]
        penalty = np.full(sum(counts) + len(self.strain) + 2, 10.0)
        try:
            law = self.law_of(values)
            sheet = field_sheet(self.field, law, self.direction, SheetModel(), CELLS_ACROSS)
            differences, _ = field_differences(self.field, sheet, self.direction, Edges.MEASURED)
            _, ratios = self.force_ratios(law)
        except InputError:
            return penalty
        if len(differences) < len(counts) or len(ratios) < len(self.strain):
            return penalty
        percent = 100 / self.field.width / FIELD_NOISE_PERCENT
        parts = [
            (d * percent * np.sqrt(INDEPENDENT_POINTS / n)).ravel()
            for d, n in zip(differences, counts, strict=True)
        ]
        return np.concatenate([*parts, (ratios - 1) / FORCE_NOISE, prior])

    def force_ratios(self, law: ConstitutiveLaw) -> tuple[Array, Array]:
        """Strains and simulated over measured forces of the strip test."""
        if self.forces is None:
            return self.strain, np.empty(0)
        across, along = self.forces.width_mm, self.forces.length_mm
        cells = 40, max(4, round(40 * along / across))
        sheet = even_sheet(law, self.direction, cells, (across, along), SheetModel())
        test = pull(sheet, self.direction, self.strain)
        return test.strain, test.stress_n_per_mm / self.stress[: test.steps]


def _to_unknowns(values: Array) -> Array:
    """Unknowns of values: logarithms of all except kappa (the third)."""
    out = np.log(np.maximum(values, 1e-12))
    out[2] = values[2]
    return np.asarray(out)


def _to_values(unknowns: Array) -> Array:
    out = np.exp(unknowns)
    out[2] = unknowns[2]
    return np.asarray(out)
