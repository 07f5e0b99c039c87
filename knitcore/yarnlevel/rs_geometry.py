"""Geometry of the reduced-symmetry model measured from a relaxed stitch.

A stitch of a pure fabric touches its neighbours in four entangled regions, one in each quarter of
its yarn. A connecting segment reaches from the outer edge of one region to the outer edge of the
next, as the paper's Bézier segments do: along the foot to the next stitch course-wise, along a
leg wale-wise. A spline has no ready-made regions; here one is centred where the contact energy has
its mean and is as long as a uniform region of the same spread would be.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from knitcore.errors import InputError
from knitcore.fabric import Direction
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import SegmentGeometry
from knitcore.yarnlevel import kernels
from knitcore.yarnlevel.relax import RelaxedRepeat
from knitcore.yarnlevel.tiling import centre_lines

Array = NDArray[np.float64]


def segment_geometry(relaxed: RelaxedRepeat) -> Mapping[Direction, SegmentGeometry]:
    """Shape of the course-wise and the wale-wise connecting segment of a pure fabric.

    Raises
    ------
    InputError
        If the repeat is not one stitch with mirrors, or its yarn touches too little to find the
        entangled regions.
    """
    cell = relaxed.cell
    if cell.stitches != 1:
        raise InputError(
            "relaxed", "is not a single stitch.", "Relax a pure fabric in the mirrored branch."
        )
    edges = entangled_regions(relaxed)
    # three stitches of the course, so that no segment is cut
    line = centre_lines(cell, relaxed.state, 1, 3)[0]
    samples = len(cell.place)
    ends = {
        Direction.COURSE: (edges[3][0], 1.0 + edges[0][1]),
        Direction.WALE: (edges[0][0], edges[1][1]),
    }
    parity = {Direction.COURSE: cell.mirror_course, Direction.WALE: cell.mirror_wale}
    found = {}
    for direction, (begin, end) in ends.items():
        first, last = (round((1.0 + t) * samples - 0.5) for t in (begin, end))
        points = line[first : last + 1][:, [direction.axis, 2]]
        kind = Parity.ODD if parity[direction] else Parity.EVEN
        found[direction] = SegmentGeometry.from_curve(kind, points)
    return found


def entangled_regions(relaxed: RelaxedRepeat) -> list[tuple[float, float]]:
    """Ends (in stitches of yarn, from the middle of the foot) of the four entangled regions."""
    cell = relaxed.cell
    place = cell.place
    load = _contact_load(relaxed)
    regions = []
    for quarter in range(4):
        inside = (place >= quarter / 4) & (place < (quarter + 1) / 4)
        total = float(load[inside].sum())
        if total <= 0.0:
            raise InputError(
                "relaxed", "a quarter of the stitch touches nothing.", "Use a shorter loop."
            )
        weights = load[inside] / total
        centre = float(weights @ place[inside])
        half = float(np.sqrt(3.0 * (weights @ (place[inside] - centre) ** 2)))
        regions.append((centre - half, centre + half))
    return regions


def _contact_load(relaxed: RelaxedRepeat) -> Array:
    """Contact energy per length at every sample, up to a factor."""
    energy = relaxed.energy
    curve = energy.curve(relaxed.state)
    pairs, _ = energy.pairs(curve, relaxed.state, 2.0 * relaxed.yarn.radius_mm)
    load = np.zeros(len(curve))
    cell = relaxed.cell
    kernels.contact(
        curve, relaxed.cell_course_mm, relaxed.cell_wale_mm, pairs, cell.place, cell.wales,
        cell.rows, energy.contact_parameters, 1, np.zeros((len(curve) + 1, 3)), load,
    )  # fmt: skip
    return load
