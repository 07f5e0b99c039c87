"""Contact of yarn with yarn in a cell that is bent into a cylinder, or skewed."""

from __future__ import annotations

import numba
import numpy as np

from knitcore.arrays import Array
from knitcore.yarnlevel.kernels.curve import laid_out
from knitcore.yarnlevel.kernels.structures import ContactLaw, Layout, Pairs
from knitcore.yarnlevel.potential import potential_and_derivatives


@numba.njit(cache=True)
def bent_contact(
    curve: Array,
    course_mm: float,
    wale_mm: float,
    pairs: Pairs,
    layout: Layout,
    law: ContactLaw,
    speeds: Array,
    curvature_per_mm: float,
    along: tuple[float, float],
    skew: float,
) -> tuple[float, Array, Array]:
    """Contact energy of the bent or skewed cell, N·mm, and its derivatives.

    Neighbours of the cell are rotated images: with the unrolled distances Δs along the bent
    direction and Δo across it, and g = 1 + κz, two samples are

        R² = Δz² + Δo² + g_i g_j (2 sin(κ Δs / 2) / κ)²

    apart. A skewed cell moves the next course by ``skew`` times the height of a stitch.

    Parameters
    ----------
    curve, course_mm, wale_mm, pairs, layout, law : as for
        :func:`~knitcore.yarnlevel.kernels.contact.contact_slopes`, which also says what the
        derivatives are; no pair is mirrored.
    speeds : (n,) length of d1 on the cylinder.
    along : cosine and sine of the angle from the course to the bent direction.
    """
    reach = 4.0 * law.radius * law.radius
    n = curve.shape[0]
    wales, rows, w = layout.wales, layout.rows, law.weight
    force, weight_slope = np.zeros((n + 1, 3)), np.zeros(n)
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    cos, sin = along
    half = 0.5 * curvature_per_mm
    total = 0.0
    for q in range(pairs.shape[0]):
        i, j = pairs[q, 0], pairs[q, 1]
        across = at[j, 3] - at[i, 3] + wales * pairs[q, 2]
        up = at[j, 4] - at[i, 4] + rows * pairs[q, 3]
        dx = at[j, 0] - at[i, 0] + wales * pairs[q, 2] * course_mm + skew * up * wale_mm
        dy = at[j, 1] - at[i, 1] + rows * pairs[q, 3] * wale_mm
        dz = at[j, 2] - at[i, 2]
        ds = cos * dx + sin * dy
        do = cos * dy - sin * dx
        gi, gj = 1.0 + curvature_per_mm * at[i, 2], 1.0 + curvature_per_mm * at[j, 2]
        chord = ds if half == 0.0 else np.sin(half * ds) / half
        square = dz * dz + do * do + gi * gj * chord * chord
        if square >= reach:
            continue
        distance = np.sqrt(square)
        si, sj = speeds[i], speeds[j]
        v0, v1, _ = potential_and_derivatives(
            distance, law.stiffness, law.exponent, law.radius, law.core
        )
        total += w * v0 * si * sj
        weight_slope[i] += w * v0 * sj
        weight_slope[j] += w * v0 * si
        slope = w * v1 * si * sj / distance
        by_s = slope * gi * gj * chord * np.cos(half * ds)
        by_o = slope * do
        fx = cos * by_s - sin * by_o
        fy = sin * by_s + cos * by_o
        lift = 0.5 * slope * curvature_per_mm * chord * chord
        force[i, 0] -= fx
        force[i, 1] -= fy
        force[i, 2] += lift * gj - slope * dz
        force[j, 0] += fx
        force[j, 1] += fy
        force[j, 2] += lift * gi + slope * dz
        force[n, 0] += fx * across
        force[n, 1] += (fy + skew * fx) * up
    return total, force, weight_slope
