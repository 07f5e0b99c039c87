"""Contact of yarn with yarn: the sum over near pairs of samples, and its Hessian."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from knitcore.yarnlevel.kernels.curve import control_of
from knitcore.yarnlevel.potential import potential, potential_curvature, potential_slope

Array = NDArray[np.float64]
Ints = NDArray[np.int64]


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
