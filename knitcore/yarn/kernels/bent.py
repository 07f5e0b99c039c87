"""Contact of yarn with yarn in a cell that is curved or skewed."""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.curve_samples import laid_out
from knitcore.yarn.kernels.potential import potential_and_derivatives
from knitcore.yarn.kernels.structures import ContactLaw, Layout, Pairs


@compiled
def bent_contact(
    curve: Array,
    course_mm: float,
    wale_mm: float,
    pairs: Pairs,
    layout: Layout,
    law: ContactLaw,
    speeds: Array,
    curvature_per_mm: tuple[float, float, float],
    skew: float,
) -> tuple[float, Array, Array]:
    """Contact energy of the curved or skewed cell, N·mm, and its derivatives.

    Neighbours of the cell are rotated images. With δ the unrolled distance in the plane of two
    samples and m = κ δ the turn of the fabric between them, they are

        R² = |δ|² + Δz² − (1 − S²) (δ·m)² / |m|² + S² (2 z̄ δ·m + z_i z_j |m|²)

    apart, S = 2 sin(|m| / 2) / |m| and z̄ their mean height: seen from the middle between them, each
    is carried along by a rotation at a constant rate. A skewed cell moves the next course by
    ``skew`` times the height of a stitch.

    Parameters
    ----------
    curve, course_mm, wale_mm, pairs, layout, law : as for
        :func:`~knitcore.yarn.kernels.contact.contact_slopes`, which also says what the
        derivatives are; no pair is mirrored.
    speeds : (n,) length of d1 in the curved cell.
    curvature_per_mm : along the courses, along the wales, and the twist between them.
    """
    reach = 4.0 * law.radius * law.radius
    n = curve.shape[0]
    wales, rows, w = layout.wales, layout.rows, law.weight
    force, weight_slope = np.zeros((n + 1, 3)), np.zeros(n)
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    total = 0.0
    for q in range(pairs.shape[0]):
        i, j = pairs[q, 0], pairs[q, 1]
        across = at[j, 3] - at[i, 3] + wales * pairs[q, 2]
        up = at[j, 4] - at[i, 4] + rows * pairs[q, 3]
        dx = at[j, 0] - at[i, 0] + wales * pairs[q, 2] * course_mm + skew * up * wale_mm
        dy = at[j, 1] - at[i, 1] + rows * pairs[q, 3] * wale_mm
        square, by_x, by_y, by_i, by_j = squared_distance(
            dx, dy, at[i, 2], at[j, 2], curvature_per_mm
        )
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
        slope = 0.5 * w * v1 * si * sj / distance
        fx, fy = slope * by_x, slope * by_y
        force[i, 0] -= fx
        force[i, 1] -= fy
        force[i, 2] += slope * by_i
        force[j, 0] += fx
        force[j, 1] += fy
        force[j, 2] += slope * by_j
        force[n, 0] += fx * across
        force[n, 1] += (fy + skew * fx) * up
    return total, force, weight_slope


@compiled
def squared_distance(
    dx: float, dy: float, zi: float, zj: float, curvature_per_mm: tuple[float, float, float]
) -> tuple[float, float, float, float, float]:
    """R² of :func:`bent_contact`, mm², and its derivatives by dx, dy, zi, zj."""
    kx, ky, kxy = curvature_per_mm
    mx, my = kx * dx + kxy * dy, kxy * dx + ky * dy
    turn, bend = mx * mx + my * my, dx * mx + dy * my
    chord, short, chord_slope, short_slope = _chord(turn)
    lift, dz = (zi + zj) * bend + zi * zj * turn, zj - zi
    by_bend = chord * (zi + zj) - 2.0 * short * bend
    by_turn = chord * zi * zj + chord_slope * lift - short_slope * bend * bend
    return (
        dx * dx + dy * dy + dz * dz - short * bend * bend + chord * lift,
        2.0 * (dx + by_bend * mx + by_turn * (kx * mx + kxy * my)),
        2.0 * (dy + by_bend * my + by_turn * (kxy * mx + ky * my)),
        chord * (bend + zj * turn) - 2.0 * dz,
        chord * (bend + zi * turn) + 2.0 * dz,
    )


@compiled
def _chord(turn: float) -> tuple[float, float, float, float]:
    """S² and (1 − S²) / |m|² of ``turn`` = |m|², and their derivatives by it."""
    if turn < 0.01:  # the closed forms cancel
        return (
            1.0 - turn / 12.0 + turn**2 / 360.0 - turn**3 / 20160.0,
            1.0 / 12.0 - turn / 360.0 + turn**2 / 20160.0,
            -1.0 / 12.0 + turn / 180.0 - turn**2 / 6720.0,
            -1.0 / 360.0 + turn / 10080.0,
        )
    angle = np.sqrt(turn)
    chord = 2.0 * (1.0 - np.cos(angle)) / turn
    short = (1.0 - chord) / turn
    chord_slope = (np.sin(angle) / angle - chord) / turn
    return chord, short, chord_slope, -(chord_slope + short) / turn
