"""The compiled kernel: energy, forces and condensed tangent of all quarter cells in one pass.

A cell is a rectangle with four corners and a centre node, cut into four linear triangles (the
"crossed" pattern). In each triangle the images ``a = F X`` and ``b = F Y`` of the unit vectors
along course and wale are constant, and an energy density W(a, b) gives

    E = sum_t A_t W,    force = dE/dx,    tangent = d2E/dx2.

The centre node belongs to one cell only, so its two unknowns are eliminated cell by cell (exact,
no approximation). What is left is half as many unknowns on a plain grid of corners.

Corners are numbered in the order (0, 0), (1, 0), (1, 1), (0, 1) of (column, row).
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.cloth.flat.grid import corners_of
from knitcore.law import stiffening

# The edge of each triangle (its two corners, the lower number first), whether the edge runs
# course-wise, the sign of its direction, and that of the direction from edge to centre.
_FIRST = (0, 1, 2, 0)
_SECOND = (1, 2, 3, 3)
_COURSEWISE = (True, False, True, False)
_ALONG = (1.0, 1.0, -1.0, 1.0)
_INWARD = (1.0, -1.0, -1.0, 1.0)

Stiffening = tuple[float, float, float]
"""w, w', w'' in one direction."""
Response = tuple[float, float, float, float, float, float]
"""Energy density, stresses xx and yy, stiffnesses xx, yy and xy."""
Pair = tuple[float, float]
Symmetric = tuple[float, float, float]
"""Entries 00, 01 and 11 of a symmetric matrix."""
Block = tuple[float, float, float, float]
"""Entries 00, 01, 10 and 11 of a matrix."""
Point = tuple[float, Pair, Pair, Symmetric, Block, Symmetric]
"""Energy density W(a, b), its derivatives by a and b, second derivatives aa, ab and bb."""

_corners_of: Callable[[int, int], tuple[int, int, int, int]] = compiled(corners_of)
_full: Callable[[float], Stiffening] = compiled(stiffening.full)
_published: Callable[[float], Stiffening] = compiled(stiffening.published)
_shear: Callable[[float, float, float], Stiffening] = compiled(stiffening.shear_response)

Law = Any
"""A law, as a record of :data:`knitcore.cloth.flat.sheet_models.LAW`."""


class Nodes(NamedTuple):
    """Vectors at the nodes of a sheet: positions or steps (mm), forces (N).

    Attributes
    ----------
    corners : (corners, 2).
    centres : (cells, 2).
    """

    corners: Array
    centres: Array


class Cells(NamedTuple):
    """The cells of a sheet, row by row.

    Attributes
    ----------
    columns : of the grid.
    law : (cells,), code of each cell's law.
    cloth : (cells,), where there is cloth.
    width, height : (cells,), rest sizes, mm.
    published : whether the energy is that of the published model (else the full one).
    """

    columns: int
    law: NDArray[np.int32]
    cloth: NDArray[np.bool_]
    width: Array
    height: Array
    published: bool


class CellTangents(NamedTuple):
    """Tangents of the cells with their centres eliminated, and the blocks that recover the centres.

    Attributes
    ----------
    matrix : (cells, 36), N/mm, lower triangles by rows.
    centre_rows : (cells, 2, 8), N/mm, from the corners to the centre's force.
    centre_inverse : (cells, 3), mm/N: xx, xy, yy of the inverse of the centre's own block.
    """

    matrix: Array
    centre_rows: Array
    centre_inverse: Array


@compiled
def _axial(law: Law, ex: float, ey: float) -> Response:
    """The full law at fibre strains."""
    x = _full(law.alpha_xx * (ex + law.kappa_xx * (ey + 0.5 * ey * ey)))
    y = _full(law.alpha_yy * (ey + law.kappa_yy * (ex + 0.5 * ex * ex)))
    return _stiffened(law, (law.kappa_xx, law.kappa_yy), x, y, ex, ey)


@compiled
def _stiffened(
    law: Law, kappa: tuple[float, float], x: Stiffening, y: Stiffening, ex: float, ey: float
) -> Response:
    """The law at strains along course and wale, given its stiffening in both directions."""
    cxx, cyy, cxy = law.stiffness_xxxx, law.stiffness_yyyy, law.stiffness_xxyy
    (bent_x, bent_y), (wx, dwx, ddwx), (wy, dwy, ddwy) = kappa, x, y
    kappa_x, kappa_y = bent_x * (1.0 + ey), bent_y * (1.0 + ex)
    energy = 0.5 * cxx * ex * ex + 0.5 * cyy * ey * ey + cxy * ex * ey
    if law.alpha_xx > 0.0:
        energy += law.beta_xx / law.alpha_xx * wx
    if law.alpha_yy > 0.0:
        energy += law.beta_yy / law.alpha_yy * wy
    sx, sy = law.beta_xx * dwx, law.beta_yy * dwy
    kx, ky = law.alpha_xx * law.beta_xx * ddwx, law.alpha_yy * law.beta_yy * ddwy
    return (
        energy,
        cxx * ex + cxy * ey + sx + kappa_y * sy,
        cxy * ex + cyy * ey + sy + kappa_x * sx,
        cxx + kx + kappa_y * kappa_y * ky + bent_y * sy,
        cyy + ky + kappa_x * kappa_x * kx + bent_x * sx,
        cxy + kappa_x * kx + kappa_y * ky,
    )


@compiled
def _published_point(law: Law, a0: float, a1: float, b0: float, b1: float) -> Point:
    """The published model at (a, b)."""
    shear, g = a1 + b0, law.shear_modulus
    ex, ey = a0 - 1.0, b1 - 1.0
    x, y = _published(law.alpha_xx * ex), _published(law.alpha_yy * ey)
    energy, sx, sy, kxx, kyy, kxy = _stiffened(law, (0.0, 0.0), x, y, ex, ey)
    return (
        energy + 0.5 * g * shear * shear,
        (sx, g * shear),
        (g * shear, sy),
        (kxx, 0.0, g),
        (0.0, kxy, g, 0.0),
        (g, 0.0, kyy),
    )


@compiled
def _full_point(law: Law, a0: float, a1: float, b0: float, b1: float) -> Point:
    """The full model at (a, b); the energy is infinite where a fibre has collapsed."""
    la, lb = math.sqrt(a0 * a0 + a1 * a1), math.sqrt(b0 * b0 + b1 * b1)
    if la < 1e-9 or lb < 1e-9:
        none = (0.0, 0.0, 0.0)
        return np.inf, (0.0, 0.0), (0.0, 0.0), none, (0.0, 0.0, 0.0, 0.0), none
    energy, wa, wb, waa, wbb, wab = _axial(law, la - 1.0, lb - 1.0)
    gamma = math.atan2(a0 * b0 + a1 * b1, a0 * b1 - a1 * b0)
    shear, wg, wgg = _shear(gamma, law.shear_modulus, law.shear_stiffening)
    # Unit vectors along each fibre (t) and a quarter turn ahead of it (n). Turning the course
    # fibre by d theta changes gamma by d theta, turning the wale fibre by -d theta.
    over_la, over_lb = 1.0 / la, 1.0 / lb
    at0, at1, bt0, bt1 = a0 * over_la, a1 * over_la, b0 * over_lb, b1 * over_lb
    an0, an1, bn0, bn1 = -at1, at0, -bt1, bt0
    ga, gb = wg * over_la, -wg * over_lb
    # Second derivatives in the (t, n) bases, then turned to (x, y).
    haa, hbb = (wa + wgg * over_la) * over_la, (wb + wgg * over_lb) * over_lb
    hta, htb, hab = -ga * over_la, -gb * over_lb, -wgg * over_la * over_lb
    return (
        energy + shear,
        (wa * at0 + ga * an0, wa * at1 + ga * an1),
        (wb * bt0 + gb * bn0, wb * bt1 + gb * bn1),
        (
            waa * at0 * at0 + 2.0 * hta * at0 * an0 + haa * an0 * an0,
            waa * at0 * at1 + hta * (at0 * an1 + an0 * at1) + haa * an0 * an1,
            waa * at1 * at1 + 2.0 * hta * at1 * an1 + haa * an1 * an1,
        ),
        (
            wab * at0 * bt0 + hab * an0 * bn0,
            wab * at0 * bt1 + hab * an0 * bn1,
            wab * at1 * bt0 + hab * an1 * bn0,
            wab * at1 * bt1 + hab * an1 * bn1,
        ),
        (
            wbb * bt0 * bt0 + 2.0 * htb * bt0 * bn0 + hbb * bn0 * bn0,
            wbb * bt0 * bt1 + htb * (bt0 * bn1 + bn0 * bt1) + hbb * bn0 * bn1,
            wbb * bt1 * bt1 + 2.0 * htb * bt1 * bn1 + hbb * bn1 * bn1,
        ),
    )


@compiled
def respond(
    laws: NDArray[Any],
    law_of_point: NDArray[np.int32],
    published: bool,
    fibres: Array,
    force: Array,
    stiffness: Array,
) -> Array:
    """Energy densities (points,), N/mm, at any points of a sheet, for other meshes than the grid.

    ``fibres`` (points, 4) are the images (a0, a1, b0, b1) of the unit vectors along course and
    wale; writes the derivatives of the densities, ``force`` (points, 4) and ``stiffness``
    (points, 4, 4). A density is infinite where a fibre has collapsed to a point.
    """
    energy = np.empty(len(law_of_point))
    for point in range(len(law_of_point)):
        law = laws[law_of_point[point]]
        a0, a1, b0, b1 = fibres[point]
        if published:
            energy[point], fa, fb, haa, hab, hbb = _published_point(law, a0, a1, b0, b1)
        else:
            energy[point], fa, fb, haa, hab, hbb = _full_point(law, a0, a1, b0, b1)
        force[point] = (fa[0], fa[1], fb[0], fb[1])
        stiffness[point, 0] = (haa[0], haa[1], hab[0], hab[1])
        stiffness[point, 1] = (haa[1], haa[2], hab[2], hab[3])
        stiffness[point, 2] = (hab[0], hab[2], hbb[0], hbb[1])
        stiffness[point, 3] = (hab[1], hab[3], hbb[1], hbb[2])
    return energy


@compiled
def _zero(matrix: Array) -> None:
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            matrix[i, j] = 0.0


@compiled
def _triangle(
    law: Law, published: bool, coursewise: bool, edge: Pair, inner: Pair, he: float, hc: float
) -> Point:
    """Energy density of a triangle, and its derivatives by the differences of positions along its
    edge and inward, of rest lengths he and hc.
    """
    e0, e1, c0, c1 = edge[0] / he, edge[1] / he, inner[0] / hc, inner[1] / hc
    a0, a1, b0, b1 = (e0, e1, c0, c1) if coursewise else (c0, c1, e0, e1)
    if published:
        w, wa, wb, aa, ab, bb = _published_point(law, a0, a1, b0, b1)
    else:
        w, wa, wb, aa, ab, bb = _full_point(law, a0, a1, b0, b1)
    if not coursewise:
        wa, wb, aa, ab, bb = wb, wa, bb, (ab[0], ab[2], ab[1], ab[3]), aa
    ee, ec, cc = 1.0 / (he * he), 1.0 / (he * hc), 1.0 / (hc * hc)
    return (
        w,
        (wa[0] / he, wa[1] / he),
        (wb[0] / hc, wb[1] / hc),
        (ee * aa[0], ee * aa[1], ee * aa[2]),
        (ec * ab[0], ec * ab[1], ec * ab[2], ec * ab[3]),
        (cc * bb[0], cc * bb[1], cc * bb[2]),
    )


@compiled
def _add_triangle(
    i: int,
    j: int,
    area: float,
    ee: Symmetric,
    ec: Block,
    cc: Symmetric,
    k: Array,
    kc: Array,
    kcc: Array,
) -> None:
    """Add a triangle's tangent: corners i < j; ee, ec and cc are the second derivatives of its
    energy density by the differences along its edge and inward. Of k and kcc the lower triangles.
    """
    for m in range(2):
        for n in range(2):
            e, c = area * ee[m + n], area * cc[m + n]
            mixed, turned = area * ec[2 * m + n], area * ec[2 * n + m]
            if n <= m:
                k[2 * i + m, 2 * i + n] += e + mixed + turned + c
                k[2 * j + m, 2 * j + n] += e - mixed - turned + c
                kcc[m, n] += 4.0 * c
            k[2 * j + m, 2 * i + n] += -e - mixed + turned + c
            kc[m, 2 * i + n] += -2.0 * (turned + c)
            kc[m, 2 * j + n] += 2.0 * (turned - c)


@compiled
def _eliminate_centre(k: Array, kc: Array, kcc: Array, tangent: CellTangents, cell: int) -> None:
    """Write a cell's tangent without its centre, and what recovers the centre."""
    det = kcc[0, 0] * kcc[1, 1] - kcc[1, 0] * kcc[1, 0]
    i00, i01, i11 = kcc[1, 1] / det, -kcc[1, 0] / det, kcc[0, 0] / det
    matrix, rows, inverse = tangent.matrix, tangent.centre_rows, tangent.centre_inverse
    place = 0
    for r in range(8):
        g0, g1 = i00 * kc[0, r] + i01 * kc[1, r], i01 * kc[0, r] + i11 * kc[1, r]
        for s in range(r + 1):
            matrix[cell, place] = k[r, s] - g0 * kc[0, s] - g1 * kc[1, s]
            place += 1
        rows[cell, 0, r], rows[cell, 1, r] = kc[0, r], kc[1, r]
    inverse[cell, 0], inverse[cell, 1], inverse[cell, 2] = i00, i01, i11


@compiled
def _clear(tangent: CellTangents, cell: int) -> None:
    """Write the tangent of a cell without cloth."""
    tangent.matrix[cell] = 0.0
    tangent.centre_rows[cell] = 0.0
    tangent.centre_inverse[cell] = 0.0


@compiled
def assemble(
    cells: Cells,
    laws: NDArray[Any],
    state: Nodes,
    force: Nodes,
    tangent: CellTangents | None,
    first: int,
    last: int,
) -> float:
    """Compute energy, forces and, where requested, condensed tangents of some of the cells.

    Adds to the corners' ``force``, the full gradient, and writes those of the centres and
    ``tangent``. All is 0 where there is no cloth, and where the law is all 0. Energy and forces
    are linear in the laws' stiffnesses and betas. Returns the energy (N·mm), infinite where a fibre
    has collapsed to a point, in which case the other output is meaningless.

    Parameters
    ----------
    cells : the sheet.
    laws : records of :data:`knitcore.cloth.flat.sheet_models.LAW`, by code.
    state : positions.
    force, tangent : to be written.
    first, last : the cells, the last excluded.
    """
    # Fields and rows are taken out of the loop: each costs an atomic count of references.
    law_of_cell, cloth, width, height = cells.law, cells.cloth, cells.width, cells.height
    corners, centres = state.corners, state.centres
    corner_force, centre_force = force.corners, force.centres
    centre_force[first:last] = 0.0
    total = 0.0
    x = np.empty((4, 2))
    k, kc, kcc = np.empty((8, 8)), np.empty((2, 8)), np.empty((2, 2))
    for cell in range(first, last):
        law = laws[law_of_cell[cell]]
        if not cloth[cell] or law.stiffness_xxxx == 0.0:
            if tangent is not None:
                _clear(tangent, cell)
            continue
        node = _corners_of(cell, cells.columns)
        for i in range(4):
            x[i, 0], x[i, 1] = corners[node[i], 0], corners[node[i], 1]
        centre0, centre1 = centres[cell, 0], centres[cell, 1]
        hx, hy = width[cell], height[cell]
        area = 0.25 * hx * hy
        if tangent is not None:
            _zero(k)
            _zero(kc)
            _zero(kcc)
        for t in range(4):
            i, j = _FIRST[t], _SECOND[t]
            he, hc = (hx, hy) if _COURSEWISE[t] else (hy, hx)
            w, we, wc, ee, ec, cc = _triangle(
                law,
                cells.published,
                _COURSEWISE[t],
                (x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]),
                (2.0 * centre0 - x[i, 0] - x[j, 0], 2.0 * centre1 - x[i, 1] - x[j, 1]),
                _ALONG[t] * he,
                _INWARD[t] * hc,
            )
            total += area * w
            for m in range(2):
                fe, fc = area * we[m], area * wc[m]
                corner_force[node[i], m] += -fe - fc
                corner_force[node[j], m] += fe - fc
                centre_force[cell, m] += 2.0 * fc
            if tangent is not None:
                _add_triangle(i, j, area, ee, ec, cc, k, kc, kcc)
        if total == np.inf:
            return total
        if tangent is not None:
            _eliminate_centre(k, kc, kcc, tangent, cell)
    return total


@compiled
def condense(columns: int, force: Nodes, tangent: CellTangents) -> Array:
    """Gradient on the corners after the centres have been eliminated, shape (corners, 2)."""
    out = force.corners.copy()
    for cell in range(len(force.centres)):
        nodes, rows = _corners_of(cell, columns), tangent.centre_rows[cell]
        f0, f1 = force.centres[cell]
        i00, i01, i11 = tangent.centre_inverse[cell]
        g0, g1 = i00 * f0 + i01 * f1, i01 * f0 + i11 * f1
        for r in range(8):
            out[nodes[r // 2], r % 2] -= rows[0, r] * g0 + rows[1, r] * g1
    return out


@compiled
def centre_step(columns: int, step: Array, force: Nodes, tangent: CellTangents) -> Array:
    """Newton step of the centres (cells, 2) that goes with a step of the corners (corners, 2)."""
    out = np.empty_like(force.centres)
    for cell in range(len(out)):
        nodes, rows = _corners_of(cell, columns), tangent.centre_rows[cell]
        f0, f1 = force.centres[cell]
        for r in range(8):
            d = step[nodes[r // 2], r % 2]
            f0 += rows[0, r] * d
            f1 += rows[1, r] * d
        i00, i01, i11 = tangent.centre_inverse[cell]
        out[cell, 0], out[cell, 1] = -(i00 * f0 + i01 * f1), -(i01 * f0 + i11 * f1)
    return out


@compiled
def apply(columns: int, tangent: CellTangents, step: Array) -> Array:
    """Condensed tangent times a step of the corners, (corners, 2)."""
    out, v, w = np.zeros_like(step), np.empty(8), np.empty(8)
    for cell in range(len(tangent.matrix)):
        nodes, matrix = _corners_of(cell, columns), tangent.matrix[cell]
        for i in range(4):
            v[2 * i], v[2 * i + 1] = step[nodes[i], 0], step[nodes[i], 1]
        place = 0
        for r in range(8):
            total = 0.0
            for s in range(r):
                total += matrix[place + s] * v[s]
                w[s] += matrix[place + s] * v[r]
            w[r] = total + matrix[place + r] * v[r]
            place += r + 1
        for i in range(4):
            out[nodes[i], 0] += w[2 * i]
            out[nodes[i], 1] += w[2 * i + 1]
    return out
