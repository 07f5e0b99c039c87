"""Least squares for one direction of the constitutive law.

For a given alpha the law is linear in C and beta,

    sigma = C (e + nu e_across) + S g(alpha e) / g(alpha e85),   g(s) = 1 / (1 - s)**2 - 1 - 2 s,

so these two are solved exactly with bounds (non-negative least squares) and only alpha is searched:
from many starts on a grid, then by bounded minimisation. S, the stiffening stress at
e85 = 0.85 of the largest strain, replaces beta: alpha and beta are correlated by -0.99 in real
tests, alpha and S much less.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.law.constitutive import ConstitutiveLaw

ALPHA_SHARE_LIMIT = 0.999
"""Largest alpha times the largest strain: the lock-up lies beyond every point."""
ALPHA_SHARES = np.concatenate([np.linspace(0.02, 0.9, 30), np.linspace(0.91, 0.998, 20)])
"""Starts of the search, as alpha times the largest strain."""
LINEAR_FLOOR = 1e-4
"""C is at least this share of the secant stiffness of the peak."""


@dataclass(frozen=True)
class DirectionFit:
    """Constants of one direction.

    Attributes
    ----------
    stiffness : C0 along the pull, N/mm.
    alpha : dimensionless.
    stress_scale : S, N/mm at 0.85 of the largest strain.
    beta : N/mm.
    rms : root mean square of the residuals, N/mm.
    largest_strain : of the points fitted.
    """

    stiffness: float
    alpha: float
    stress_scale: float
    beta: float
    rms: float
    largest_strain: float

    def stress(self, strain_along: Array, strain_across: Array, poisson_coupling: float) -> Array:
        """Stress (N/mm) of the fitted direction; poisson_coupling is C_ab / C_aa."""
        linear = self.stiffness * (strain_along + poisson_coupling * strain_across)
        return np.asarray(linear + self.beta * stiffening_stress(self.alpha * strain_along))


def law_of_directions(
    course: DirectionFit, wale: DirectionFit, poisson_yx: float, poisson_xy: float
) -> ConstitutiveLaw:
    """The law of both directions; Poisson's ratios tie its couplings to the stiffnesses.

    Raises
    ------
    InputError
        If the constants make no stable law.
    """
    return ConstitutiveLaw(
        stiffness_xxxx=course.stiffness,
        stiffness_yyyy=wale.stiffness,
        stiffness_xxyy=poisson_xy * course.stiffness,
        stiffness_yyxx=poisson_yx * wale.stiffness,
        alpha_xx=course.alpha,
        alpha_yy=wale.alpha,
        beta_xx=course.beta,
        beta_yy=wale.beta,
    )


def stiffening_stress(s: Array) -> Array:
    """g(s) for s < 1; the published form, continued to negative s as printed."""
    return np.asarray(s**2 * (3 - 2 * s) / (1 - s) ** 2)


def fit_direction(
    strain_along: Array, strain_across: Array, stress: Array, weight: Array, poisson_coupling: float
) -> DirectionFit:
    """Fit C, alpha and beta to points of one direction.

    Parameters
    ----------
    strain_along, strain_across : (n,) strains.
    stress : (n,) N/mm.
    weight : (n,) weights of the squared residuals.
    poisson_coupling : ratio of the coupling stiffness to C0 along the pull.
    """
    largest = float(strain_along.max())
    root = np.sqrt(weight / weight.sum())
    linear = (strain_along + poisson_coupling * strain_across) * root
    target = stress * root
    floor = LINEAR_FLOOR * float(stress.max()) / largest

    def solve(alpha: float) -> tuple[float, float, float]:
        stiff = stiffening_stress(alpha * strain_along) * root
        stiff = stiff / stiffening_stress(np.asarray(alpha * 0.85 * largest))
        c, s = _two_non_negative(linear, stiff, target - floor * linear)
        residual = target - (c + floor) * linear - s * stiff
        return _dot(residual, residual), c + floor, s

    shares = ALPHA_SHARES
    costs = [solve(share / largest)[0] for share in shares]
    best = int(np.argmin(costs))
    bounds = (
        shares[max(best - 1, 0)] if best > 0 else 1e-3,
        shares[best + 1] if best + 1 < len(shares) else ALPHA_SHARE_LIMIT,
    )
    minimum = scipy.optimize.minimize_scalar(
        lambda share: solve(share / largest)[0],
        bounds=bounds,
        method="bounded",
        options={"xatol": 1e-7},
    )
    alpha = float(minimum.x if minimum.fun <= costs[best] else shares[best]) / largest
    cost, stiffness, scale = solve(alpha)
    beta = scale / float(stiffening_stress(np.asarray(alpha * 0.85 * largest)))
    return DirectionFit(stiffness, alpha, scale, beta, float(np.sqrt(cost)), largest)


def _two_non_negative(a: Array, b: Array, target: Array) -> tuple[float, float]:
    """Non-negative least squares of ``x a + y b = target`` for two columns, in closed form."""
    aa, bb, ab = _dot(a, a), _dot(b, b), _dot(a, b)
    at, bt = _dot(a, target), _dot(b, target)
    determinant = aa * bb - ab * ab
    if determinant > 1e-14 * aa * bb:
        x, y = (at * bb - bt * ab) / determinant, (bt * aa - at * ab) / determinant
        if x >= 0 and y >= 0:
            return x, y
    only_a, only_b = max(at / aa, 0.0), max(bt / bb, 0.0)
    gain_a, gain_b = only_a * at, only_b * bt
    return (only_a, 0.0) if gain_a >= gain_b else (0.0, only_b)


def _dot(a: Array, b: Array) -> float:
    """Scalar product without BLAS, whose threads cost more than they gain on vectors this short."""
    return float(np.einsum("i,i->", a, b))
