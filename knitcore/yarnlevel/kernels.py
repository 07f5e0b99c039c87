"""Energy, gradient and Hessian of a cell of yarn, compiled.

Per sample of the curve everything depends on a = |d1|², b = d1·d2, c = |d2|², d = d1·d3,
e = d2·d3, f = |d3|², d_n the n-th derivative with respect to the parameter t. Bending and
regularisation are sums of monomials in them, whatever the parametrisation:

    ∫κ² ds         = ∫ (c a^-3/2 − b² a^-5/2) dt
    ∫|∂_ss t|² ds  = ∫ (f a^-5/2 + (c² − d² − 6be) a^-7/2 + b²(7c + 6d) a^-9/2 − 8b⁴ a^-11/2) dt

The length constraint, the gauge penalty and the weights w = |d1| dt of the contact sum are
functions of √a alone. Unknowns are the control points ("dofs", through an index map that ties
symmetric ones together and carries their signs) and the size of a stitch, course-wise and
wale-wise (the last two).
"""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from knitcore.yarnlevel.potential import potential, potential_curvature, potential_slope

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


@numba.njit(cache=True)
def sample_curve(controls: Array, course_mm: float, mirror: int, basis: Array) -> Array:
    """Position and three derivatives at every sample.

    Parameters
    ----------
    controls : (courses, C, 3), periodic part: x without the drift ``course_mm * t``.
    course_mm : size of a stitch along the course.
    mirror : -1 if z changes its sign from one period to the next, else 1.
    basis : (4, per_span, 6)

    Returns
    -------
    (courses, S, 4, 3); x of the position is without the drift, x of d1 has it.
    """
    courses, count, _ = controls.shape
    per_span = basis.shape[1]
    out = np.zeros((courses, count * per_span, 4, 3))
    for j in range(courses):
        for span in range(count):
            for o in range(per_span):
                s = span * per_span + o
                for a in range(6):
                    c = span - 2 + a
                    sign = 1.0
                    if c < 0:
                        c += count
                        sign = mirror
                    elif c >= count:
                        c -= count
                        sign = mirror
                    x = controls[j, c, 0]
                    y = controls[j, c, 1]
                    z = sign * controls[j, c, 2]
                    for d in range(4):
                        w = basis[d, o, a]
                        out[j, s, d, 0] += w * x
                        out[j, s, d, 1] += w * y
                        out[j, s, d, 2] += w * z
                out[j, s, 1, 0] += course_mm
    return out


@numba.njit(cache=True)
def contact(
    curve: Array,
    course_mm: float,
    wale_mm: float,
    pairs: Ints,
    place: Array,
    wales: int,
    rows: int,
    parameters: Array,
    order: int,
    force: Array,
    weight_slope: Array,
) -> float:
    """Contact energy; fills ``force`` (dE/dx, n x 3) and ``weight_slope`` (dE/d√a, n) if order.

    ``pairs`` is (n, 5): sample i, sample j, image across, image up, sign of z; each pair once.
    ``parameters``: factor of a pair, k, p, r, r_core, dt. ``place``: t of each sample.
    The slope with respect to the cell is left in force[n] (last row: course, wale, unused).
    """
    factor, k, p, radius, core, dt = parameters
    reach = 4.0 * radius * radius
    samples = place.shape[0]
    n = curve.shape[0]
    total = 0.0
    for q in range(pairs.shape[0]):
        i, j = pairs[q, 0], pairs[q, 1]
        across = place[j % samples] + pairs[q, 2] * wales - place[i % samples]
        up = float(j // samples + pairs[q, 3] * rows - i // samples)
        dx = curve[j, 0, 0] - curve[i, 0, 0] + across * course_mm
        dy = curve[j, 0, 1] - curve[i, 0, 1] + up * wale_mm
        dz = pairs[q, 4] * curve[j, 0, 2] - curve[i, 0, 2]
        square = dx * dx + dy * dy + dz * dz
        if square >= reach:
            continue
        distance = np.sqrt(square)
        w = factor * dt * dt
        si = np.sqrt(curve[i, 1, 0] ** 2 + curve[i, 1, 1] ** 2 + curve[i, 1, 2] ** 2)
        sj = np.sqrt(curve[j, 1, 0] ** 2 + curve[j, 1, 1] ** 2 + curve[j, 1, 2] ** 2)
        value = w * potential(distance, k, p, radius, core)
        total += value * si * sj
        if order > 0:
            slope = w * potential_slope(distance, k, p, radius, core) * si * sj / distance
            force[i, 0] -= slope * dx
            force[i, 1] -= slope * dy
            force[i, 2] -= slope * dz
            force[j, 0] += slope * dx
            force[j, 1] += slope * dy
            force[j, 2] += slope * dz * pairs[q, 4]
            force[n, 0] += slope * dx * across
            force[n, 1] += slope * dy * up
            weight_slope[i] += value * sj
            weight_slope[j] += value * si
    return total


@numba.njit(cache=True)
def rod_sample(
    d: Array, bend: float, regular: float, order: int, slope: Array, curvature: Array
) -> float:
    """Bending and regularisation of one sample, with slope (6) and curvature (6, 6) in a … f."""
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
    value = bend * (c * h3 - b * b * h5) + regular * (f * h5 + m7 * h7 + m9 * h9 + m11 * h11)
    if order > 0:
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
    if order > 1:
        curvature[:] = 0.0
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
    return float(value)


@numba.njit(cache=True)
def rod(
    curve: Array,
    samples: int,
    parameters: Array,
    tension: Array,
    weight_slope: Array,
    order: int,
    gradient: Array,
    local: Array,
) -> tuple[float, float]:
    """Terms that one sample has by itself; returns (bending + regularisation, gauge).

    ``gradient`` (n, 3, 3) receives dE/d(d1, d2, d3), ``local`` (n, 9, 9) their Hessian; both
    include the tension (per course) and the weights of the contact (``weight_slope``).
    ``parameters``: bend, regular, gauge stiffness, loop length, dt.
    """
    bend, regular, gauge, loop, dt = parameters
    slope = np.zeros(6)
    curvature = np.zeros((6, 6))
    lift = np.zeros((6, 9))
    rod_energy = 0.0
    gauge_energy = 0.0
    for i in range(curve.shape[0]):
        d = curve[i]
        rod_energy += rod_sample(d, dt * bend, dt * regular, order, slope, curvature)
        speed = np.sqrt(d[1, 0] ** 2 + d[1, 1] ** 2 + d[1, 2] ** 2)
        stretch = speed / loop - 1.0
        gauge_energy += 0.5 * dt * gauge * stretch * stretch
        if order == 0:
            continue
        pull = dt * (tension[i // samples] + gauge * stretch / loop) + weight_slope[i]
        slope[0] += 0.5 * pull / speed
        for m in range(3):
            gradient[i, 0, m] = 2.0 * slope[0] * d[1, m] + slope[1] * d[2, m] + slope[3] * d[3, m]
            gradient[i, 1, m] = slope[1] * d[1, m] + 2.0 * slope[2] * d[2, m] + slope[4] * d[3, m]
            gradient[i, 2, m] = slope[3] * d[1, m] + slope[4] * d[2, m] + 2.0 * slope[5] * d[3, m]
        if order == 1:
            continue
        curvature[0, 0] += 0.25 * (dt * gauge / loop**2 - pull / speed) / speed**2
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
        local[i] = lift.T @ (curvature @ lift)
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
    return rod_energy, gauge_energy


@numba.njit(cache=True)
def control_of(span: int, a: int, count: int, mirror: int) -> tuple[int, float]:
    """Control point a of a span within its course, and the sign of its z there."""
    c = span - 2 + a
    if c < 0:
        return c + count, float(mirror)
    if c >= count:
        return c - count, float(mirror)
    return c, 1.0


@numba.njit(cache=True)
def scatter_gradient(
    force: Array,
    gradient: Array,
    courses: int,
    count: int,
    mirror: int,
    basis: Array,
    dof: Ints,
    sign: Array,
    out: Array,
) -> None:
    """Add dE/dx (n, 3) and dE/d(d1, d2, d3) (n, 3, 3) to the gradient of the unknowns."""
    per_span = basis.shape[1]
    samples = count * per_span
    size = out.shape[0]
    for j in range(courses):
        for s in range(samples):
            i = j * samples + s
            span, o = s // per_span, s % per_span
            out[size - 2] += gradient[i, 0, 0]
            for a in range(6):
                c, z_sign = control_of(span, a, count, mirror)
                for m in range(3):
                    value = basis[0, o, a] * force[i, m]
                    for d in range(3):
                        value += basis[d + 1, o, a] * gradient[i, d, m]
                    if m == 2:
                        value *= z_sign
                    out[dof[j, c, m]] += sign[j, c, m] * value


@numba.njit(cache=True)
def scatter_local(  # noqa: PLR0912 - loops over a small tensor product
    local: Array,
    position: Array,
    position_speed: Array,
    courses: int,
    count: int,
    mirror: int,
    basis: Array,
    dof: Ints,
    sign: Array,
    hessian: Array,
) -> None:
    """Add the Hessian blocks that one sample has with itself.

    ``local`` (n, 9, 9) in d1, d2, d3; ``position`` (n, 3, 3) in x; ``position_speed`` (n, 3, 3)
    between x (first) and d1 (second).
    """
    per_span = basis.shape[1]
    samples = count * per_span
    size = hessian.shape[0]
    block = np.zeros((12, 12))
    half = np.zeros((18, 12))
    full = np.zeros((18, 18))
    index = np.zeros(18, np.int64)
    factor = np.zeros(18)
    for j in range(courses):
        for span in range(count):
            full[:] = 0.0
            for a in range(6):
                c, z_sign = control_of(span, a, count, mirror)
                for m in range(3):
                    index[3 * a + m] = dof[j, c, m]
                    factor[3 * a + m] = sign[j, c, m] * (z_sign if m == 2 else 1.0)
            for o in range(per_span):
                i = j * samples + span * per_span + o
                block[3:, 3:] = local[i]
                block[:3, :3] = position[i]
                block[:3, 3:6] = position_speed[i]
                for m in range(3):
                    for n in range(3):
                        block[3 + n, m] = position_speed[i, m, n]
                for a in range(6):
                    for m in range(3):
                        for col in range(12):
                            value = 0.0
                            for d in range(4):
                                value += basis[d, o, a] * block[3 * d + m, col]
                            half[3 * a + m, col] = value
                for row in range(18):
                    for b in range(6):
                        for n in range(3):
                            value = 0.0
                            for d in range(4):
                                value += basis[d, o, b] * half[row, 3 * d + n]
                            full[row, 3 * b + n] += value
                # course size enters d1 of every sample (its effect on x is in the contact)
                hessian[size - 2, size - 2] += local[i, 0, 0]
                for a in range(6):
                    for m in range(3):
                        value = factor[3 * a + m] * (
                            basis[1, o, a] * local[i, m, 0]
                            + basis[2, o, a] * local[i, 3 + m, 0]
                            + basis[3, o, a] * local[i, 6 + m, 0]
                        )
                        hessian[index[3 * a + m], size - 2] += value
                        hessian[size - 2, index[3 * a + m]] += value
            for row in range(18):
                for col in range(18):
                    hessian[index[row], index[col]] += factor[row] * factor[col] * full[row, col]


@numba.njit(cache=True)
def contact_hessian(  # noqa: PLR0912, PLR0915 - one pair at a time, in one sweep
    curve: Array,
    course_mm: float,
    wale_mm: float,
    pairs: Ints,
    start: Ints,
    place: Array,
    wales: int,
    rows: int,
    mirror: int,
    parameters: Array,
    basis: Array,
    dof: Ints,
    sign: Array,
    position: Array,
    position_speed: Array,
    hessian: Array,
) -> None:
    """Add the Hessian of the contact between samples; blocks of a sample with itself are left in
    ``position`` and ``position_speed``. ``start[i] … start[i + 1]`` are the pairs of sample i."""
    factor, k, p, radius, core, dt = parameters
    reach = 4.0 * radius * radius
    n_samples = curve.shape[0]
    samples = place.shape[0]
    courses = rows
    per_span = basis.shape[1]
    count = samples // per_span
    size = hessian.shape[0]
    n_controls = courses * count
    by_position = np.zeros((n_controls, 3, 3))
    by_speed = np.zeros((n_controls, 3, 3))
    touched = np.empty(n_controls, np.int64)
    is_touched = np.zeros(n_controls, np.bool_)
    cell_position = np.zeros((n_samples, 2, 3))
    cell_speed = np.zeros((n_samples, 2, 3))
    stiffness = np.zeros((3, 3))
    w = factor * dt * dt
    for i in range(n_samples):
        n_touched = 0
        xi = curve[i, 0]
        si = np.sqrt(curve[i, 1, 0] ** 2 + curve[i, 1, 1] ** 2 + curve[i, 1, 2] ** 2)
        ti = curve[i, 1] / si
        for q in range(start[i], start[i + 1]):
            j = pairs[q, 1]
            flip = float(pairs[q, 4])
            across = place[j % samples] + pairs[q, 2] * wales - place[i % samples]
            up = float(j // samples + pairs[q, 3] * rows - i // samples)
            dx = curve[j, 0, 0] - xi[0] + across * course_mm
            dy = curve[j, 0, 1] - xi[1] + up * wale_mm
            dz = flip * curve[j, 0, 2] - xi[2]
            square = dx * dx + dy * dy + dz * dz
            if square >= reach:
                continue
            distance = np.sqrt(square)
            normal = (dx / distance, dy / distance, dz / distance)
            sj = np.sqrt(curve[j, 1, 0] ** 2 + curve[j, 1, 1] ** 2 + curve[j, 1, 2] ** 2)
            tj = (curve[j, 1, 0] / sj, curve[j, 1, 1] / sj, curve[j, 1, 2] / sj)
            v0 = w * potential(distance, k, p, radius, core)
            v1 = w * potential_slope(distance, k, p, radius, core)
            v2 = w * potential_curvature(distance, k, p, radius, core)
            lateral = si * sj * v1 / distance
            axial = si * sj * v2 - lateral
            for m in range(3):
                fm = flip if m == 2 else 1.0
                for n in range(3):
                    fn = flip if n == 2 else 1.0
                    stiffness[m, n] = axial * normal[m] * normal[n]
                    if m == n:
                        stiffness[m, n] += lateral
                    position[i, m, n] += stiffness[m, n]
                    position[j, m, n] += fm * fn * stiffness[m, n]
                    position_speed[i, m, n] -= v1 * sj * normal[m] * ti[n]
                    position_speed[j, m, n] += v1 * si * fm * normal[m] * tj[n]
            # derivatives with respect to the size of the cell
            both = sj * ti[0] + si * tj[0]
            for m in range(3):
                fm = flip if m == 2 else 1.0
                course = stiffness[m, 0] * across + v1 * both * normal[m]
                wale = stiffness[m, 1] * up
                cell_position[i, 0, m] -= course
                cell_position[i, 1, m] -= wale
                cell_position[j, 0, m] += fm * course
                cell_position[j, 1, m] += fm * wale
                cell_speed[i, 0, m] += ti[m] * (v1 * sj * normal[0] * across + v0 * tj[0])
                cell_speed[j, 0, m] += tj[m] * (v1 * si * normal[0] * across + v0 * ti[0])
                cell_speed[i, 1, m] += v1 * sj * ti[m] * normal[1] * up
                cell_speed[j, 1, m] += v1 * si * tj[m] * normal[1] * up
            hessian[size - 2, size - 2] += (
                stiffness[0, 0] * across * across
                + 2.0 * v1 * normal[0] * across * both
                + 2.0 * v0 * ti[0] * tj[0]
            )
            mixed = stiffness[0, 1] * across * up + v1 * normal[1] * up * both
            hessian[size - 2, size - 1] += mixed
            hessian[size - 1, size - 2] += mixed
            hessian[size - 1, size - 1] += stiffness[1, 1] * up * up
            # rows of sample i, columns of the control points of sample j
            row_j = j // samples
            span_j = (j % samples) // per_span
            o_j = (j % samples) % per_span
            for b in range(6):
                c, z_sign = control_of(span_j, b, count, mirror)
                c += row_j * count
                if not is_touched[c]:
                    is_touched[c] = True
                    touched[n_touched] = c
                    n_touched += 1
                b0 = basis[0, o_j, b]
                b1 = basis[1, o_j, b]
                for n in range(3):
                    f_position = flip * z_sign if n == 2 else 1.0
                    f_speed = z_sign if n == 2 else 1.0
                    speed_n = b1 * f_speed * tj[n]
                    for m in range(3):
                        by_position[c, m, n] -= (
                            b0 * f_position * stiffness[m, n] + v1 * si * normal[m] * speed_n
                        )
                        by_speed[c, m, n] += ti[m] * (
                            b0 * f_position * v1 * sj * normal[n] + v0 * speed_n
                        )
        row_i = i // samples
        span_i = (i % samples) // per_span
        o_i = (i % samples) % per_span
        for q in range(n_touched):
            c2 = touched[q]
            is_touched[c2] = False
            j2, k2 = c2 // count, c2 % count
            for a in range(6):
                c, z_sign = control_of(span_i, a, count, mirror)
                b0 = basis[0, o_i, a]
                b1 = basis[1, o_i, a]
                for m in range(3):
                    r1 = dof[row_i, c, m]
                    s1 = sign[row_i, c, m] * (z_sign if m == 2 else 1.0)
                    if s1 == 0.0:
                        continue
                    for n in range(3):
                        r2 = dof[j2, k2, n]
                        value = (
                            s1
                            * sign[j2, k2, n]
                            * (b0 * by_position[c2, m, n] + b1 * by_speed[c2, m, n])
                        )
                        hessian[r1, r2] += value
                        hessian[r2, r1] += value
            by_position[c2] = 0.0
            by_speed[c2] = 0.0
    for i in range(n_samples):
        row_i = i // samples
        span_i = (i % samples) // per_span
        o_i = (i % samples) % per_span
        for a in range(6):
            c, z_sign = control_of(span_i, a, count, mirror)
            b0 = basis[0, o_i, a]
            b1 = basis[1, o_i, a]
            for m in range(3):
                r1 = dof[row_i, c, m]
                s1 = sign[row_i, c, m] * (z_sign if m == 2 else 1.0)
                for g in range(2):
                    value = s1 * (b0 * cell_position[i, g, m] + b1 * cell_speed[i, g, m])
                    hessian[r1, size - 2 + g] += value
                    hessian[size - 2 + g, r1] += value
