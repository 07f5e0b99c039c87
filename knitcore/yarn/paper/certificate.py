"""Certified paths of a stitch: no yarn passes through yarn between two shapes.

The optimiser moves in its unknowns; between two of its iterates the yarn is taken to move along
straight lines, to which the argument of :mod:`knitcore.yarn.solve.topology` applies. A path too
long for that is halved in the unknowns.
"""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.yarn.model.neighbours import EXCLUSION_RADII, neighbour_pairs, pair_distances
from knitcore.yarn.paper.bezier_stitch import Stitch, shown_chart
from knitcore.yarn.solve.clasps import is_knitted
from knitcore.yarn.solve.topology import CROSSING, SAFETY

_POINTS = 20
"""Points a curve at which distances are measured."""
_REACH_RADII = 3.0
_HALVINGS = 7


def is_certified(stitch: Stitch, start: Array, end: Array) -> bool:
    """Tell whether the yarn can go from one shape to another without meeting itself."""
    return _certified(stitch, start, end, _HALVINGS)


def is_clasped(stitch: Stitch, unknowns: Array) -> bool:
    """Tell whether the yarn of the repeat is knotted as its fabric is."""
    fabric = stitch.fabric
    chart = shown_chart(fabric)
    line = stitch.centre_line(unknowns, _POINTS)[:-1]
    course, wale = float(unknowns[-2]), float(unknowns[-1])
    lines = []
    for row in range(chart.rows):
        parts = []
        for column in range(chart.columns):
            sign = (-1.0) ** (row * fabric.wale_odd + column * fabric.course_odd)
            parts.append(line * (1.0, 1.0, sign) + (column * course, row * wale, 0.0))
        lines.append(np.concatenate(parts))
    return is_knitted(chart, np.array(lines), course, wale)


def _certified(stitch: Stitch, start: Array, end: Array, halvings: int) -> bool:
    first, last = (stitch.centre_line(x, _POINTS)[:-1] for x in (start, end))
    steps = [np.linalg.norm(np.diff(line, axis=0), axis=1) for line in (first, last)]
    spacing = max(float(s.max()) for s in steps)
    place = np.concatenate([[0.0], np.cumsum(steps[0])])
    length = float(place[-1] + steps[0][-1])
    place /= length
    radius = stitch.yarn.radius_mm
    reach = _REACH_RADII * radius
    mirror = -1 if stitch.fabric.course_odd else 1, -1 if stitch.fabric.wale_odd else 1
    curves = [_without_drift(line, place, x) for line, x in ((first, start), (last, end))]
    sizes = [(float(x[-2]), float(x[-1])) for x in (start, end)]
    pairs, _ = neighbour_pairs(
        curves[0], place, sizes[0], (1, 1), mirror, reach, EXCLUSION_RADII * radius / length,
        np.ones(len(place), bool), (False, False),
    )  # fmt: skip
    step = sizes[1][0] - sizes[0][0], sizes[1][1] - sizes[0][1]
    distance = pair_distances(curves[0], sizes[0], place, (1, 1), pairs)
    change = pair_distances(curves[1] - curves[0], step, place, (1, 1), pairs)
    room = SAFETY * np.maximum(distance - CROSSING * spacing, 0.0)
    strain = max(abs(b / a - 1.0) for a, b in zip(*sizes, strict=True))
    moved = np.linalg.norm(curves[1][:, 0] - curves[0][:, 0], axis=1)
    approach = 2.0 * float(moved.max()) + strain * (reach + 2.0 * float(np.ptp(first[:, 1])))
    if np.all(change <= room) and approach <= reach - CROSSING * spacing:
        return True
    if halvings == 0:
        return False
    middle = 0.5 * (start + end)
    return _certified(stitch, start, middle, halvings - 1) and _certified(
        stitch, middle, end, halvings - 1
    )


def _without_drift(line: Array, place: Array, unknowns: Array) -> Array:
    """Samples for the pair list: (n, 4, 3), x without the drift of the cell."""
    curve = np.zeros((len(line), 4, 3))
    curve[:, 0] = line
    curve[:, 0, 0] -= float(unknowns[-2]) * place
    return curve
