"""Even and odd connecting segments: the symmetry of the yarn between neighbouring stitches.

Two like neighbours (K-K, P-P) are joined by a segment of even symmetry, unlike ones (K-P) by an
odd one (the paper's Fig. 3a, b). These two maps are all that the reduced-symmetry model uses of a
chart.
"""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Mask
from knitcore.base.kinds import check_flags
from knitcore.chart.fabric import Direction
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart, as_chart


@dataclass(frozen=True)
class SegmentCounts:
    """Numbers of even and odd segments of one direction."""

    even: int
    odd: int


@dataclass(frozen=True, eq=False, repr=False)
class SegmentMap(Result):
    """Parities of all segments of a chart.

    Attributes
    ----------
    course_odd : bool array (rows, columns - 1), or (rows, columns) if periodic
        Segment between the stitches (row, column) and (row, column + 1).
    wale_odd : bool array (rows - 1, columns), or (rows, columns) if periodic
        Segment between the stitches (row, column) and (row + 1, column).
    """

    course_odd: Mask
    wale_odd: Mask

    def counts(self, direction: Direction) -> SegmentCounts:
        """Numbers of even and odd segments that run in this direction."""
        odd_map = direction.of(self.course_odd, self.wale_odd)
        odd = int(np.count_nonzero(odd_map))
        return SegmentCounts(even=int(odd_map.size) - odd, odd=odd)


def segment_map(chart: StitchChart | str, *, periodic: bool = False) -> SegmentMap:
    """The even/odd maps of a chart, course-wise and wale-wise.

    Parameters
    ----------
    chart : the chart, from the face side.
    periodic : join the last column to the first and the top row to the bottom one, as in a repeat.

    Examples
    --------
    >>> rib = StitchChart.of_fabric("rib", rows=3, columns=4)
    >>> segment_map(rib).counts(Direction.COURSE), segment_map(rib).counts(Direction.WALE)
    (SegmentCounts(even=0, odd=9), SegmentCounts(even=8, odd=0))
    """
    check_flags(periodic=periodic)
    purl = as_chart(chart).purl
    course_odd, wale_odd = (purl ^ np.roll(purl, -1, axis=axis) for axis in (1, 0))
    if not periodic:
        course_odd, wale_odd = course_odd[:, :-1], wale_odd[:-1]
    return SegmentMap(course_odd, wale_odd)
