"""The constitutive law of a knitted fabric as a sheet (the paper's Notes 6 and 7).

    sigma_xx = C_xxxx e_xx + C_xxyy e_yy
               + beta_xx (1 / (1 - alpha_xx e_xx)**2 - 1 - 2 alpha_xx e_xx)

and likewise for y. x is the course direction, y the wale direction. Stress is force per width.

A law fitted to simulated tests also couples the stiffening of each direction to the strain across:
its argument is ``alpha_xx (e_xx + kappa_xx (e_yy + e_yy**2 / 2))``, so a fabric that narrows frees
yarn along the pull, and stiffening pulls the width in, the less the narrower it is. The energy
stays convex for any kappa. The paper's laws have ``kappa = 0``.

In shear the fabric stiffens as its loops jam: at a change gamma of the angle between courses and
wales the stress is ``C_xyxy gamma (1 + shear_stiffening gamma**2)`` (full form only).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.law.stiffening import (
    CoupledStiffening,
    StiffeningForm,
    StiffeningResponse,
    shear_response,
)

DEFAULT_SHEAR_MODULUS_N_PER_MM = 0.01
"""C_xyxy assumed by the paper (Note 9), which does not measure it."""


class Symmetrisation(StrEnum):
    """Rule that makes one of the two measured couplings (an energy needs C_xxyy = C_yyxx).

    ``geometric`` keeps both Young's moduli and the product of the Poisson ratios exactly;
    ``arithmetic`` is the paper's text (Note 9); ``script``, C_xxyy alone, is the authors' script.
    """

    GEOMETRIC = "geometric"
    ARITHMETIC = "arithmetic"
    SCRIPT = "script"


class Transverse(StrEnum):
    """Condition across the pull in a uniaxial test: free to contract, or held at its width."""

    FREE = "free"
    FIXED = "fixed"


@dataclass(frozen=True)
class ConstitutiveLaw:
    """Eight measured constants, two couplings of the stiffening, and two constants of shear.

    Parameters
    ----------
    stiffness_xxxx, stiffness_yyyy, stiffness_xxyy, stiffness_yyxx : N/mm
        C0, the rigidity tensor at zero strain. stiffness_xxyy is d sigma_xx / d e_yy.
    alpha_xx, alpha_yy : dimensionless
        Inverse of the lock-up strain course-wise and wale-wise.
    beta_xx, beta_yy : N/mm
        Stress scale of the stiffening.
    shear_modulus : N/mm
        C_xyxy, stress per engineering shear angle.
    kappa_xx, kappa_yy : dimensionless
        Share of half the squared stretch across that counts in the stiffening course-wise and
        wale-wise (full form only).
    shear_stiffening : 1/rad²
        Growth of the shear stiffness with the angle (full form only); at 4 the secant modulus has
        doubled at half a radian.

    Raises
    ------
    InputError
        If a constant is not finite or negative where it must not be, or if the stiffness is not
        positive definite.
    """

    stiffness_xxxx: float
    stiffness_yyyy: float
    stiffness_xxyy: float
    stiffness_yyxx: float
    alpha_xx: float
    alpha_yy: float
    beta_xx: float
    beta_yy: float
    shear_modulus: float = DEFAULT_SHEAR_MODULUS_N_PER_MM
    kappa_xx: float = 0.0
    kappa_yy: float = 0.0
    shear_stiffening: float = 0.0

    def __str__(self) -> str:
        return f"Y = {self.modulus_course:.3g} N/mm course-wise, {self.modulus_wale:.3g} wale-wise"

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not math.isfinite(value):
                raise InputError(field.name, f"{value} is not a number.", "Give a finite number.")
        for name in ("stiffness_xxxx", "stiffness_yyyy", "shear_modulus"):
            if getattr(self, name) <= 0:
                raise InputError(name, "must be above 0 N/mm.", "Give a positive stiffness.")
        for name in vars(self):
            may_be_negative = name in ("stiffness_xxyy", "stiffness_yyxx")
            if getattr(self, name) < 0 and not may_be_negative:
                raise InputError(name, "must not be negative.", "Give 0 or a positive number.")
        if (self.stiffness_xxyy < 0) != (self.stiffness_yyxx < 0):
            raise InputError(
                "stiffness_yyxx",
                "has the opposite sign of stiffness_xxyy.",
                "Give both couplings the same sign.",
            )
        if self.stiffness_xxxx * self.stiffness_yyyy <= self.stiffness_xxyy * self.stiffness_yyxx:
            raise InputError(
                "stiffness_xxyy",
                "the stiffness is not positive definite.",
                "stiffness_xxyy * stiffness_yyxx must stay below stiffness_xxxx * stiffness_yyyy.",
            )

    @classmethod
    def of_moduli(
        cls,
        modulus_course: float,
        modulus_wale: float,
        poisson_yx: float,
        poisson_xy: float,
        **others: float,
    ) -> ConstitutiveLaw:
        """A law by its Young's moduli (N/mm), Poisson's ratios, and the ``others`` by name.

        Raises
        ------
        InputError
            As for the constants themselves.
        """
        held = 1 - poisson_yx * poisson_xy
        if not held > 0:
            raise InputError(
                "poisson_xy",
                f"{poisson_xy:g} times poisson_yx {poisson_yx:g} is 1 or more.",
                "Their product must stay below 1.",
            )
        xxxx, yyyy = modulus_course / held, modulus_wale / held
        return cls(xxxx, yyyy, poisson_xy * xxxx, poisson_yx * yyyy, **others)

    # -- linear constants -------------------------------------------------------------------

    @property
    def modulus_course(self) -> float:
        """Y_x (N/mm), with the wale direction free."""
        return (1 - self.poisson_xy * self.poisson_yx) * self.stiffness_xxxx

    @property
    def modulus_wale(self) -> float:
        """Y_y (N/mm), with the course direction free."""
        return (1 - self.poisson_xy * self.poisson_yx) * self.stiffness_yyyy

    @property
    def poisson_yx(self) -> float:
        """-e_yy / e_xx when pulled course-wise, C_yyxx / C_yyyy."""
        return self.stiffness_yyxx / self.stiffness_yyyy

    @property
    def poisson_xy(self) -> float:
        """-e_xx / e_yy when pulled wale-wise, C_xxyy / C_xxxx."""
        return self.stiffness_xxyy / self.stiffness_xxxx

    def modulus(self, direction: Direction) -> float:
        """Young's modulus (N/mm) in a direction."""
        return direction.of(self.modulus_course, self.modulus_wale)

    def poisson(self, direction: Direction) -> float:
        """Contraction across a pull in a direction, over the strain along it."""
        return direction.of(self.poisson_yx, self.poisson_xy)

    def alpha(self, direction: Direction) -> float:
        """Inverse of the lock-up strain in a direction."""
        return direction.of(self.alpha_xx, self.alpha_yy)

    def beta(self, direction: Direction) -> float:
        """Stress scale (N/mm) of the stiffening in a direction."""
        return direction.of(self.beta_xx, self.beta_yy)

    def lock_up_strain(self, direction: Direction) -> float:
        """Strain at which the stress diverges at a held width, 1 / alpha (infinite if alpha is 0).

        Where kappa is above 0, a fabric that is free to narrow locks a little later.
        """
        alpha = self.alpha(direction)
        return 1.0 / alpha if alpha > 0 else math.inf

    @property
    def stiffness(self) -> Array:
        """C0 as a (3, 3) matrix in N/mm; order xx, yy, xy (engineering shear)."""
        return np.array(
            [
                [self.stiffness_xxxx, self.stiffness_xxyy, 0.0],
                [self.stiffness_yyxx, self.stiffness_yyyy, 0.0],
                [0.0, 0.0, self.shear_modulus],
            ]
        )

    @property
    def stiffening(self) -> CoupledStiffening:
        """The nonlinear part."""
        return CoupledStiffening(
            self.alpha_xx, self.alpha_yy, self.beta_xx, self.beta_yy, self.kappa_xx, self.kappa_yy
        )

    @property
    def is_symmetric(self) -> bool:
        """Say whether C_xxyy equals C_yyxx, so that an energy exists."""
        return math.isclose(self.stiffness_xxyy, self.stiffness_yyxx, rel_tol=1e-12, abs_tol=1e-15)

    def symmetrised(self, rule: Symmetrisation = Symmetrisation.GEOMETRIC) -> ConstitutiveLaw:
        """The law with one coupling constant.

        Raises
        ------
        InputError
            If the rule makes the stiffness indefinite (``arithmetic`` on lace bamboo stockinette).
        """
        a, b = self.stiffness_xxyy, self.stiffness_yyxx
        match rule:
            case Symmetrisation.GEOMETRIC:
                coupling = math.copysign(math.sqrt(a * b), a)
            case Symmetrisation.ARITHMETIC:
                coupling = (a + b) / 2
            case Symmetrisation.SCRIPT:
                coupling = a
        return replace(self, stiffness_xxyy=coupling, stiffness_yyxx=coupling)

    # -- response ---------------------------------------------------------------------------

    def stress(
        self, strain_xx: ArrayLike, strain_yy: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
    ) -> tuple[Array, Array]:
        """(sigma_xx, sigma_yy) in N/mm at the given strains (arrays that broadcast)."""
        ex, ey = _strains(strain_xx, strain_yy)
        return self._stress(ex, ey, self.stiffening.response(ex, ey, form))

    def _stress(self, ex: Array, ey: Array, stiff: StiffeningResponse) -> tuple[Array, Array]:
        return (
            self.stiffness_xxxx * ex + self.stiffness_xxyy * ey + stiff.stress_xx,
            self.stiffness_yyyy * ey + self.stiffness_yyxx * ex + stiff.stress_yy,
        )

    def energy_density(
        self,
        strain_xx: ArrayLike,
        strain_yy: ArrayLike,
        strain_xy: ArrayLike = 0.0,
        form: StiffeningForm = StiffeningForm.FULL,
    ) -> Array:
        """Stored energy per area (N·mm/mm² = N/mm); strain_xy is the tensor component.

        Raises
        ------
        InputError
            If the law is not symmetric, because then no energy exists.
        """
        if not self.is_symmetric:
            raise InputError(
                "law",
                "C_xxyy differs from C_yyxx, so the law has no energy.",
                "Call symmetrised() first.",
            )
        ex, ey, exy = (np.asarray(e, dtype=float) for e in (strain_xx, strain_yy, strain_xy))
        full = form is StiffeningForm.FULL
        shear, _, _ = shear_response(
            2.0 * exy, self.shear_modulus, self.shear_stiffening if full else 0.0
        )
        total: Array = (
            0.5 * self.stiffness_xxxx * ex**2
            + 0.5 * self.stiffness_yyyy * ey**2
            + self.stiffness_xxyy * ex * ey
            + shear
            + self.stiffening.response(ex, ey, form).energy
        )
        return total

    def tangent(
        self, strain_xx: ArrayLike, strain_yy: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
    ) -> Array:
        """d stress / d strain in N/mm, shape (..., 3, 3) in the order xx, yy, xy (engineering)."""
        return self.linearised(strain_xx, strain_yy, form)[1]

    def linearised(
        self, strain_xx: ArrayLike, strain_yy: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
    ) -> tuple[tuple[Array, Array], Array]:
        """:meth:`stress` and :meth:`tangent`, in the time of one of them."""
        ex, ey = _strains(strain_xx, strain_yy)
        stiff = self.stiffening.response(ex, ey, form)
        tangent = np.broadcast_to(self.stiffness, (*ex.shape, 3, 3)).copy()
        tangent[..., 0, 0] += stiff.tangent_xx
        tangent[..., 1, 1] += stiff.tangent_yy
        tangent[..., 0, 1] += stiff.tangent_xy
        tangent[..., 1, 0] += stiff.tangent_xy
        return self._stress(ex, ey, stiff), tangent


def _strains(xx: ArrayLike, yy: ArrayLike) -> tuple[Array, Array]:
    """Strains as arrays of one shape."""
    ex, ey = np.broadcast_arrays(np.asarray(xx, dtype=float), np.asarray(yy, dtype=float))
    return ex, ey
