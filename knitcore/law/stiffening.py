"""The strain-stiffening term of the constitutive law, as functions of s = alpha * strain.

With ``w``, ``w'`` and ``w''`` from here, a direction's stiffening energy density is
``beta / alpha * w(s)``, its stress ``beta * w'(s)`` and its stiffness ``alpha * beta * w''(s)``.

Two forms by name:

``full``
    The law as the paper states it (Note 7), ``w = s**3 / (1 - s)``, for ``0 <= s <= 0.98``. Slack
    yarn does not stiffen, so ``w = 0`` for ``s < 0``; continued to compression the printed term
    loses convexity in half of the paper's rows. Beyond 0.98 (1 is the lock-up) the energy continues
    as its osculating quadratic, twice continuously differentiable, so that a solver may overshoot.
``published``
    The form of the paper's finite-element demonstration (Note 9): the energy truncated at quartic
    order in the strain, ``w = s**3 + s**4``, in tension and compression. It never locks.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from knitcore.base.arrays import Array

EXTENSION_START = 0.98
"""s above which the full form is continued by its osculating quadratic."""


class StiffeningForm(StrEnum):
    """Form of the stiffening term."""

    FULL = "full"
    PUBLISHED = "published"


Values = TypeVar("Values", float, NDArray[np.float64])


def full(s: Values) -> tuple[Values, Values, Values]:
    """``w``, ``w'`` and ``w''`` of the full form, at a number or an array."""
    inside = np.minimum(np.maximum(s, 0.0), EXTENSION_START)
    square, over_gap = inside * inside, 1.0 / (1.0 - inside)
    slope = square * (3.0 - 2.0 * inside) * over_gap * over_gap
    curvature = 2.0 * over_gap * over_gap * over_gap - 2.0
    beyond = np.maximum(s - EXTENSION_START, 0.0)
    energy = square * inside * over_gap + slope * beyond + 0.5 * curvature * beyond * beyond
    return energy, slope + curvature * beyond, curvature


def published(s: Values) -> tuple[Values, Values, Values]:
    """``w``, ``w'`` and ``w''`` of the published form, at a number or an array."""
    return s**3 * (1.0 + s), s * s * (3.0 + 4.0 * s), s * (6.0 + 12.0 * s)


def shear_response(
    angle: Values, modulus: Values | float, growth: Values | float
) -> tuple[Values, Values, Values]:
    """Energy density, stress and stiffness (N/mm) in shear by an angle (rad).

    The stress is ``modulus angle (1 + growth angle**2)``, with the shear modulus in N/mm and its
    growth in 1/rad².
    """
    grown = growth * angle * angle
    stress = modulus * angle * (1.0 + grown)
    energy = 0.5 * modulus * angle * angle * (1.0 + 0.5 * grown)
    return energy, stress, modulus * (1.0 + 3.0 * grown)


def stiffening(
    s: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """``w``, ``w'`` and ``w''`` at s (dimensionless arrays of the shape of s)."""
    x = np.asarray(s, dtype=float)
    return published(x) if form is StiffeningForm.PUBLISHED else full(x)


@dataclass(frozen=True, eq=False)
class StiffeningResponse:
    """Energy density and stresses (N/mm) of the stiffening, and their derivatives (N/mm)."""

    energy: Array
    stress_xx: Array
    stress_yy: Array
    tangent_xx: Array
    tangent_yy: Array
    tangent_xy: Array


class CoupledStiffening:
    """The stiffening of both directions, each coupled to the strain across by its kappa.

    Its energy density is ``beta_xx/alpha_xx w(alpha_xx (e_xx + kappa_xx g_yy))`` and likewise for
    y, with ``g = e + e**2 / 2``, half the change of the squared stretch. So the pull on the width
    fades as the width does, and no stretch narrows a sheet to nothing; the energy is convex. The
    published form leaves the couplings out.

    Parameters
    ----------
    alpha_xx, alpha_yy, beta_xx, beta_yy, kappa_xx, kappa_yy : numbers or arrays
        That broadcast with the strains; beta in N/mm.
    """

    def __init__(
        self,
        alpha_xx: ArrayLike,
        alpha_yy: ArrayLike,
        beta_xx: ArrayLike,
        beta_yy: ArrayLike,
        kappa_xx: ArrayLike,
        kappa_yy: ArrayLike,
    ) -> None:
        self.alpha_xx, self.alpha_yy = _array(alpha_xx), _array(alpha_yy)
        self.beta_xx, self.beta_yy = _array(beta_xx), _array(beta_yy)
        self.kappa_xx, self.kappa_yy = _array(kappa_xx), _array(kappa_yy)

    def arguments(
        self, strain_xx: ArrayLike, strain_yy: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
    ) -> tuple[Array, Array]:
        """s course-wise and wale-wise; 1 is the lock-up."""
        xx, yy = _array(strain_xx), _array(strain_yy)
        kappa_x, kappa_y = self._kappa(form)
        return (
            self.alpha_xx * (xx + kappa_x * (yy + yy * yy / 2)),
            self.alpha_yy * (yy + kappa_y * (xx + xx * xx / 2)),
        )

    def argument_slopes(
        self, strain_xx: ArrayLike, strain_yy: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
    ) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Derivatives of both arguments by the strains course-wise and wale-wise."""
        kappa_x, kappa_y = self._kappa(form)
        across_x = self.alpha_xx * kappa_x * (1 + _array(strain_yy))
        across_y = self.alpha_yy * kappa_y * (1 + _array(strain_xx))
        return (self.alpha_xx, across_x), (across_y, self.alpha_yy)

    def response(
        self, strain_xx: ArrayLike, strain_yy: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
    ) -> StiffeningResponse:
        """Energy, stresses and derivatives at strains that broadcast."""
        s_x, s_y = self.arguments(strain_xx, strain_yy, form)
        energy_x, slope_x, curvature_x = stiffening(s_x, form)
        energy_y, slope_y, curvature_y = stiffening(s_y, form)
        bent_x, bent_y = self._kappa(form)
        kappa_x, kappa_y = bent_x * (1 + _array(strain_yy)), bent_y * (1 + _array(strain_xx))
        stress_x, stress_y = self.beta_xx * slope_x, self.beta_yy * slope_y
        tangent_x = self.alpha_xx * self.beta_xx * curvature_x
        tangent_y = self.alpha_yy * self.beta_yy * curvature_y
        return StiffeningResponse(
            energy=_over(self.beta_xx, self.alpha_xx) * energy_x
            + _over(self.beta_yy, self.alpha_yy) * energy_y,
            stress_xx=stress_x + kappa_y * stress_y,
            stress_yy=stress_y + kappa_x * stress_x,
            tangent_xx=tangent_x + kappa_y**2 * tangent_y + bent_y * stress_y,
            tangent_yy=tangent_y + kappa_x**2 * tangent_x + bent_x * stress_x,
            tangent_xy=kappa_x * tangent_x + kappa_y * tangent_y,
        )

    def _kappa(self, form: StiffeningForm) -> tuple[Array, Array]:
        if form is StiffeningForm.FULL:
            return self.kappa_xx, self.kappa_yy
        return np.zeros(()), np.zeros(())


def _array(values: ArrayLike) -> Array:
    return np.asarray(values, dtype=float)


def _over(beta: Array, alpha: Array) -> Array:
    """beta / alpha, and 0 where alpha = 0 (a law that never stiffens)."""
    shape = np.broadcast_shapes(alpha.shape, beta.shape)
    return np.asarray(np.divide(beta, alpha, out=np.zeros(shape), where=alpha > 0))
