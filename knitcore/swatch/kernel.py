"""The compiled heart: energy, forces and condensed tangent of all quarter cells in one pass.

A cell is a rectangle with four corners and a centre node, cut into four linear triangles (the
"crossed" pattern). In each triangle the images ``a = F X`` and ``b = F Y`` of the unit vectors
along course and wale are constant, and an energy density W(a, b) gives

    E = sum_t A_t W,    force = dE/dx,    tangent = d2E/dx2.

The centre node belongs to one cell only, so its two unknowns are eliminated cell by cell (exact,
no approximation). What is left is half as many unknowns on a plain grid of corners.

Corners are numbered in the order (0, 0), (1, 0), (1, 1), (0, 1) of (column, row).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from knitcore.law.stiffening import EXTENSION_START

Array = NDArray[np.float64]

WRINKLED_SHARE = 0.05
"""Share of the compressive energy that a wrinkled sheet keeps, so that its tangent has a bound."""

# The edge of each triangle (its two corners), whether the edge runs course-wise, and the sign of
# the direction from edge to centre.
_FIRST = (0, 1, 3, 0)
_SECOND = (1, 2, 2, 3)
_COURSEWISE = (True, False, True, False)
_INWARD = (1.0, -1.0, -1.0, 1.0)


@njit(cache=True)
def _stiffening(s: float) -> tuple[float, float, float]:
    """w, w', w'' of the full law; see knitcore.law.stiffening."""
    if s <= 0.0:
        return 0.0, 0.0, 0.0
    inside = min(s, EXTENSION_START)
    gap = 1.0 - inside
    energy = inside**3 / gap
    slope = inside * inside * (3.0 - 2.0 * inside) / (gap * gap)
    curvature = 2.0 / (gap * gap * gap) - 2.0
    beyond = s - inside
    return (
        energy + slope * beyond + 0.5 * curvature * beyond * beyond,
        slope + curvature * beyond,
        curvature,
    )


@njit(cache=True)
def _axial(p: Array, ex: float, ey: float) -> tuple[float, float, float, float, float, float]:
    """Energy density, stresses and stiffness of the full law at fibre strains."""
    cxx, cyy, cxy, kappa_x, kappa_y = p[0], p[1], p[2], p[8], p[9]
    wx, dwx, ddwx = _stiffening(p[4] * (ex + kappa_x * ey))
    wy, dwy, ddwy = _stiffening(p[5] * (ey + kappa_y * ex))
    energy = 0.5 * cxx * ex * ex + 0.5 * cyy * ey * ey + cxy * ex * ey
    if p[4] > 0.0:
        energy += p[6] / p[4] * wx
    if p[5] > 0.0:
        energy += p[7] / p[5] * wy
    sx, sy = p[6] * dwx, p[7] * dwy
    kx, ky = p[4] * p[6] * ddwx, p[5] * p[7] * ddwy
    return (
        energy,
        cxx * ex + cxy * ey + sx + kappa_y * sy,
        cxy * ex + cyy * ey + sy + kappa_x * sx,
        cxx + kx + kappa_y * kappa_y * ky,
        cyy + ky + kappa_x * kappa_x * kx,
        cxy + kappa_x * kx + kappa_y * ky,
    )


@njit(cache=True)
def _wrinkled(p: Array, ex: float, ey: float) -> tuple[float, float, float, float, float, float]:
    """The law relaxed by wrinkling: the least energy over all longer fibres."""
    taut = _axial(p, ex, ey)
    if ex <= 0.0 and ey <= 0.0:
        slack = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    elif ey > 0.0 and taut[1] < 0.0:
        e, _, s, kxx, kyy, kxy = _axial(p, _free(p, ey, 0), ey)
        slack = (e, 0.0, s, 0.0, kyy - kxy * kxy / kxx, 0.0)
    elif ex > 0.0 and taut[2] < 0.0:
        e, s, _, kxx, kyy, kxy = _axial(p, ex, _free(p, ex, 1))
        slack = (e, s, 0.0, kxx - kxy * kxy / kyy, 0.0, 0.0)
    else:
        return taut
    r = WRINKLED_SHARE
    return (
        r * taut[0] + (1 - r) * slack[0],
        r * taut[1] + (1 - r) * slack[1],
        r * taut[2] + (1 - r) * slack[2],
        r * taut[3] + (1 - r) * slack[3],
        r * taut[4] + (1 - r) * slack[4],
        r * taut[5] + (1 - r) * slack[5],
    )


@njit(cache=True)
def _free(p: Array, along: float, axis: int) -> float:
    """Strain on an axis at which its stress vanishes, at a strain on the other one (above 0).

    The stress is convex in the strain, so Newton's method comes down to the root from one side.
    """
    across = 0.0
    for _ in range(100):
        values = _axial(p, across, along) if axis == 0 else _axial(p, along, across)
        step = values[1 + axis] / values[3 + axis]
        across -= step
        if abs(step) <= 1e-14:
            break
    return across


@njit(cache=True)
def _point(
    model: int, p: Array, a0: float, a1: float, b0: float, b1: float, force: Array, stiffness: Array
) -> float:
    """Energy density at (a, b); writes dW/d(a0, a1, b0, b1) and the (4, 4) second derivative."""
    if model == 0:
        ex, ey, shear = a0 - 1.0, b1 - 1.0, a1 + b0
        sx, sy = p[4] * ex, p[5] * ey
        energy = (
            0.5 * p[0] * ex * ex + 0.5 * p[1] * ey * ey + p[2] * ex * ey + 0.5 * p[3] * shear**2
        )
        if p[4] > 0.0:
            energy += p[6] / p[4] * sx**3 * (1.0 + sx)
        if p[5] > 0.0:
            energy += p[7] / p[5] * sy**3 * (1.0 + sy)
        force[0] = p[0] * ex + p[2] * ey + p[6] * sx * sx * (3.0 + 4.0 * sx)
        force[1] = force[2] = p[3] * shear
        force[3] = p[1] * ey + p[2] * ex + p[7] * sy * sy * (3.0 + 4.0 * sy)
        stiffness[:] = 0.0
        stiffness[0, 0] = p[0] + p[4] * p[6] * sx * (6.0 + 12.0 * sx)
        stiffness[3, 3] = p[1] + p[5] * p[7] * sy * (6.0 + 12.0 * sy)
        stiffness[0, 3] = stiffness[3, 0] = p[2]
        stiffness[1, 1] = stiffness[2, 2] = stiffness[1, 2] = stiffness[2, 1] = p[3]
        return float(energy)

    la, lb = math.sqrt(a0 * a0 + a1 * a1), math.sqrt(b0 * b0 + b1 * b1)
    if la < 1e-9 or lb < 1e-9:
        return np.inf
    if p[10] > 0.0:
        energy, wa, wb, waa, wbb, wab = _wrinkled(p, la - 1.0, lb - 1.0)
    else:
        energy, wa, wb, waa, wbb, wab = _axial(p, la - 1.0, lb - 1.0)
    gamma = math.atan2(a0 * b0 + a1 * b1, a0 * b1 - a1 * b0)
    energy += 0.5 * p[3] * gamma * gamma
    wg, wgg = p[3] * gamma, p[3]
    # Unit vectors along each fibre (t) and a quarter turn ahead of it (n). Turning the course
    # fibre by d theta changes gamma by d theta, turning the wale fibre by -d theta.
    at0, at1, bt0, bt1 = a0 / la, a1 / la, b0 / lb, b1 / lb
    an0, an1, bn0, bn1 = -at1, at0, -bt1, bt0
    ga, gb = wg / la, -wg / lb
    force[0], force[1] = wa * at0 + ga * an0, wa * at1 + ga * an1
    force[2], force[3] = wb * bt0 + gb * bn0, wb * bt1 + gb * bn1
    # Second derivatives in the (t, n) bases, then turned to (x, y).
    haa, hbb = wa / la + wgg / (la * la), wb / lb + wgg / (lb * lb)
    hta, htb = -wg / (la * la), wg / (lb * lb)
    hab = -wgg / (la * lb)
    stiffness[0, 0] = waa * at0 * at0 + 2.0 * hta * at0 * an0 + haa * an0 * an0
    stiffness[0, 1] = waa * at0 * at1 + hta * (at0 * an1 + an0 * at1) + haa * an0 * an1
    stiffness[1, 1] = waa * at1 * at1 + 2.0 * hta * at1 * an1 + haa * an1 * an1
    stiffness[2, 2] = wbb * bt0 * bt0 + 2.0 * htb * bt0 * bn0 + hbb * bn0 * bn0
    stiffness[2, 3] = wbb * bt0 * bt1 + htb * (bt0 * bn1 + bn0 * bt1) + hbb * bn0 * bn1
    stiffness[3, 3] = wbb * bt1 * bt1 + 2.0 * htb * bt1 * bn1 + hbb * bn1 * bn1
    stiffness[0, 2] = wab * at0 * bt0 + hab * an0 * bn0
    stiffness[0, 3] = wab * at0 * bt1 + hab * an0 * bn1
    stiffness[1, 2] = wab * at1 * bt0 + hab * an1 * bn0
    stiffness[1, 3] = wab * at1 * bt1 + hab * an1 * bn1
    stiffness[1, 0], stiffness[3, 2] = stiffness[0, 1], stiffness[2, 3]
    stiffness[2, 0], stiffness[3, 0] = stiffness[0, 2], stiffness[0, 3]
    stiffness[2, 1], stiffness[3, 1] = stiffness[1, 2], stiffness[1, 3]
    return float(energy)


@njit(cache=True)
def strain_change(
    model: int,
    cloth: NDArray[np.bool_],
    columns: int,
    width: Array,
    height: Array,
    corners: Array,
    centres: Array,
    corner_step: Array,
    centre_step: Array,
) -> Array:
    """Change of the mean strains along course and wale of every cell, (2, cells), to first order
    in a step of corners and centres.
    """
    out = np.zeros((2, cloth.size))
    x, d = np.empty((4, 2)), np.empty((4, 2))
    for cell in range(cloth.size):
        if not cloth[cell]:
            continue
        first = cell // columns * (columns + 1) + cell % columns
        nodes = (first, first + 1, first + columns + 2, first + columns + 1)
        for i in range(4):
            for m in range(2):
                x[i, m], d[i, m] = corners[nodes[i], m], corner_step[nodes[i], m]
        for t in range(4):
            i, j = _FIRST[t], _SECOND[t]
            along = 0 if _COURSEWISE[t] else 1  # of the edge; the inward derivative is across
            for axis, f0, f1, s0, s1 in (
                (along, x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], d[j, 0] - d[i, 0], d[j, 1] - d[i, 1]),
                (
                    1 - along,
                    _INWARD[t] * (2.0 * centres[cell, 0] - x[i, 0] - x[j, 0]),
                    _INWARD[t] * (2.0 * centres[cell, 1] - x[i, 1] - x[j, 1]),
                    _INWARD[t] * (2.0 * centre_step[cell, 0] - d[i, 0] - d[j, 0]),
                    _INWARD[t] * (2.0 * centre_step[cell, 1] - d[i, 1] - d[j, 1]),
                ),
            ):
                if model == 0:
                    change = s0 if axis == 0 else s1
                else:
                    change = (f0 * s0 + f1 * s1) / math.sqrt(f0 * f0 + f1 * f1)
                out[axis, cell] += 0.25 * change / (width[cell] if axis == 0 else height[cell])
    return out


@njit(cache=True)
def _add_triangle(
    i: int,
    j: int,
    e: int,
    c: int,
    se: float,
    sc: float,
    area: float,
    h: Array,
    k: Array,
    kc: Array,
    kcc: Array,
) -> None:
    """Add a triangle's tangent: corners i and j, e and c the offsets in h of its edge-wise and
    inward derivatives, se and sc their scales.
    """
    for m in range(2):
        for n in range(2):
            ee = area * se * se * h[e + m, e + n]
            cc = area * sc * sc * h[c + m, c + n]
            ec = area * se * sc * h[e + m, c + n]
            ce = area * se * sc * h[c + m, e + n]
            k[2 * i + m, 2 * i + n] += ee + ec + ce + cc
            k[2 * j + m, 2 * j + n] += ee - ec - ce + cc
            k[2 * i + m, 2 * j + n] += -ee + ec - ce + cc
            k[2 * j + m, 2 * i + n] += -ee - ec + ce + cc
            kc[m, 2 * i + n] += -2.0 * (ce + cc)
            kc[m, 2 * j + n] += 2.0 * (ce - cc)
            kcc[m, n] += 4.0 * cc


@njit(cache=True)
def _eliminate_centre(
    k: Array, kc: Array, kcc: Array, matrix: Array, rows: Array, inverse: Array
) -> None:
    """Write a cell's tangent without its centre, and what recovers the centre."""
    det = kcc[0, 0] * kcc[1, 1] - kcc[0, 1] * kcc[0, 1]
    i00, i01, i11 = kcc[1, 1] / det, -kcc[0, 1] / det, kcc[0, 0] / det
    for r in range(8):
        g0, g1 = i00 * kc[0, r] + i01 * kc[1, r], i01 * kc[0, r] + i11 * kc[1, r]
        for s in range(8):
            matrix[r, s] = k[r, s] - g0 * kc[0, s] - g1 * kc[1, s]
    rows[:] = kc
    inverse[0], inverse[1], inverse[2] = i00, i01, i11


@njit(cache=True)
def assemble(
    model: int,
    laws: Array,
    law_of_cell: NDArray[np.uint8],
    cloth: NDArray[np.bool_],
    columns: int,
    width: Array,
    height: Array,
    corners: Array,
    centres: Array,
    corner_force: Array,
    centre_force: Array,
    matrix: Array,
    centre_rows: Array,
    centre_inverse: Array,
) -> float:
    """Energy, forces and condensed element tangents.

    Writes ``corner_force`` (corners, 2) and ``centre_force`` (cells, 2), the full gradient;
    ``matrix`` (cells, 8, 8), the tangent of each cell with its centre eliminated; and what is
    needed to recover the centre, ``centre_rows`` (cells, 2, 8) and ``centre_inverse`` (cells, 3:
    xx, xy, yy of the inverse of the centre's own block). These three may be empty where no tangent
    is wanted. All is 0 where there is no ``cloth``, and where all of a law is 0. Energy and forces
    are linear in the laws' stiffnesses and betas, so that laws made of derivatives of these give
    the derivative of the forces.
    Returns the energy (N·mm), infinite where a fibre has collapsed to a point; nothing else that
    is written then means anything.
    """
    corner_force[:] = 0.0
    centre_force[:] = 0.0
    total = 0.0
    tangent = matrix.size > 0
    force, h = np.empty(4), np.empty((4, 4))
    x = np.empty((4, 2))
    k, kc, kcc = np.empty((8, 8)), np.empty((2, 8)), np.empty((2, 2))
    node = np.empty(4, np.int64)
    for cell in range(law_of_cell.size):
        p = laws[law_of_cell[cell]]
        if not cloth[cell] or not p.any():
            if tangent:
                matrix[cell], centre_rows[cell], centre_inverse[cell] = 0.0, 0.0, 0.0
            continue
        first = cell // columns * (columns + 1) + cell % columns
        node[0], node[1], node[2], node[3] = (
            first,
            first + 1,
            first + columns + 2,
            first + columns + 1,
        )
        for i in range(4):
            x[i, 0], x[i, 1] = corners[node[i], 0], corners[node[i], 1]
        hx, hy = width[cell], height[cell]
        area = 0.25 * hx * hy
        k[:] = 0.0
        kc[:] = 0.0
        kcc[:] = 0.0
        for t in range(4):
            i, j = _FIRST[t], _SECOND[t]
            inward = _INWARD[t]
            e0, e1 = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
            c0 = inward * (2.0 * centres[cell, 0] - x[i, 0] - x[j, 0])
            c1 = inward * (2.0 * centres[cell, 1] - x[i, 1] - x[j, 1])
            # e, c: offsets of the edge-wise and the inward derivative in (a0, a1, b0, b1)
            if _COURSEWISE[t]:
                e, c = 0, 2
                se, sc = 1.0 / hx, inward / hy
                total += area * _point(model, p, e0 / hx, e1 / hx, c0 / hy, c1 / hy, force, h)
            else:
                e, c = 2, 0
                se, sc = 1.0 / hy, inward / hx
                total += area * _point(model, p, c0 / hx, c1 / hx, e0 / hy, e1 / hy, force, h)
            for m in range(2):
                fe, fc = area * se * force[e + m], area * sc * force[c + m]
                corner_force[node[i], m] += -fe - fc
                corner_force[node[j], m] += fe - fc
                centre_force[cell, m] += 2.0 * fc
            if tangent:
                _add_triangle(i, j, e, c, se, sc, area, h, k, kc, kcc)
        if total == np.inf:
            return total
        if tangent:
            _eliminate_centre(k, kc, kcc, matrix[cell], centre_rows[cell], centre_inverse[cell])
    return total


@njit(cache=True)
def condense(
    columns: int,
    corner_force: Array,
    centre_force: Array,
    centre_rows: Array,
    centre_inverse: Array,
) -> Array:
    """Gradient on the corners after the centres have been eliminated, shape (corners, 2)."""
    out = corner_force.copy()
    for cell in range(centre_force.shape[0]):
        first = cell // columns * (columns + 1) + cell % columns
        nodes = (first, first + 1, first + columns + 2, first + columns + 1)
        f0, f1 = centre_force[cell, 0], centre_force[cell, 1]
        i00, i01, i11 = centre_inverse[cell]
        g0, g1 = i00 * f0 + i01 * f1, i01 * f0 + i11 * f1
        for r in range(8):
            out[nodes[r // 2], r % 2] -= centre_rows[cell, 0, r] * g0 + centre_rows[cell, 1, r] * g1
    return out


@njit(cache=True)
def centre_step(
    columns: int, step: Array, centre_force: Array, centre_rows: Array, centre_inverse: Array
) -> Array:
    """Newton step of the centres (cells, 2) that goes with a step of the corners (corners, 2)."""
    out = np.empty_like(centre_force)
    for cell in range(centre_force.shape[0]):
        first = cell // columns * (columns + 1) + cell % columns
        nodes = (first, first + 1, first + columns + 2, first + columns + 1)
        f0, f1 = centre_force[cell, 0], centre_force[cell, 1]
        for r in range(8):
            d = step[nodes[r // 2], r % 2]
            f0 += centre_rows[cell, 0, r] * d
            f1 += centre_rows[cell, 1, r] * d
        i00, i01, i11 = centre_inverse[cell]
        out[cell, 0], out[cell, 1] = -(i00 * f0 + i01 * f1), -(i01 * f0 + i11 * f1)
    return out
