"""The core-shell potential between two points of yarn, compiled.

With the shell ``d = 2r - 2r_core`` and ``ζ = (R - 2r_core) / d`` (paper, Supplementary Note 2),

    V(R) = k d² / (p (p - 1)) * [ζ^(1-p) - 1 - (p - 1)(1 - ζ)]      for ζ < 1, else 0,

in N/mm² (energy per length of either yarn) when k is in N/mm³. Below ζ = 1e-5 the authors' code
continues it by ``V(R*) + 100 ((R - R*) / R*)²``: finite, but with a jump in slope at R*.
"""

from knitcore.base.compiled import compiled
from knitcore.base.elementary import power

CAP = 1e-5
"""ζ below which the capped form holds."""


@compiled
def potential(distance: float, k: float, p: float, radius: float, core: float) -> float:
    """V(R), N/mm², for a distance R of two centre lines (all lengths mm, k N/mm³)."""
    shell = 2.0 * (radius - core)
    zeta = (distance - 2.0 * core) / shell
    if zeta >= 1.0:
        return 0.0
    capped = max(zeta, CAP)
    scale = k * shell * shell / (p * (p - 1.0))
    value = scale * (power(capped, 1.0 - p) - 1.0 - (p - 1.0) * (1.0 - capped))
    if zeta < CAP:
        star = 2.0 * core + CAP * shell
        value += 100.0 * ((distance - star) / star) ** 2
    return float(value)


@compiled
def potential_and_derivatives(
    distance: float, k: float, p: float, radius: float, core: float
) -> tuple[float, float, float]:
    """V(R), V'(R) in N/mm³ and V''(R) in N/mm⁴, at the cost of one; -V' is the repulsion."""
    shell = 2.0 * (radius - core)
    zeta = (distance - 2.0 * core) / shell
    if zeta >= 1.0:
        return 0.0, 0.0, 0.0
    if zeta < CAP:
        star = 2.0 * core + CAP * shell
        slope = 200.0 * (distance - star) / (star * star)
        return potential(distance, k, p, radius, core), slope, 200.0 / (star * star)
    steep = power(zeta, -p)
    value = k * shell * shell / (p * (p - 1.0)) * (steep * zeta - 1.0 - (p - 1.0) * (1.0 - zeta))
    return value, -k * shell / p * (steep - 1.0), k * steep / zeta
