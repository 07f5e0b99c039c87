"""Elastica energy of one connecting segment of yarn (the paper's Note 8), even and odd.

A segment of length L joins two entangled regions a distance lambda apart and meets the line
between them with the slope v at its ends. In the small-deflection elastica its energy is

    E = (2 B / lambda) (v² f(Q) - 2 Q (L / lambda - 1)),

where Q = q² is the tension, made dimensionless, that holds the length: dE/dQ = 0, a
transcendental equation. f is q coth q for even segments (one arch) and
q² sinh q / (q cosh q - sinh q) for odd ones (two arches). Both solve one equation,

    2 Q f' = n f + Q - f²,      f(0) = n,      n = 1 (even), 3 (odd),

so f, f' and f'' come from one code, also for Q < 0 (a segment under compression).
"""

import math
from enum import StrEnum

import scipy

from knitcore.base.errors import InputError


class Parity(StrEnum):
    """Symmetry of a connecting segment: even between like stitches, odd between unlike ones."""

    EVEN = "even"
    ODD = "odd"

    @property
    def order(self) -> int:
        """n of the energy function: 1 for even, 3 for odd."""
        return 1 if self is Parity.EVEN else 3


class EnergyForm(StrEnum):
    """Form of the energy: with q from the transcendental equation, or expanded to q⁴."""

    EXACT = "exact"
    QUARTIC = "quartic"


_SERIES_END = 0.5
_SERIES_TERMS = 16
_FIRST_POLE = {Parity.EVEN: math.pi**2, Parity.ODD: 4.493409457909064**2}
"""-Q at which a compressed segment buckles into the next mode: q = i pi, and tan k = k."""


def energy_function(parity: Parity, tension: float) -> tuple[float, float, float]:
    """f, f' and f'' at the dimensionless tension Q.

    Raises
    ------
    InputError
        If Q is at or beyond the next buckling mode.

    Examples
    --------
    >>> [round(x, 6) for x in energy_function(Parity.ODD, 0.0)]  # 3 + Q/5 - Q²/175
    [3.0, 0.2, -0.011429]
    """
    if not math.isfinite(tension) or tension <= -_FIRST_POLE[parity]:
        raise InputError(
            "tension",
            f"{tension} is beyond the buckling of an {parity} segment.",
            f"Use more than {-_FIRST_POLE[parity]:.4f}.",
        )
    n = parity.order
    if abs(tension) < _SERIES_END:
        return _series(n, tension)
    q = math.sqrt(abs(tension))
    even = q / math.tanh(q) if tension > 0 else q / math.tan(q)
    f = even if parity is Parity.EVEN else tension / (even - 1)
    slope = (n * f + tension - f * f) / (2 * tension)
    curvature = (1 + (n - 2) * slope - 2 * f * slope) / (2 * tension)
    return f, slope, curvature


def _series(n: int, tension: float) -> tuple[float, float, float]:
    """Power series from the differential equation: (2k + n) c_k = [k=1] - sum c_i c_(k-i)."""
    c = [float(n)]
    for k in range(1, _SERIES_TERMS):
        inner = sum(c[i] * c[k - i] for i in range(1, k))
        c.append(((1.0 if k == 1 else 0.0) - inner) / (2 * k + n))
    f = sum(a * tension**k for k, a in enumerate(c))
    slope = sum(k * a * tension ** (k - 1) for k, a in enumerate(c) if k >= 1)
    curvature = sum(k * (k - 1) * a * tension ** (k - 2) for k, a in enumerate(c) if k >= 2)
    return f, slope, curvature


def tension_parameter(
    parity: Parity, slope: float, excess: float, form: EnergyForm = EnergyForm.EXACT
) -> float:
    """Q = q² that holds a segment at its length.

    Parameters
    ----------
    slope : v, end slope against the line between the ends, not 0.
    excess : L / lambda - 1, above 0.

    Raises
    ------
    InputError
        If the segment is straight or shorter than the distance of its ends.
    """
    if not (math.isfinite(slope) and slope != 0):
        raise InputError(
            "slope", f"{slope} leaves the segment straight.", "Give a slope other than 0."
        )
    if not (math.isfinite(excess) and excess > 0):
        raise InputError(
            "length_mm",
            "is not above the distance of the ends.",
            "Give a length above the distance of the ends.",
        )
    target = 2 * excess / slope**2
    if form is EnergyForm.QUARTIC:
        _, first, second = _series(parity.order, 0.0)
        return (target - first) / second

    def mismatch(tension: float) -> float:
        return energy_function(parity, tension)[1] - target

    pole = _FIRST_POLE[parity]
    low = -pole * 0.5
    while mismatch(low) < 0:
        low = -pole + (low + pole) / 10
    high = 1.0
    while mismatch(high) > 0:
        high *= 4
    return float(scipy.optimize.brentq(mismatch, low, high, xtol=1e-14, rtol=1e-14))


def segment_energy(
    parity: Parity,
    slope: float,
    separation_mm: float,
    length_mm: float,
    bending_modulus_n_mm2: float,
    form: EnergyForm = EnergyForm.EXACT,
) -> float:
    """Bending energy of a segment, N·mm."""
    excess = length_mm / separation_mm - 1
    tension = tension_parameter(parity, slope, excess, form)
    if form is EnergyForm.QUARTIC:
        f, first, second = _series(parity.order, 0.0)
        f = f + first * tension + second * tension**2 / 2
    else:
        f, _, _ = energy_function(parity, tension)
    return 2 * bending_modulus_n_mm2 / separation_mm * (slope**2 * f - 2 * tension * excess)


def segment_force(
    parity: Parity,
    slope: float,
    separation_mm: float,
    length_mm: float,
    bending_modulus_n_mm2: float,
) -> float:
    """Force on the ends along the line between them, dE / d lambda in N (negative: they repel)."""
    excess = length_mm / separation_mm - 1
    tension = tension_parameter(parity, slope, excess)
    energy = segment_energy(parity, slope, separation_mm, length_mm, bending_modulus_n_mm2)
    # dE/dQ = 0, so only the explicit dependence on lambda counts.
    pull = 4 * bending_modulus_n_mm2 * tension * length_mm / separation_mm**3
    return pull - energy / separation_mm


def segment_stiffness(
    parity: Parity,
    slope: float,
    separation_mm: float,
    length_mm: float,
    bending_modulus_n_mm2: float,
) -> float:
    """d²E / d lambda² in N/mm, without expanding anything."""
    lam, length, bending = separation_mm, length_mm, bending_modulus_n_mm2
    excess = length / lam - 1
    tension = tension_parameter(parity, slope, excess)
    _, _, curvature = energy_function(parity, tension)
    energy = segment_energy(parity, slope, lam, length, bending)
    force = segment_force(parity, slope, lam, length, bending)
    tension_rate = -2 * length / (lam**2 * slope**2 * curvature)
    pull_rate = 4 * bending * length * (tension_rate / lam**3 - 3 * tension / lam**4)
    return pull_rate - force / lam + energy / lam**2


def rest_separation_mm(parity: Parity, slope: float, length_mm: float) -> float:
    """lambda*, the distance of least energy at fixed end slope, without expansion.

    Examples
    --------
    >>> round(rest_separation_mm(Parity.EVEN, 0.1, 1.0), 6)  # 1 - v²/6 = 0.998333
    0.998337
    """
    if not (math.isfinite(slope) and slope != 0):
        raise InputError(
            "slope", f"{slope} leaves the segment straight.", "Give a slope other than 0."
        )

    def force(tension: float) -> float:
        f, rate, _ = energy_function(parity, tension)
        return slope**2 * f - 2 * tension * (1 + slope**2 * rate)

    high = 1.0
    while force(high) > 0:
        high *= 4
    tension = float(scipy.optimize.brentq(force, 0.0, high, xtol=1e-15, rtol=1e-14))
    _, rate, _ = energy_function(parity, tension)
    return length_mm / (1 + slope**2 * rate / 2)


def high_tension_energy(
    slope: float, separation_mm: float, length_mm: float, bending_modulus_n_mm2: float
) -> float:
    """Energy of a nearly taut segment, (B / 4 L) v⁴ / (1 - lambda / L), alike for both parities.

    Its slope diverges as (1 - lambda / L)^-2: the stiffening term of the constitutive law.
    """
    if not 0 < separation_mm < length_mm:
        raise InputError(
            "separation_mm",
            "must lie between 0 and the length.",
            "Give a length above the distance of the ends.",
        )
    gap = 1 - separation_mm / length_mm
    return bending_modulus_n_mm2 * slope**4 / (4 * length_mm * gap)
