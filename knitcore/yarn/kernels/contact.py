"""Contact of yarn with yarn: the sum over near pairs of samples, and its Hessian."""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.yarn.kernels.couplings import add_to_sizes, couple, end_span, no_couplings
from knitcore.yarn.kernels.curve_samples import laid_out
from knitcore.yarn.kernels.potential import potential, potential_and_derivatives
from knitcore.yarn.kernels.structures import ContactLaw, Ints, Layout, Pairs


@compiled
def apart(
    at: Array, pairs: Pairs, q: int, layout: Layout, course_mm: float, wale_mm: float
) -> tuple[float, float, float]:
    """Vector from the first sample of a pair to the image of the second, mm."""
    i, j = pairs[q, 0], pairs[q, 1]
    return (
        at[j, 0] - at[i, 0] + layout.wales * pairs[q, 2] * course_mm,
        at[j, 1] - at[i, 1] + layout.rows * pairs[q, 3] * wale_mm,
        pairs[q, 4] * at[j, 2] - at[i, 2],
    )


@compiled
def contact_energy(
    curve: Array, course_mm: float, wale_mm: float, pairs: Pairs, layout: Layout, law: ContactLaw
) -> float:
    """Contact energy of the cell, N·mm."""
    reach = 4.0 * law.radius * law.radius
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    total = 0.0
    for q in range(pairs.shape[0]):
        dx, dy, dz = apart(at, pairs, q, layout, course_mm, wale_mm)
        square = dx * dx + dy * dy + dz * dz
        if square < reach:
            value = potential(np.sqrt(square), law.stiffness, law.exponent, law.radius, law.core)
            total += law.weight * value * at[pairs[q, 0], 5] * at[pairs[q, 1], 5]
    return total


@compiled
def contact_slopes(
    curve: Array, course_mm: float, wale_mm: float, pairs: Pairs, layout: Layout, law: ContactLaw
) -> tuple[Array, Array]:
    """Derivatives of the contact energy by the positions, (n + 1, 3), and by |d1|, (n,).

    The last row holds those by the size of a stitch, course-wise and wale-wise.
    """
    reach = 4.0 * law.radius * law.radius
    n = curve.shape[0]
    force, by_speed = np.zeros((n + 1, 3)), np.zeros(n)
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    for q in range(pairs.shape[0]):
        dx, dy, dz = apart(at, pairs, q, layout, course_mm, wale_mm)
        square = dx * dx + dy * dy + dz * dz
        if square >= reach:
            continue
        i, j = pairs[q, 0], pairs[q, 1]
        distance = np.sqrt(square)
        si, sj = at[i, 5], at[j, 5]
        v0, v1, _ = potential_and_derivatives(
            distance, law.stiffness, law.exponent, law.radius, law.core
        )
        slope = law.weight * v1 * si * sj / distance
        force[i, 0] -= slope * dx
        force[i, 1] -= slope * dy
        force[i, 2] -= slope * dz
        force[j, 0] += slope * dx
        force[j, 1] += slope * dy
        force[j, 2] += slope * dz * pairs[q, 4]
        force[n, 0] += slope * dx * (at[j, 3] - at[i, 3] + layout.wales * pairs[q, 2])
        force[n, 1] += slope * dy * (at[j, 4] - at[i, 4] + layout.rows * pairs[q, 3])
        by_speed[i] += law.weight * v0 * sj
        by_speed[j] += law.weight * v0 * si
    return force, by_speed


@compiled
def contact_hessian(  # noqa: PLR0915 - one pair at a time, in one sweep
    curve: Array,
    course_mm: float,
    wale_mm: float,
    pairs: Pairs,
    start: Ints,
    layout: Layout,
    law: ContactLaw,
    tiles: Array,
    where: Pairs,
) -> tuple[Array, Array, Array]:
    """Hessian of the contact, but for the blocks of samples with themselves.

    What couples different samples is added to the tiles (see
    :class:`~knitcore.yarn.kernels.tiles.TiledMatrix`), once (see ``add_transposed``). Returned are
    the rows of the two sizes of a stitch, (2, unknowns), and what couples samples with themselves:
    (n, 3, 3) in x, (n, 3, 3) between x (first) and d1 (second).

    ``start[i] … start[i + 1]`` are the pairs of sample i.
    """
    reach = 4.0 * law.radius * law.radius
    rows, wales = layout.rows, layout.wales
    samples = layout.place.shape[0]
    per_span = layout.basis.shape[1]
    count = samples // per_span
    size = layout.unknowns
    sizes = np.zeros((2, size))
    position = np.zeros((curve.shape[0], 3, 3))
    position_speed = np.zeros((curve.shape[0], 3, 3))
    at = laid_out(curve, layout.place, course_mm, wale_mm)
    couplings = no_couplings(layout)
    cell_position = np.zeros((curve.shape[0], 2, 3))
    cell_speed = np.zeros((curve.shape[0], 2, 3))
    # arrays, as the index of a tuple that varies is a branch for each of its entries
    stiffness, normal, ti, tj = np.zeros((3, 3)), np.empty(3), np.empty(3), np.empty(3)
    most = np.diff(start).max() if curve.shape[0] else 0
    others, columns = np.empty(most, np.int64), np.empty((most, 2, 18))
    w = law.weight
    for row_i in range(rows):
        for span_i in range(count):
            filled = 0
            for o_i in range(per_span):
                i = row_i * samples + span_i * per_span + o_i
                si = at[i, 5]
                near = 0
                for m in range(3):
                    ti[m] = curve[i, 1, m] / si
                for q in range(start[i], start[i + 1]):
                    j = pairs[q, 1]
                    flip = float(pairs[q, 4])
                    right, above = wales * pairs[q, 2], rows * pairs[q, 3]
                    dx, dy, dz = apart(at, pairs, q, layout, course_mm, wale_mm)
                    square = dx * dx + dy * dy + dz * dz
                    if square >= reach:
                        continue
                    across = at[j, 3] - at[i, 3] + right
                    up = at[j, 4] - at[i, 4] + above
                    distance = np.sqrt(square)
                    normal[0], normal[1], normal[2] = dx / distance, dy / distance, dz / distance
                    sj = at[j, 5]
                    for m in range(3):
                        tj[m] = curve[j, 1, m] / sj
                    v0, v1, v2 = potential_and_derivatives(
                        distance, law.stiffness, law.exponent, law.radius, law.core
                    )
                    v0, v1, v2 = w * v0, w * v1, w * v2
                    lateral = si * sj * v1 / distance
                    axial = si * sj * v2 - lateral
                    for m in range(3):
                        fm = flip if m == 2 else 1.0
                        for n in range(3):
                            fn = flip if n == 2 else 1.0
                            stiff = axial * normal[m] * normal[n]
                            if m == n:
                                stiff += lateral
                            stiffness[m, n] = stiff
                            position[i, m, n] += stiff
                            position[j, m, n] += fm * fn * stiff
                            position_speed[i, m, n] -= v1 * sj * normal[m] * ti[n]
                            position_speed[j, m, n] += v1 * si * fm * normal[m] * tj[n]
                            columns[near, 0, 3 * m + n] = -fn * stiff
                            columns[near, 0, 9 + 3 * m + n] = v1 * sj * ti[m] * fn * normal[n]
                            columns[near, 1, 3 * m + n] = -v1 * si * normal[m] * tj[n]
                            columns[near, 1, 9 + 3 * m + n] = v0 * ti[m] * tj[n]
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
                    sizes[0, size - 2] += (
                        stiffness[0, 0] * across * across
                        + 2.0 * v1 * normal[0] * across * both
                        + 2.0 * v0 * ti[0] * tj[0]
                    )
                    mixed = stiffness[0, 1] * across * up + v1 * normal[1] * up * both
                    sizes[0, size - 1] += mixed
                    sizes[1, size - 2] += mixed
                    sizes[1, size - 1] += stiffness[1, 1] * up * up
                    others[near] = j
                    near += 1
                filled = couple(couplings, filled, o_i, others[:near], columns[:near], layout)
            end_span(couplings, filled, row_i, span_i, layout, tiles, where)
    add_to_sizes(cell_position, cell_speed, layout, sizes)
    return sizes, position, position_speed
