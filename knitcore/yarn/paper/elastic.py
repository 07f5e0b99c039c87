"""Bending and regularisation of Bezier curves, and their lengths, with exact gradients.

Per length, with the curvature vector c = ∂_s t, the density is ``bending |c|² + regularisation
|∂_s c|²``; ``|∂_s c|²`` keeps its tangential part, |c|⁴.
"""

from functools import cache
from math import comb

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled

ORDER = 5
QUADRATURE_POINTS = 24
"""Gauss points a curve: enough for 1e-6 of the energy of the paper's stitches."""


def bernstein(t: Array, derivative: int = 0) -> Array:
    """Weights of the six control points for a derivative of the curve, shape (len(t), 6)."""
    lower = ORDER - derivative
    basis = np.array([comb(lower, i) * t**i * (1.0 - t) ** (lower - i) for i in range(lower + 1)]).T
    for degree in range(lower + 1, ORDER + 1):
        wider = np.zeros((len(t), degree + 1))
        wider[:, 1:] += degree * basis
        wider[:, :-1] -= degree * basis
        basis = wider
    return np.ascontiguousarray(basis)


@cache
def gauss_tables() -> tuple[Array, Array]:
    """Gauss weights on [0, 1], and Bernstein weights (3 derivatives, points, 6)."""
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE_POINTS)
    t = (nodes + 1.0) / 2.0
    return weights / 2.0, np.stack([bernstein(t, derivative) for derivative in (1, 2, 3)])


@compiled
def elastic_energy(  # noqa: PLR0915 - one derivation, forward and back
    controls: Array,
    bending: float,
    regularisation: float,
    weights: Array,
    tables: Array,
    gradient: Array,
    lengths: Array,
    length_gradient: Array,
) -> float:
    """Energy, N·mm, of curves with control points ``controls`` (curves, 6, 3), mm.

    Adds the derivative to ``gradient`` (curves, 6, 3); fills ``lengths`` (curves,), mm, and
    ``length_gradient`` (curves, 6, 3: of each curve's length by its own control points).
    """
    total = 0.0
    lengths[:] = 0.0
    length_gradient[:] = 0.0
    v, a, j = np.empty(3), np.empty(3), np.empty(3)
    vbar, abar, jbar = np.empty(3), np.empty(3), np.empty(3)
    t, c, w = np.empty(3), np.empty(3), np.empty(3)
    cbar, wbar, tbar, jperp = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for curve in range(controls.shape[0]):
        for q in range(weights.size):
            for d in range(3):
                v[d], a[d], j[d] = 0.0, 0.0, 0.0
                for k in range(6):
                    x = controls[curve, k, d]
                    v[d] += tables[0, q, k] * x
                    a[d] += tables[1, q, k] * x
                    j[d] += tables[2, q, k] * x
            s = np.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
            at = (a[0] * v[0] + a[1] * v[1] + a[2] * v[2]) / s
            jt = (j[0] * v[0] + j[1] * v[1] + j[2] * v[2]) / s
            tau = at / s**2
            c2, w2 = 0.0, 0.0
            for d in range(3):
                t[d] = v[d] / s
                c[d] = (a[d] - at * t[d]) / s**2
                jperp[d] = j[d] - jt * t[d]
                w[d] = jperp[d] / s**3 - 3.0 * tau * c[d]
                c2 += c[d] * c[d]
                w2 += w[d] * w[d]
            density = bending * c2 + regularisation * (w2 + c2 * c2)
            weight = weights[q]
            total += weight * s * density
            lengths[curve] += weight * s

            # Reverse sweep through the same steps.
            sbar = density
            by_c2 = s * (bending + 2.0 * regularisation * c2)
            c_w, j_w = 0.0, 0.0
            for d in range(3):
                wbar[d] = 2.0 * s * regularisation * w[d]
                c_w += c[d] * wbar[d]
                j_w += jperp[d] * wbar[d]
            taubar = -3.0 * c_w
            sbar -= 3.0 * j_w / s**4 + 3.0 * taubar * tau / s
            jbar_t, cbar_t, c_c = 0.0, 0.0, 0.0
            for d in range(3):
                cbar[d] = 2.0 * by_c2 * c[d] - 3.0 * tau * wbar[d]
                jbar_t += wbar[d] * t[d] / s**3
                cbar_t += cbar[d] * t[d] / s**2
                c_c += c[d] * cbar[d]
            sbar -= 2.0 * c_c / s
            t_t = 0.0
            for d in range(3):
                jperp_bar, aperp_bar = wbar[d] / s**3, cbar[d] / s**2
                jbar[d] = jperp_bar - jbar_t * t[d]
                abar[d] = aperp_bar - cbar_t * t[d] + taubar * v[d] / s**3
                tbar[d] = -jbar_t * j[d] - jt * jperp_bar - cbar_t * a[d] - at * aperp_bar
                t_t += t[d] * tbar[d]
            sbar -= t_t / s
            for d in range(3):
                vbar[d] = tbar[d] / s + sbar * t[d] + taubar * a[d] / s**3
                for k in range(6):
                    gradient[curve, k, d] += weight * (
                        tables[0, q, k] * vbar[d]
                        + tables[1, q, k] * abar[d]
                        + tables[2, q, k] * jbar[d]
                    )
                    length_gradient[curve, k, d] += weight * tables[0, q, k] * t[d]
    return total
