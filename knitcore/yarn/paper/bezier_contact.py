"""Contact of the yarn with itself and with its images in the neighbouring stitches.

A midpoint rule with ten points a curve (as the authors ran it) turns the double integral into a sum
over pairs. Image (m, n) is shifted by m cells along the course and n along the wale, and mirrored
in z when ``m course_odd + n wale_odd`` is odd. Within a course (n = 0) a pair counts only if the
yarn between its points is longer than 2.1 r.
"""

from functools import cache

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.chart.fabric import Fabric
from knitcore.yarn.kernels.potential import potential_and_derivatives
from knitcore.yarn.kernels.structures import ContactLaw
from knitcore.yarn.paper.elastic import bernstein

POINTS_A_CURVE = 10
EXCLUSION = 2.1
"""Arclength, in radii, within which a yarn has no contact with itself."""
WALE_IMAGES = 3


def course_images(fabric: Fabric) -> int:
    """Number of neighbours along the course considered each way (authors' code)."""
    return 2 if fabric is Fabric.RIB else 1


@cache
def midpoint_tables() -> tuple[Array, Array]:
    """Bernstein weights (10, 6) of position and of its derivative at the contact points."""
    t = (np.arange(POINTS_A_CURVE) + 0.5) / POINTS_A_CURVE
    return bernstein(t), bernstein(t, 1)


@compiled
def contact_points(
    controls: Array, places: Array, slopes: Array
) -> tuple[Array, Array, Array, Array]:
    """Contact points (N, 3), unit tangents (N, 3), lengths and arclengths (N,)."""
    per = places.shape[0]
    count = controls.shape[0] * per
    points, tangents = np.zeros((count, 3)), np.zeros((count, 3))
    lengths, arclengths = np.empty(count), np.empty(count)
    run = 0.0
    for i in range(count):
        curve, q = i // per, i % per
        norm = 0.0
        for d in range(3):
            for k in range(6):
                points[i, d] += places[q, k] * controls[curve, k, d]
                tangents[i, d] += slopes[q, k] * controls[curve, k, d]
            norm += tangents[i, d] ** 2
        norm = np.sqrt(norm)
        for d in range(3):
            tangents[i, d] /= norm
        lengths[i] = norm / per
        arclengths[i] = run + 0.5 * lengths[i]
        run += lengths[i]
    return points, tangents, lengths, arclengths


@compiled
def _boxes(points: Array, curves: int) -> Array:
    """Extent of each curve's points in the plane, mm: shape (curves, low or high, x or y)."""
    out = np.empty((curves, 2, 2))
    per = points.shape[0] // curves
    for c in range(curves):
        for d in range(2):
            low = high = points[c * per, d]
            for i in range(c * per + 1, (c + 1) * per):
                low, high = min(low, points[i, d]), max(high, points[i, d])
            out[c, 0, d], out[c, 1, d] = low, high
    return out


@compiled
def _apart(box: Array, other: Array, x: float, y: float, reach: float) -> bool:
    """Tell whether a box and another one, shifted by (x, y), are farther apart than the reach."""
    return bool(
        other[0, 0] + x - box[1, 0] > reach
        or box[0, 0] - other[1, 0] - x > reach
        or other[0, 1] + y - box[1, 1] > reach
        or box[0, 1] - other[1, 1] - y > reach
    )


@compiled
def curve_contact_energy(
    controls: Array,
    cell: tuple[float, float],
    odd: tuple[bool, bool],
    images: int,
    law: ContactLaw,
    places: Array,
    slopes: Array,
    gradient: Array,
    cell_gradient: Array,
) -> tuple[float, float]:
    """Contact energy, N·mm, and the smallest distance (mm) of two points that interact.

    Adds the derivatives to ``gradient`` (curves, 6, 3) and ``cell_gradient`` (2,), the latter at
    fixed control points.

    Parameters
    ----------
    controls : (curves, 6, 3), mm.
    cell : size of the stitch, course-wise and wale-wise, mm.
    odd : whether the next cell that way is mirrored in z.
    images : neighbours along the course that count, each way.
    law : of the contact; its weight is the factor of an unordered pair.
    places, slopes : (points, 6) weights of position and derivative.
    """
    points, tangents, lengths, arclengths = contact_points(controls, places, slopes)
    per = places.shape[0]
    count = points.shape[0]
    total_length = lengths.sum()
    forces, weights_bar = np.zeros((count, 3)), np.zeros(count)
    reach, limit = 2.0 * law.radius, EXCLUSION * law.radius
    reach2 = reach * reach
    energy, closest = 0.0, 1e300
    curves = controls.shape[0]
    boxes = _boxes(points, curves)
    # Images (m, n) and (-m, -n) hold the same pairs, so half of them are enough.
    for n in range(WALE_IMAGES + 1):
        for m in range(-images if n > 0 else 0, images + 1):
            mirror = -1.0 if (m * odd[0] + n * odd[1]) % 2 == 1 else 1.0
            own = n == 0 and m == 0
            shift_x, shift_y = m * cell[0], n * cell[1]
            for c in range(curves):
                for e in range(c if own else 0, curves):
                    if _apart(boxes[c], boxes[e], shift_x, shift_y, reach):
                        continue
                    for i in range(c * per, (c + 1) * per):
                        for j in range(i + 1 if own and c == e else e * per, (e + 1) * per):
                            dx = points[j, 0] + shift_x - points[i, 0]
                            dy = points[j, 1] + shift_y - points[i, 1]
                            dz = mirror * points[j, 2] - points[i, 2]
                            square = dx * dx + dy * dy + dz * dz
                            if square >= reach2:
                                continue
                            along = arclengths[i] - arclengths[j] - m * total_length
                            if n == 0 and abs(along) <= limit:
                                continue
                            distance = max(np.sqrt(square), 1e-12)
                            closest = min(closest, distance)
                            value, slope, _ = potential_and_derivatives(
                                distance, law.stiffness, law.exponent, law.radius, law.core
                            )
                            value *= law.weight
                            energy += value * lengths[i] * lengths[j]
                            weights_bar[i] += value * lengths[j]
                            weights_bar[j] += value * lengths[i]
                            pull = law.weight * slope * lengths[i] * lengths[j] / distance
                            forces[i, 0] -= pull * dx
                            forces[i, 1] -= pull * dy
                            forces[i, 2] -= pull * dz
                            forces[j, 0] += pull * dx
                            forces[j, 1] += pull * dy
                            forces[j, 2] += pull * dz * mirror
                            cell_gradient[0] += pull * dx * m
                            cell_gradient[1] += pull * dy * n
    for i in range(count):
        curve, q = i // per, i % per
        stretch = weights_bar[i] / per
        for d in range(3):
            for kk in range(6):
                gradient[curve, kk, d] += (
                    forces[i, d] * places[q, kk] + stretch * tangents[i, d] * slopes[q, kk]
                )
    return energy, closest
