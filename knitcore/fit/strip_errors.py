"""Uncertainty of a law fitted to stretch tests, to first order about the fit.

An interval of a curve is for the next test of the same fabric, knitted and pulled alike. Its error
is estimated from the tests themselves: each pull is predicted from the others, and the squared
errors, which include the scatter between pulls and the misfit of the law, are averaged. A few pulls
say little about their own scatter, so the typical error counts as one more pull. The width of
another sample is a new reading (:data:`LOG_WIDTH_READING`); strain is a ratio of lengths in one
picture and needs no scale.

Standard errors of single constants are those of the jackknife over pulls, of the scatter about the
fit, a few neighbouring points counting as one, and of the widths.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from knitcore.base.arrays import Array
from knitcore.fit.measured_strip import LEVELS, WAIST_NOISE, MeasuredStrip, force_noise
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.materials.law_uncertainty import (
    QUIET_STRESS_N_PER_MM,
    CurveUncertainty,
    LawUncertainty,
)

LOG_WIDTH_READING = 0.03
"""Standard deviation of the logarithm of a clamped width read from a picture."""
TYPICAL_LOG_ERROR = 0.046
"""Error of the force of a pull predicted from the others: rms over acrylic's eight tests
(``studies/true_to_tests.py --left-out`` prints it)."""
LOG_SHEAR_DOUBT = 0.7
"""Standard deviation of ln C_xyxy beside what the fit says: tests along course and wale are hardly
sensitive to it, and what is known of it varies as much
(:data:`knitcore.fit.strip_fit.LOG_SHEAR_PRIOR`).
"""
NEIGHBOURS = 3.5
"""Errors of neighbouring points are correlated; this many count as one."""

_DERIVED = ("poisson_yx", "poisson_xy", "modulus_course", "modulus_wale")
_NAMES = (*(field.name for field in fields(ConstitutiveLaw)), *_DERIVED)


@dataclass(frozen=True, eq=False)
class LinearFit:
    """A fit to first order about its solution.

    Attributes
    ----------
    strips : the tests, course-wise and wale-wise.
    unknowns : (n,).
    residuals : of force and waist of each test in turn, then of the priors.
    jacobian : (residuals, n).
    flattening : per test, how much its waist strain exceeds the simulated one at all levels.
    law_of : the law of unknowns.
    log_lock_up, log_shear : places of ln alpha (course, wale) and ln C_xyxy / sqrt(Y_x Y_y) among
        the unknowns.
    """

    strips: Sequence[MeasuredStrip]
    unknowns: Array
    residuals: Array
    jacobian: Array
    flattening: tuple[float, ...]
    law_of: Callable[[Array], ConstitutiveLaw]
    log_lock_up: tuple[int, int]
    log_shear: int

    @cached_property
    def covariance(self) -> Array:
        """Covariance of the unknowns: between pulls, scatter, and readings of width."""
        scatter = float(self.residuals @ self.residuals)
        scatter /= max(len(self.residuals) - len(self.unknowns), 1)
        weak = self.jacobian.copy()
        weak[: 2 * LEVELS * len(self.strips)] /= math.sqrt(NEIGHBOURS * max(scatter, 0.1))
        total = np.linalg.pinv(weak.T @ weak)
        for test, strip in enumerate(self.strips):
            stress = strip.means[0]
            width = LOG_WIDTH_READING * stress / force_noise(stress)
            step = self._step(test, np.append(width, np.zeros(LEVELS)))
            total = total + np.outer(step, step)
            for _, step in self._without_pulls(test):
                total = total + (strip.pulls - 1) / strip.pulls * np.outer(step, step)
        return np.asarray(total)

    @property
    def errors(self) -> dict[str, float]:
        """Standard errors of constants, Poisson ratios and moduli."""

        def values(at: Array) -> Array:
            law = self.law_of(at)
            return np.array([getattr(law, name) for name in _NAMES])

        steps = 1e-5 * np.eye(len(self.unknowns))
        slopes = np.array(
            [(values(self.unknowns + d) - values(self.unknowns - d)) / 2e-5 for d in steps]
        )
        variances = np.einsum("ji,jk,ki->i", slopes, self.covariance, slopes)
        return dict(zip(_NAMES, np.sqrt(variances).tolist(), strict=True))

    @property
    def uncertainty(self) -> LawUncertainty:
        """Uncertainty of moduli, curves and Poisson ratios, such that the waists are covered."""
        law, errors = self.law_of(self.unknowns), self.errors
        curves, waists = [], []
        for test, strip in enumerate(self.strips):
            stress, waist = strip.means
            force_error, waist_error = self._left_out(test)
            loaded = stress > QUIET_STRESS_N_PER_MM
            loaded = loaded if loaded.any() else np.ones(LEVELS, dtype=bool)
            relative = (force_error * force_noise(stress) / stress)[:, loaded]
            own = np.nansum(np.nanmean(relative**2, axis=1)) * _from_all(strip.pulls)
            pull = (own + TYPICAL_LOG_ERROR**2) / (strip.pulls + 1)
            log_stress = math.sqrt(pull + LOG_WIDTH_READING**2)
            lock_up = self.log_lock_up[test]
            curves.append(
                CurveUncertainty(log_stress, math.sqrt(self.covariance[lock_up, lock_up]))
            )
            if np.isfinite(waist).all():
                missed = math.sqrt(np.nanmean((WAIST_NOISE * waist_error) ** 2))
                rms = math.hypot(missed, self.flattening[test])
                waists.append(rms / max(math.sqrt(np.mean(waist**2)), 1e-3))
            else:  # the prior's, carried through the fit
                name = ("poisson_yx", "poisson_xy")[test]
                waists.append(errors[name] / max(abs(getattr(law, name)), 1e-3))
        return LawUncertainty(
            log_modulus_course=errors["modulus_course"] / law.modulus_course,
            log_modulus_wale=errors["modulus_wale"] / law.modulus_wale,
            poisson_yx=abs(law.poisson_yx) * waists[0],
            poisson_xy=abs(law.poisson_xy) * waists[1],
            source="pulls predicted from the others, reading of the width",
            curve_course=curves[0],
            curve_wale=curves[1],
            log_shear=math.hypot(
                math.sqrt(self.covariance[self.log_shear, self.log_shear]), LOG_SHEAR_DOUBT
            ),
        )

    def _left_out(self, test: int) -> tuple[Array, Array]:
        """Errors of force and waist, (pulls, levels), in units of their noise.

        Each pull is compared with the others, a single pull with itself; NaN where a pull does
        not reach.
        """
        strip, rows = self.strips[test], self._rows(test)
        stress, waist = strip.means
        own = np.hstack(
            [
                (strip.stress_n_per_mm - stress) / force_noise(stress),
                (strip.waist - waist) / WAIST_NOISE,
            ]
        )
        errors = own - self.residuals[rows]
        for index, step in self._without_pulls(test):
            errors[index] -= self.jacobian[rows] @ step
        return errors[:, :LEVELS], errors[:, LEVELS:]

    def _without_pulls(self, test: int) -> Iterator[tuple[int, Array]]:
        """Yield each pull's number, and how much the unknowns change if it is left out."""
        strip = self.strips[test]
        stress, waist = strip.means
        for index in range(strip.pulls if strip.pulls > 1 else 0):
            less_stress, less_waist = strip.without(index).means
            moved = [
                (less_stress - stress) / force_noise(stress),
                (less_waist - waist) / WAIST_NOISE,
            ]
            yield index, self._step(test, np.nan_to_num(np.concatenate(moved)))

    def _step(self, test: int, shift: Array) -> Array:
        """Step of the unknowns if a test's force and waist change by ``shift`` (in their noise)."""
        inverse = np.linalg.pinv(self.jacobian.T @ self.jacobian)
        return np.asarray(inverse @ (self.jacobian[self._rows(test)].T @ shift))

    @staticmethod
    def _rows(test: int) -> slice:
        """Rows of a test's forces and waists among the residuals."""
        return slice(2 * LEVELS * test, 2 * LEVELS * (test + 1))


def _from_all(pulls: int) -> float:
    """Squared error of a pull predicted from ``pulls`` others, over that from ``pulls`` - 1."""
    return (1 + 1 / pulls) / (1 + 1 / (pulls - 1)) if pulls > 1 else 1.0
