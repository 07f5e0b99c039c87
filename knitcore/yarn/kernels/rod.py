"""Bending, regularisation, spacing penalty and tension: terms of single samples of the curve.

Everything depends on a = |d1|², b = d1·d2, c = |d2|², d = d1·d3, e = d2·d3, f = |d3|², d_n the n-th
derivative with respect to the parameter t. Bending and regularisation are sums of monomials in
them, whatever the parametrisation:

    ∫κ² ds         = ∫ (c a^-3/2 − b² a^-5/2) dt
    ∫|∂_ss t|² ds  = ∫ (f a^-5/2 + (c² − d² − 6be) a^-7/2 + b²(7c + 6d) a^-9/2 − 8b⁴ a^-11/2) dt

The length, the spacing penalty and the weights w = |d1| dt of the contact sum are functions of √a.
"""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.structures import RodLaw


@compiled
def _parts(d: Array) -> tuple[float, ...]:
    """b … f of a sample, powers of a, and the factors of the last three of them."""
    a = d[1, 0] ** 2 + d[1, 1] ** 2 + d[1, 2] ** 2
    b = d[1, 0] * d[2, 0] + d[1, 1] * d[2, 1] + d[1, 2] * d[2, 2]
    c = d[2, 0] ** 2 + d[2, 1] ** 2 + d[2, 2] ** 2
    e1 = d[1, 0] * d[3, 0] + d[1, 1] * d[3, 1] + d[1, 2] * d[3, 2]
    e = d[2, 0] * d[3, 0] + d[2, 1] * d[3, 1] + d[2, 2] * d[3, 2]
    f = d[3, 0] ** 2 + d[3, 1] ** 2 + d[3, 2] ** 2
    i1 = 1.0 / a
    h3 = i1 / np.sqrt(a)  # a^-3/2
    h5 = h3 * i1
    h7 = h5 * i1
    h9 = h7 * i1
    h11 = h9 * i1
    m7 = c * c - e1 * e1 - 6.0 * b * e
    m9 = b * b * (7.0 * c + 6.0 * e1)
    m11 = -8.0 * b**4
    return b, c, e1, e, f, i1, h3, h5, h7, h9, h11, m7, m9, m11


@compiled
def sample_energy(d: Array, bend: float, regular: float) -> float:
    """Bending and regularisation of one sample."""
    b, c, _, _, f, _, h3, h5, h7, h9, h11, m7, m9, m11 = _parts(d)
    return float(bend * (c * h3 - b * b * h5) + regular * (f * h5 + m7 * h7 + m9 * h9 + m11 * h11))


@compiled
def sample_slope(d: Array, bend: float, regular: float, slope: Array) -> None:
    """Write the derivatives (6) of :func:`sample_energy` by a … f."""
    b, c, e1, e, f, i1, h3, h5, h7, h9, h11, m7, m9, m11 = _parts(d)
    slope[0] = bend * (-1.5 * c * h5 + 2.5 * b * b * h7) - regular * i1 * (
        2.5 * f * h5 + 3.5 * m7 * h7 + 4.5 * m9 * h9 + 5.5 * m11 * h11
    )
    slope[1] = bend * (-2.0 * b * h5) + regular * (
        -6.0 * e * h7 + 2.0 * b * (7.0 * c + 6.0 * e1) * h9 - 32.0 * b**3 * h11
    )
    slope[2] = bend * h3 + regular * (2.0 * c * h7 + 7.0 * b * b * h9)
    slope[3] = regular * (-2.0 * e1 * h7 + 6.0 * b * b * h9)
    slope[4] = regular * (-6.0 * b * h7)
    slope[5] = regular * h5


@compiled
def sample_curvature(d: Array, bend: float, regular: float, curvature: Array) -> None:
    """Write the second derivatives (6, 6) of :func:`sample_energy` by a … f that are not zero."""
    b, c, e1, e, f, i1, _, h5, h7, h9, h11, m7, m9, m11 = _parts(d)
    curvature[0, 0] = bend * (3.75 * c * h7 - 8.75 * b * b * h9) + regular * i1 * i1 * (
        8.75 * f * h5 + 15.75 * m7 * h7 + 24.75 * m9 * h9 + 35.75 * m11 * h11
    )
    curvature[0, 1] = bend * 5.0 * b * h7 - regular * i1 * (
        -21.0 * e * h7 + 9.0 * b * (7.0 * c + 6.0 * e1) * h9 - 176.0 * b**3 * h11
    )
    curvature[0, 2] = -1.5 * bend * h5 - regular * i1 * (7.0 * c * h7 + 31.5 * b * b * h9)
    curvature[0, 3] = -regular * i1 * (-7.0 * e1 * h7 + 27.0 * b * b * h9)
    curvature[0, 4] = regular * 21.0 * b * h9
    curvature[0, 5] = -2.5 * regular * h7
    curvature[1, 1] = -2.0 * bend * h5 + regular * (
        2.0 * (7.0 * c + 6.0 * e1) * h9 - 96.0 * b * b * h11
    )
    curvature[1, 2] = regular * 14.0 * b * h9
    curvature[1, 3] = regular * 12.0 * b * h9
    curvature[1, 4] = -6.0 * regular * h7
    curvature[2, 2] = 2.0 * regular * h7
    curvature[3, 3] = -2.0 * regular * h7
    for m in range(6):
        for n in range(m):
            curvature[m, n] = curvature[n, m]


@compiled
def _length(d: Array) -> float:
    return float(np.sqrt(d[1, 0] ** 2 + d[1, 1] ** 2 + d[1, 2] ** 2))


@compiled
def rod_energy(curve: Array, law: RodLaw, lengths: Array) -> tuple[float, float]:
    """Bending with regularisation, and spacing penalty, N·mm.

    ``lengths``: what |d1| should be at each sample, mm.
    """
    bend, regular = law.step * law.bend, law.step * law.regular
    rod = spacing = 0.0
    for i in range(curve.shape[0]):
        rod += sample_energy(curve[i], bend, regular)
        stretch = _length(curve[i]) / lengths[i] - 1.0
        spacing += 0.5 * law.step * law.spacing * stretch * stretch
    return rod, spacing


@compiled
def _pull(d: Array, law: RodLaw, length: float, tension: float, by_speed: float) -> float:
    """Derivative by |d1| of spacing penalty, tension and contact."""
    stretch = _length(d) / length - 1.0
    return law.step * (tension + law.spacing * stretch / length) + by_speed


@compiled
def _by_derivatives(d: Array, slope: Array, out: Array) -> None:
    """Slopes by d1, d2, d3 from those by the products a … f."""
    for m in range(3):
        out[0, m] = 2.0 * slope[0] * d[1, m] + slope[1] * d[2, m] + slope[3] * d[3, m]
        out[1, m] = slope[1] * d[1, m] + 2.0 * slope[2] * d[2, m] + slope[4] * d[3, m]
        out[2, m] = slope[3] * d[1, m] + slope[4] * d[2, m] + 2.0 * slope[5] * d[3, m]


@compiled
def rod_slopes(curve: Array, law: RodLaw, lengths: Array, tension: Array, by_speed: Array) -> Array:
    """Derivatives by d1, d2, d3 at each sample, (n, 3, 3).

    ``tension`` at each sample and ``by_speed``, the slope of the contact by |d1|, are included.
    """
    slope = np.empty(6)
    bend, regular = law.step * law.bend, law.step * law.regular
    gradient = np.empty((curve.shape[0], 3, 3))
    for i in range(curve.shape[0]):
        d = curve[i]
        sample_slope(d, bend, regular, slope)
        slope[0] += 0.5 * _pull(d, law, lengths[i], tension[i], by_speed[i]) / _length(d)
        _by_derivatives(d, slope, gradient[i])
    return gradient


@compiled
def rod_hessian(
    curve: Array, law: RodLaw, lengths: Array, tension: Array, by_speed: Array
) -> tuple[Array, Array]:
    """Return the :func:`rod_slopes`, and the second derivatives by d1, d2, d3, (n, 9, 9)."""
    slope, curvature = np.empty(6), np.zeros((6, 6))
    lift, bent = np.zeros((6, 9)), np.empty((6, 9))
    bend, regular = law.step * law.bend, law.step * law.regular
    gradient = np.empty((curve.shape[0], 3, 3))
    local = np.empty((curve.shape[0], 9, 9))
    for i in range(curve.shape[0]):
        d, speed = curve[i], _length(curve[i])
        sample_slope(d, bend, regular, slope)
        sample_curvature(d, bend, regular, curvature)
        pull = _pull(d, law, lengths[i], tension[i], by_speed[i])
        slope[0] += 0.5 * pull / speed
        _by_derivatives(d, slope, gradient[i])
        curvature[0, 0] += (
            0.25 * (law.step * law.spacing / lengths[i] ** 2 - pull / speed) / speed**2
        )
        for m in range(3):
            lift[0, m] = 2.0 * d[1, m]
            lift[1, m] = d[2, m]
            lift[1, 3 + m] = d[1, m]
            lift[2, 3 + m] = 2.0 * d[2, m]
            lift[3, m] = d[3, m]
            lift[3, 6 + m] = d[1, m]
            lift[4, 3 + m] = d[3, m]
            lift[4, 6 + m] = d[2, m]
            lift[5, 6 + m] = 2.0 * d[3, m]
        # lift.T @ curvature @ lift; as a product of matrices it costs ten times as much
        for m in range(6):
            for n in range(9):
                value = 0.0
                for q in range(6):
                    value += curvature[m, q] * lift[q, n]
                bent[m, n] = value
        for m in range(9):
            for n in range(m + 1):
                value = 0.0
                for q in range(6):
                    value += lift[q, m] * bent[q, n]
                local[i, m, n] = value
                local[i, n, m] = value
        for m in range(3):
            local[i, m, m] += 2.0 * slope[0]
            local[i, 3 + m, 3 + m] += 2.0 * slope[2]
            local[i, 6 + m, 6 + m] += 2.0 * slope[5]
            local[i, m, 3 + m] += slope[1]
            local[i, 3 + m, m] += slope[1]
            local[i, m, 6 + m] += slope[3]
            local[i, 6 + m, m] += slope[3]
            local[i, 3 + m, 6 + m] += slope[4]
            local[i, 6 + m, 3 + m] += slope[4]
    return gradient, local
