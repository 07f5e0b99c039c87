"""Energy of a sheet of stitches in space, with its gradient, compiled.

Unknowns are the corners of the stitches, ``x`` (n, 3) in mm. Four parts, each a list of elements:

- **Quarters** (membrane): a corner c of a stitch with its neighbours a along the row and b along
  the column. With u = (a − c) / l₁, v = (b − c) / l₂, q₁ = u·u, q₂ = v·v and g = u·v the energy per
  area is C₁₁ (q₁ − 1 − ln q₁) / 4 + C₂₂ (q₂ − 1 − ln q₂) / 4 + C₁₂ (q₁ − 1) (q₂ − 1) / 4
  − G ln(1 − g² / (q₁ q₂)) / 2: the linear law for small strains, and no finite force flattens a
  stitch to nothing.
- **Hinges** (bending): the line between two stitches, from p to q. It turns by the angle θ from
  the plane through it and the middle of the far side of one stitch to that of the other; θ > 0 puts
  the face outside. The energy is K (θ − θ₀)² / 2, and beyond the angle θ_c at which the inner
  surface of the fabric is closed WALL K (|θ| − θ_c)² / 2 more. A twisted stitch may lose its width
  b at a hinge, where no angle is defined: K ln²(b² / b₀²) / 2 below b₀, half its size, keeps it.
- **Twists**: T |x₀₀ − x₁₀ − x₀₁ + x₁₁|² / 2 of a stitch.
- **Touches**: two points of the sheet, each the mean of four corners (a corner four times, or the
  corners of a stitch), at a distance d below t (1 + NAP). The force grows with the square of the
  depth, for loose fibres give way first: it is k FIRM t at d = t (1 − FIRM).
"""

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.base.elementary import arctan2, log

Ints = NDArray[np.int64]
RealOrComplex = NDArray[Any]

WALL = 20.0
"""Stiffness of a closed fold in units of that of the hinge."""
NAP = 0.06
"""Reach of the outermost fibres beyond the thickness, in thicknesses."""
FIRM = 0.007
"""Depth below the thickness at which a touch is pressed as by a spring of the stiffness of contact,
in thicknesses: the usual depth in a scroll."""


@compiled
def metric_energy(
    q1: float, q2: float, g: float, parameters: Array, slope: Array, curvature: Array
) -> float:
    """Membrane energy of a quarter with its slope (3,) and curvature (3, 3) in q₁, q₂ and g."""
    _, _, c11, c22, c12, shear = parameters
    area = q1 * q2 - g * g
    if not (q1 > 0.0 and q2 > 0.0 and area > 0.0):
        return np.inf
    slope[0] = 0.25 * (c11 * (1.0 - 1.0 / q1) + c12 * (q2 - 1.0))
    slope[1] = 0.25 * (c22 * (1.0 - 1.0 / q2) + c12 * (q1 - 1.0))
    slope[0] += 0.5 * shear * (1.0 / q1 - q2 / area)
    slope[1] += 0.5 * shear * (1.0 / q2 - q1 / area)
    slope[2] = shear * g / area
    curvature[0, 0] = 0.25 * c11 / q1**2 + 0.5 * shear * ((q2 / area) ** 2 - 1.0 / q1**2)
    curvature[1, 1] = 0.25 * c22 / q2**2 + 0.5 * shear * ((q1 / area) ** 2 - 1.0 / q2**2)
    curvature[2, 2] = shear * (1.0 + 2.0 * g * g / area) / area
    curvature[0, 1] = 0.25 * c12 + 0.5 * shear * (q1 * q2 / area - 1.0) / area
    curvature[0, 2] = -shear * g * q2 / area**2
    curvature[1, 2] = -shear * g * q1 / area**2
    for m in range(3):
        for n in range(m):
            curvature[m, n] = curvature[n, m]
    stretch = c11 * (q1 - 1.0 - log(q1)) + c22 * (q2 - 1.0 - log(q2))
    stretch += c12 * (q1 - 1.0) * (q2 - 1.0)
    return float(0.25 * stretch - 0.5 * shear * log(area / (q1 * q2)))


@compiled
def quarters(x: Array, corners: Ints, parameters: Array, gradient: Array) -> float:
    """Membrane energy; adds to ``gradient`` (n, 3). Infinite where a quarter has no area.

    ``corners`` (m, 3): c, a, b. ``parameters`` (m, 6): l₁, l₂ and C₁₁, C₂₂, C₁₂, G times the area.
    """
    total = 0.0
    slope = np.empty(3)
    curvature = np.empty((3, 3))
    for k in range(corners.shape[0]):
        c, a, b = corners[k]
        l1, l2 = parameters[k, 0], parameters[k, 1]
        ux, uy, uz = (x[a, 0] - x[c, 0]) / l1, (x[a, 1] - x[c, 1]) / l1, (x[a, 2] - x[c, 2]) / l1
        vx, vy, vz = (x[b, 0] - x[c, 0]) / l2, (x[b, 1] - x[c, 1]) / l2, (x[b, 2] - x[c, 2]) / l2
        q1 = ux * ux + uy * uy + uz * uz
        q2 = vx * vx + vy * vy + vz * vz
        g = ux * vx + uy * vy + uz * vz
        total += metric_energy(q1, q2, g, parameters[k], slope, curvature)
        s1, s2, s3 = 2.0 * slope[0], 2.0 * slope[1], slope[2]
        fx, fy, fz = (s1 * ux + s3 * vx) / l1, (s1 * uy + s3 * vy) / l1, (s1 * uz + s3 * vz) / l1
        hx, hy, hz = (s2 * vx + s3 * ux) / l2, (s2 * vy + s3 * uy) / l2, (s2 * vz + s3 * uz) / l2
        gradient[a, 0] += fx
        gradient[a, 1] += fy
        gradient[a, 2] += fz
        gradient[b, 0] += hx
        gradient[b, 1] += hy
        gradient[b, 2] += hz
        gradient[c, 0] -= fx + hx
        gradient[c, 1] -= fy + hy
        gradient[c, 2] -= fz + hz
    return total


@compiled
def _cross(ax: Any, ay: Any, az: Any, bx: Any, by: Any, bz: Any) -> tuple[Any, Any, Any]:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled
def turn_slope(points: RealOrComplex, slope: RealOrComplex) -> tuple[Any, Any, Any, Any]:
    """Sine and cosine of a hinge's angle, up to a common factor, and the squares of the widths of
    its sides; ``slope`` (4, 3) receives the angle's.

    ``points`` (4, 3): p, q, and the two far middles. Written without a conjugate or an absolute
    value, so that a complex step through it gives the second derivatives to the last digit, and
    in scalars, for it takes most of the time. Bridson, Marino, Fedkiw, "Simulation of clothing with
    folds and wrinkles" (2003).
    """
    px, py, pz = points[0, 0], points[0, 1], points[0, 2]
    ex, ey, ez = points[1, 0] - px, points[1, 1] - py, points[1, 2] - pz
    lx, ly, lz = points[2, 0] - px, points[2, 1] - py, points[2, 2] - pz
    rx, ry, rz = points[3, 0] - px, points[3, 1] - py, points[3, 2] - pz
    ax, ay, az = _cross(ex, ey, ez, lx, ly, lz)
    bx, by, bz = _cross(rx, ry, rz, ex, ey, ez)
    cx, cy, cz = _cross(ax, ay, az, bx, by, bz)
    square = ex * ex + ey * ey + ez * ez
    length = np.sqrt(square)
    s1, s2 = ax * ax + ay * ay + az * az, bx * bx + by * by + bz * bz
    back1 = (lx * ex + ly * ey + lz * ez) / (length * s1)
    back2 = (rx * ex + ry * ey + rz * ez) / (length * s2)
    along1, along2 = back1 - length / s1, back2 - length / s2
    far1, far2 = -length / s1, -length / s2
    slope[2, 0], slope[2, 1], slope[2, 2] = far1 * ax, far1 * ay, far1 * az
    slope[3, 0], slope[3, 1], slope[3, 2] = far2 * bx, far2 * by, far2 * bz
    slope[0, 0] = -(along1 * ax + along2 * bx)
    slope[0, 1] = -(along1 * ay + along2 * by)
    slope[0, 2] = -(along1 * az + along2 * bz)
    slope[1, 0] = back1 * ax + back2 * bx
    slope[1, 1] = back1 * ay + back2 * by
    slope[1, 2] = back1 * az + back2 * bz
    sine = (cx * ex + cy * ey + cz * ez) / length
    return sine, ax * bx + ay * by + az * bz, s1 / square, s2 / square


@compiled
def width_slope(points: RealOrComplex, side: int, slope: RealOrComplex) -> Any:
    """Square of the width of a hinge's side (2 or 3), and the slope (4, 3) of its logarithm."""
    px, py, pz = points[0, 0], points[0, 1], points[0, 2]
    ex, ey, ez = points[1, 0] - px, points[1, 1] - py, points[1, 2] - pz
    fx, fy, fz = points[side, 0] - px, points[side, 1] - py, points[side, 2] - pz
    nx, ny, nz = _cross(ex, ey, ez, fx, fy, fz)
    by_far = _cross(nx, ny, nz, ex, ey, ez)
    by_end = _cross(fx, fy, fz, nx, ny, nz)
    e = (ex, ey, ez)
    ee, nn = ex * ex + ey * ey + ez * ez, nx * nx + ny * ny + nz * nz
    slope[:] = 0.0
    for m in range(3):
        slope[side, m] = 2.0 * by_far[m] / nn
        slope[1, m] = 2.0 * by_end[m] / nn - 2.0 * e[m] / ee
        slope[0, m] = -slope[side, m] - slope[1, m]
    return nn / ee


@compiled
def hinge_points(x: Array, nodes: Ints, points: Array) -> None:
    """Write the points (4, 3) of a hinge, as :func:`turn_slope` takes them."""
    p, q, a, b, c, d = nodes
    for m in range(3):
        points[0, m] = x[p, m]
        points[1, m] = x[q, m]
        points[2, m] = 0.5 * (x[a, m] + x[b, m])
        points[3, m] = 0.5 * (x[c, m] + x[d, m])


@compiled
def bent(angle: float, parameters: Array) -> tuple[float, float, float]:
    """Energy of a hinge, its moment and its stiffness."""
    stiffness, rest, closed, _ = parameters
    off = angle - rest
    over = angle - closed if angle > closed else min(angle + closed, 0.0)
    return (
        0.5 * stiffness * (off * off + WALL * over * over),
        stiffness * (off + WALL * over),
        stiffness * (1.0 if over == 0.0 else 1.0 + WALL),
    )


@compiled
def hinges(x: Array, nodes: Ints, parameters: Array, gradient: Array) -> float:
    """Bending energy; adds to ``gradient``.

    ``nodes`` (m, 6): p, q, the two far corners of one stitch, those of the other. ``parameters``
    (m, 4): stiffness K, N·mm, rest angle θ₀, closed angle θ_c, and b₀², mm².
    """
    total = 0.0
    points = np.empty((4, 3))
    slope = np.empty((4, 3))
    width = np.empty((4, 3))
    for k in range(nodes.shape[0]):
        p, q, a, b, c, d = nodes[k]
        hinge_points(x, nodes[k], points)
        sine, cosine, left, right = turn_slope(points, slope)
        energy, moment, _ = bent(arctan2(sine, cosine), parameters[k])
        total += energy
        for i in range(4):
            for m in range(3):
                slope[i, m] *= moment
        for side in range(2, 4):
            if (left if side == 2 else right) < parameters[k, 3]:
                narrow = log(width_slope(points, side, width) / parameters[k, 3])
                total += 0.5 * parameters[k, 0] * narrow * narrow
                for i in range(4):
                    for m in range(3):
                        slope[i, m] += parameters[k, 0] * narrow * width[i, m]
        for m in range(3):
            gradient[p, m] += slope[0, m]
            gradient[q, m] += slope[1, m]
            gradient[a, m] += 0.5 * slope[2, m]
            gradient[b, m] += 0.5 * slope[2, m]
            gradient[c, m] += 0.5 * slope[3, m]
            gradient[d, m] += 0.5 * slope[3, m]
    return total


@compiled
def twists(x: Array, quads: Ints, stiffness: Array, gradient: Array) -> float:
    """Energy of twisting; ``quads`` (m, 4): x₀₀, x₁₀, x₀₁, x₁₁. Adds to ``gradient``."""
    total = 0.0
    for k in range(quads.shape[0]):
        a, b, c, d = quads[k]
        for m in range(3):
            off = x[a, m] - x[b, m] - x[c, m] + x[d, m]
            total += 0.5 * stiffness[k] * off * off
            force = stiffness[k] * off
            gradient[a, m] += force
            gradient[b, m] -= force
            gradient[c, m] -= force
            gradient[d, m] += force
    return total


@compiled
def pressed(depth: float, thickness_mm: float, stiffness: float) -> tuple[float, float, float]:
    """Energy of a touch, its force and its stiffness, at a depth in mm below the outer fibres."""
    factor = stiffness * FIRM / ((NAP + FIRM) ** 2 * thickness_mm)
    return factor * depth**3 / 3.0, factor * depth**2, 2.0 * factor * depth


@compiled
def touches(
    x: Array, points: Ints, pairs: Ints, thickness_mm: float, stiffness: float, gradient: Array
) -> float:
    """Energy of contact; ``points`` (k, 4) corners of a point, ``pairs`` (m, 2) points."""
    total = 0.0
    at = points_on(x, points)
    reach = (1.0 + NAP) * thickness_mm
    for k in range(pairs.shape[0]):
        i, j = pairs[k]
        dx, dy, dz = at[j, 0] - at[i, 0], at[j, 1] - at[i, 1], at[j, 2] - at[i, 2]
        square = dx * dx + dy * dy + dz * dz
        if square >= reach * reach:
            continue
        distance = max(np.sqrt(square), 1e-9)
        energy, force, _ = pressed(reach - distance, thickness_mm, stiffness)
        total += energy
        push = 0.25 * force / distance
        for m in range(4):
            a, b = points[i, m], points[j, m]
            gradient[a, 0] += push * dx
            gradient[a, 1] += push * dy
            gradient[a, 2] += push * dz
            gradient[b, 0] -= push * dx
            gradient[b, 1] -= push * dy
            gradient[b, 2] -= push * dz
    return total


@compiled
def points_on(x: Array, points: Ints) -> Array:
    """Positions (k, 3) of the points of the sheet."""
    at = np.empty((points.shape[0], 3))
    for i in range(points.shape[0]):
        a, b, c, d = points[i]
        for m in range(3):
            at[i, m] = 0.25 * (x[a, m] + x[b, m] + x[c, m] + x[d, m])
    return at


def near_pairs(at: Array, home: Array, reach: float, apart: float) -> Ints:
    """Pairs of points nearer than ``reach`` that are more than ``apart`` away within the sheet.

    They come in the order of boxes of side ``reach``, so that pairs that lie together share points.
    ``home`` (k, 2): their places in the flat sheet, mm.
    """
    if not len(at):
        return np.empty((0, 2), np.int64)
    tree = scipy.spatial.cKDTree(at, compact_nodes=False, balanced_tree=False)
    first, second = tree.query_pairs(reach, output_type="ndarray").T
    along, up = (home[second] - home[first]).T
    far = along * along + up * up >= apart * apart
    boxes = ((at - at.min(axis=0)) / reach).astype(np.int64)
    order = np.lexsort(boxes.T[::-1])
    rank = np.empty_like(order)
    rank[order] = np.arange(len(at))
    keys = np.sort(rank[first[far]] * len(at) + rank[second[far]])
    return np.stack([order[part] for part in np.divmod(keys, len(at))], axis=1)
