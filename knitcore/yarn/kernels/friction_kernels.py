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
from knitcore.yarn.kernels.curve_samples import control_of, laid_out
from knitcore.yarn.kernels.potential import potential_and_derivatives
from knitcore.yarn.kernels.structures import ContactLaw, Layout, Pairs


class Sliding(NamedTuple):
    """Pairs of samples that rub in one step.

    Attributes
    ----------
    pairs : see :data:`~knitcore.yarn.kernels.structures.Pairs`.
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
def friction_hessian(  # noqa: PLR0912, PLR0915 - compiled: one pair at a time
    curve: Array, course_mm: float, wale_mm: float, sliding: Sliding, layout: Layout,
    speeds: Array, tiles: Array, where: Pairs, sizes: Array,
) -> None:  # fmt: skip
    """Add the second derivatives by the unknowns to the tiles of a Hessian (see
    :class:`~knitcore.yarn.kernels.tiles.TiledMatrix`) and to its rows of the two sizes."""
    local, tile_size = layout.unknowns - 2, tiles.shape[1]
    samples = layout.place.shape[0]
    per_span = layout.basis.shape[1]
    count = samples // per_span
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    c, _ = slides(curve, course_mm, wale_mm, sliding.pairs, layout, speeds)
    # every unknown moves one component of d, of d1 at i and of d1 at the image of j
    unknown, component = np.empty(38, np.int64), np.empty(38, np.int64)
    tile, within = np.empty(38, np.int64), np.empty(38, np.int64)
    by = np.zeros((38, 3))
    slope = np.empty((38, 2))
    unknown[36], unknown[37] = layout.unknowns - 2, layout.unknowns - 1
    component[36], component[37] = 0, 1
    for q in range(c.shape[0]):
        if sliding.limit[q] <= 0.0:
            continue
        pair = sliding.pairs[q]
        flip = float(pair[4])
        by[:] = 0.0
        for side in range(2):
            s = pair[side]
            row, span, o = s // samples, (s % samples) // per_span, (s % samples) % per_span
            for a in range(6):
                k, z_sign = control_of(span, a, count, layout.mirror)
                for m in range(3):
                    u = 18 * side + 3 * a + m
                    unknown[u], component[u] = layout.dof[row, k, m], m
                    sign = layout.sign[row, k, m]
                    if m == 2:
                        sign *= z_sign * (flip if side else 1.0)
                    by[u, 0] = sign * layout.basis[0, o, a] * (1.0 if side else -1.0)
                    by[u, 1 + side] = sign * layout.basis[1, o, a]
        i, j = pair[0], pair[1]
        by[36, 0] = at[j, 3] - at[i, 3] + layout.wales * pair[2]
        by[36, 1] = by[36, 2] = 1.0
        by[37, 0] = at[j, 4] - at[i, 4] + layout.rows * pair[3]
        d = apart(at, sliding.pairs, q, layout, course_mm, wale_mm)
        for u in range(38):
            m = component[u]
            fm = flip if m == 2 else 1.0
            slope[u, 0] = (by[u, 0] * curve[i, 1, m] + d[m] * by[u, 1]) / speeds[i]
            slope[u, 1] = (by[u, 0] * fm * curve[j, 1, m] + d[m] * by[u, 2]) / speeds[j]
        g = sliding.scale[q]
        e0, e1 = g * (c[q, 0] - sliding.rest[q, 0]), g * (c[q, 1] - sliding.rest[q, 1])
        size = np.sqrt(e0 * e0 + e1 * e1)
        pull = sliding.limit[q] * g / max(size, sliding.slip[q])
        p0, p1 = pull * e0 / speeds[i], pull * e1 / speeds[j]
        stiff = pull * g
        # a pair that slips has no stiffness along its slide
        h0, h1 = (e0 / size, e1 / size) if size > sliding.slip[q] else (0.0, 0.0)
        for u in range(38):
            tile[u], within[u] = unknown[u] // tile_size, unknown[u] % tile_size
        for u in range(38):
            s0 = stiff * ((1.0 - h0 * h0) * slope[u, 0] - h0 * h1 * slope[u, 1])
            s1 = stiff * ((1.0 - h1 * h1) * slope[u, 1] - h0 * h1 * slope[u, 0])
            first = p0 * by[u, 1] + p1 * by[u, 2]
            row = unknown[u]
            for v in range(38):
                column = unknown[v]
                if row < local and (column >= local or tile[u] < tile[v]):
                    continue
                value = s0 * slope[v, 0] + s1 * slope[v, 1]
                if component[u] == component[v]:
                    value += first * by[v, 0] + by[u, 0] * (p0 * by[v, 1] + p1 * by[v, 2])
                if row >= local:
                    sizes[row - local, column] += value
                elif where[tile[u], tile[v]] >= 0:
                    tiles[where[tile[u], tile[v]], within[u], within[v]] += value
