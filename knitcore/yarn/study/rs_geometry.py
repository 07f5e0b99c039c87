"""Geometry of the reduced-symmetry model measured from a relaxed stitch.

A stitch of a pure fabric touches its neighbours in four entangled regions, one in each quarter of
its yarn. Course-wise a connecting segment reaches along the foot from the middle of one region to
the middle of the next, wale-wise along a leg from the outer edge of one to the outer edge of the
other. Measured in this way on the paper's own Bezier curves, whose strands A and B are these
regions, the separations, lengths and slopes agree with its tables 15 and 16
(docs/reduced-symmetry.md). A spline has no predefined regions; here a region is centred at the mean
of the contact energy and is as long as a uniform region of the same spread would be.
"""

from collections.abc import Mapping

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import SegmentGeometry
from knitcore.yarn.kernels.contact import contact_slopes
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.model.tiling import centre_lines
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.paper.bezier_stitch import Stitch
from knitcore.yarn.solve.splines import RelaxedRepeat


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
        Direction.COURSE: (sum(edges[3]) / 2.0, 1.0 + sum(edges[0]) / 2.0),
        Direction.WALE: (edges[0][0], edges[1][1]),
    }
    parity = {Direction.COURSE: cell.mirror_course, Direction.WALE: cell.mirror_wale}
    segments = {}
    for direction, (begin, end) in ends.items():
        first, last = (round((1.0 + t) * samples - 0.5) for t in (begin, end))
        segments[direction] = _measured(direction, parity[direction], line[first : last + 1])
    return segments


def published_segment_geometry(
    fabric: Fabric, yarn: YarnModel, cell: RelaxedCell
) -> Mapping[Direction, SegmentGeometry]:
    """The same on the paper's Bezier curves (branch ``published``).

    Parameters
    ----------
    fabric, yarn : of the relaxed stitch.
    cell : by :func:`knitcore.yarn.paper.bezier_relax.relax_published`.
    """
    stitch = Stitch(fabric, yarn, cell.convention)
    per_curve = 200
    line = stitch.centre_line(cell.state, per_curve)
    first = line[: per_curve // 2 + 1] * (1.0, 1.0, -1.0 if fabric.course_odd else 1.0)
    foot = [line[-1 - 3 * per_curve // 2 : -1], first + np.array([cell.cell_course_mm, 0.0, 0.0])]
    leg = line[: 3 * per_curve + 1]  # B1, c11, A1
    return {
        Direction.COURSE: _measured(Direction.COURSE, fabric.course_odd, np.vstack(foot)),
        Direction.WALE: _measured(Direction.WALE, fabric.wale_odd, leg),
    }


def _measured(direction: Direction, odd: bool, points: Array) -> SegmentGeometry:
    order = [direction.axis, 2, direction.other.axis]
    return SegmentGeometry.from_curve(Parity.ODD if odd else Parity.EVEN, points[:, order])


def entangled_regions(relaxed: RelaxedRepeat) -> list[tuple[float, float]]:
    """Ends (in stitches of yarn, from the middle of the foot) of the four entangled regions.

    Raises
    ------
    InputError
        If a quarter of the stitch touches nothing.
    """
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
    _, load = contact_slopes(
        curve, relaxed.cell_course_mm, relaxed.cell_wale_mm, pairs, relaxed.cell.layout,
        energy.contact_law,
    )  # fmt: skip
    return np.asarray(load)
