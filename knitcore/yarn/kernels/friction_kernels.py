"""Friction of pairs of samples that slide along each other, as a potential of one small step.

The slide of a pair is c = (d · t_i, d · t_j): how far the vector d between the two points reaches
along either strand, with t the direction of the yarn (d1 over its length of yarn). It does not
change when both strands turn together. With e = g (c - rest) and y = |e| / slip,

    energy = limit slip h(y),   h(y) = y² / 2 up to y = 1 (the pair sticks), y - 1/2 beyond.
"""

from typing import NamedTuple

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.contact import apart
from knitcore.yarn.kernels.couplings import add_to_sizes, couple, end_span, no_couplings
from knitcore.yarn.kernels.curve_samples import laid_out
from knitcore.yarn.kernels.potential import potential_and_derivatives
from knitcore.yarn.kernels.structures import ContactLaw, Layout, Pairs


class Sliding(NamedTuple):
    """Pairs of samples that rub in one step.

    Attributes
    ----------
    pairs : see :data:`~knitcore.yarn.kernels.structures.Pairs`, in the order of their first
        samples.
    limit : (n,) coefficient of friction times normal force, N.
    rest : (n, 2) slides at which no friction acts, mm.
    scale : (n,) g, which makes |e| the slide whatever the angle of the strands.
    slip : (n,) slide at which a pair lets go, mm; above 0.
    """

    pairs: Pairs
    limit: Array
    rest: Array
    scale: Array
    slip: Array


@compiled
def slides(
    curve: Array, course_mm: float, wale_mm: float, pairs: Pairs, layout: Layout, speeds: Array
) -> tuple[Array, Array]:
    """(n, 2) slide of every pair, mm, and (n,) cosine of the angle between its strands.

    ``speeds`` are the lengths of yarn per unit of the parameter at the samples, mm.
    """
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    out = np.empty((pairs.shape[0], 2))
    cosine = np.empty(pairs.shape[0])
    for q in range(pairs.shape[0]):
        i, j, flip = pairs[q, 0], pairs[q, 1], pairs[q, 4]
        dx, dy, dz = apart(at, pairs, q, layout, course_mm, wale_mm)
        a, b = curve[i, 1], curve[j, 1]
        out[q, 0] = (dx * a[0] + dy * a[1] + dz * a[2]) / speeds[i]
        out[q, 1] = (dx * b[0] + dy * b[1] + dz * flip * b[2]) / speeds[j]
        along = a[0] * b[0] + a[1] * b[1] + flip * a[2] * b[2]
        cosine[q] = along / (at[i, 5] * at[j, 5])
    return out, cosine


@compiled
def normal_forces(
    curve: Array, course_mm: float, wale_mm: float, pairs: Pairs, layout: Layout, law: ContactLaw
) -> Array:
    """(n,) force with which the two samples of every pair press on each other, N."""
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    out = np.zeros(pairs.shape[0])
    for q in range(pairs.shape[0]):
        dx, dy, dz = apart(at, pairs, q, layout, course_mm, wale_mm)
        _, slope, _ = potential_and_derivatives(
            np.sqrt(dx * dx + dy * dy + dz * dz), law.stiffness, law.exponent, law.radius, law.core
        )
        out[q] = -law.weight * slope * at[pairs[q, 0], 5] * at[pairs[q, 1], 5]
    return out


@compiled
def friction_energy(
    curve: Array, course_mm: float, wale_mm: float, sliding: Sliding, layout: Layout, speeds: Array
) -> float:
    """Potential of the friction in one step, N·mm."""
    c, _ = slides(curve, course_mm, wale_mm, sliding.pairs, layout, speeds)
    total = 0.0
    for q in range(c.shape[0]):
        e0 = sliding.scale[q] * (c[q, 0] - sliding.rest[q, 0])
        e1 = sliding.scale[q] * (c[q, 1] - sliding.rest[q, 1])
        y = np.sqrt(e0 * e0 + e1 * e1) / sliding.slip[q]
        total += sliding.limit[q] * sliding.slip[q] * (0.5 * y * y if y < 1.0 else y - 0.5)
    return total


@compiled
def friction_slopes(
    curve: Array, course_mm: float, wale_mm: float, sliding: Sliding, layout: Layout, speeds: Array
) -> tuple[Array, Array]:
    """Derivatives by the positions and the sizes of a stitch, (n + 1, 3), and by d1, (n, 3)."""
    n = curve.shape[0]
    force, by_d1 = np.zeros((n + 1, 3)), np.zeros((n, 3))
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    c, _ = slides(curve, course_mm, wale_mm, sliding.pairs, layout, speeds)
    for q in range(c.shape[0]):
        i, j, flip = sliding.pairs[q, 0], sliding.pairs[q, 1], sliding.pairs[q, 4]
        e0 = sliding.scale[q] * (c[q, 0] - sliding.rest[q, 0])
        e1 = sliding.scale[q] * (c[q, 1] - sliding.rest[q, 1])
        pull = sliding.limit[q] * sliding.scale[q]
        pull /= max(np.sqrt(e0 * e0 + e1 * e1), sliding.slip[q])
        p0, p1 = pull * e0 / speeds[i], pull * e1 / speeds[j]
        d = apart(at, sliding.pairs, q, layout, course_mm, wale_mm)
        across = at[j, 3] - at[i, 3] + layout.wales * sliding.pairs[q, 2]
        up = at[j, 4] - at[i, 4] + layout.rows * sliding.pairs[q, 3]
        for m in range(3):
            fm = float(flip) if m == 2 else 1.0
            along = p0 * curve[i, 1, m] + p1 * fm * curve[j, 1, m]
            force[i, m] -= along
            force[j, m] += fm * along
            by_d1[i, m] += p0 * d[m]
            by_d1[j, m] += p1 * fm * d[m]
            if m == 0:
                force[n, 0] += along * across
            elif m == 1:
                force[n, 1] += along * up
    return force, by_d1


@compiled
def friction_hessian(  # noqa: PLR0915 - one pair at a time, in one sweep
    curve: Array, course_mm: float, wale_mm: float, sliding: Sliding, layout: Layout,
    speeds: Array, local: Array, position: Array, position_speed: Array, tiles: Array,
    where: Pairs, sizes: Array,
) -> None:  # fmt: skip
    """Add the second derivatives to those of rod and contact.

    ``local`` (n, 9, 9), ``position`` and ``position_speed`` (n, 3, 3) couple samples with
    themselves, in d1, in x, and x with d1; tiles and sizes are those of ``contact_hessian``.
    """
    size, samples = layout.unknowns, layout.place.shape[0]
    per_span = layout.basis.shape[1]
    count = samples // per_span
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    c, _ = slides(curve, course_mm, wale_mm, sliding.pairs, layout, speeds)
    couplings = no_couplings(layout)
    cell_position = np.zeros((curve.shape[0], 2, 3))
    cell_speed = np.zeros((curve.shape[0], 2, 3))
    d, b = np.empty(3), np.empty(3)
    # second derivatives: by d twice, by d and the first d1, by d and the second
    by_d, by_first, by_second = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    start = np.zeros(curve.shape[0] + 1, np.int64)
    for q in range(c.shape[0]):
        start[sliding.pairs[q, 0] + 1] += 1
    most = start.max()
    start = np.cumsum(start)
    others, columns = np.empty(most, np.int64), np.empty((most, 2, 18))
    for span in range(layout.rows * count):
        filled = 0
        for o in range(per_span):
            i = span * per_span + o
            a = curve[i, 1]
            near = 0
            for q in range(start[i], start[i + 1]):
                j, flip = sliding.pairs[q, 1], float(sliding.pairs[q, 4])
                across = at[j, 3] - at[i, 3] + layout.wales * sliding.pairs[q, 2]
                up = at[j, 4] - at[i, 4] + layout.rows * sliding.pairs[q, 3]
                d[0], d[1], d[2] = apart(at, sliding.pairs, q, layout, course_mm, wale_mm)
                b[0], b[1], b[2] = curve[j, 1, 0], curve[j, 1, 1], flip * curve[j, 1, 2]
                g = sliding.scale[q]
                e0, e1 = g * (c[q, 0] - sliding.rest[q, 0]), g * (c[q, 1] - sliding.rest[q, 1])
                length = np.sqrt(e0 * e0 + e1 * e1)
                pull = sliding.limit[q] * g / max(length, sliding.slip[q])
                if pull <= 0.0:
                    continue
                # a pair that slips has no stiffness along its slide
                h0, h1 = (e0 / length, e1 / length) if length > sliding.slip[q] else (0.0, 0.0)
                p0, p1 = pull * e0 / speeds[i], pull * e1 / speeds[j]
                first = pull * g * (1.0 - h0 * h0) / (speeds[i] * speeds[i])
                mixed = -pull * g * h0 * h1 / (speeds[i] * speeds[j])
                second = pull * g * (1.0 - h1 * h1) / (speeds[j] * speeds[j])
                for m in range(3):
                    with_first = first * a[m] + mixed * b[m]
                    with_second = mixed * a[m] + second * b[m]
                    for n in range(3):
                        same = 1.0 if m == n else 0.0
                        by_d[m, n] = with_first * a[n] + with_second * b[n]
                        by_first[m, n] = with_first * d[n] + p0 * same
                        by_second[m, n] = with_second * d[n] + p1 * same
                for m in range(3):
                    fm = flip if m == 2 else 1.0
                    for n in range(3):
                        fn = flip if n == 2 else 1.0
                        position[i, m, n] += by_d[m, n]
                        position[j, m, n] += fm * fn * by_d[m, n]
                        position_speed[i, m, n] -= by_first[m, n]
                        position_speed[j, m, n] += fm * fn * by_second[m, n]
                        local[i, m, n] += first * d[m] * d[n]
                        local[j, m, n] += fm * fn * second * d[m] * d[n]
                        columns[near, 0, 3 * m + n] = -fn * by_d[m, n]
                        columns[near, 0, 9 + 3 * m + n] = fn * by_first[n, m]
                        columns[near, 1, 3 * m + n] = -fn * by_second[m, n]
                        columns[near, 1, 9 + 3 * m + n] = fn * mixed * d[m] * d[n]
                    course = by_d[m, 0] * across + by_first[m, 0] + by_second[m, 0]
                    wale = by_d[m, 1] * up
                    cell_position[i, 0, m] -= course
                    cell_position[i, 1, m] -= wale
                    cell_position[j, 0, m] += fm * course
                    cell_position[j, 1, m] += fm * wale
                    cell_speed[i, 0, m] += by_first[0, m] * across + mixed * d[m] * d[0]
                    cell_speed[j, 0, m] += fm * (by_second[0, m] * across + mixed * d[m] * d[0])
                    cell_speed[i, 1, m] += by_first[1, m] * up
                    cell_speed[j, 1, m] += fm * by_second[1, m] * up
                both = by_first[0, 0] + by_second[0, 0]
                sizes[0, size - 2] += (by_d[0, 0] * across + 2.0 * both) * across
                sizes[0, size - 2] += 2.0 * mixed * d[0] * d[0]
                shear = (by_d[0, 1] * across + by_first[1, 0] + by_second[1, 0]) * up
                sizes[0, size - 1] += shear
                sizes[1, size - 2] += shear
                sizes[1, size - 1] += by_d[1, 1] * up * up
                others[near] = j
                near += 1
            filled = couple(couplings, filled, o, others[:near], columns[:near], layout)
        end_span(couplings, filled, span // count, span % count, layout, tiles, where)
    add_to_sizes(cell_position, cell_speed, layout, sizes)
