"""Quarter cells: every chart as a composite of the four pure fabrics.

A stitch has four quarters. A quarter touches exactly one course-wise segment (left or right) and
one wale-wise segment (below or above), so their parities put it in exactly one of four phases,
named after the pure fabric whose segments are all like that. The four parities around a stitch, its
surroundings code, determine its part of the composite: there are only 16 kinds of stitch.
"""

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Codes, Mask
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_mask
from knitcore.chart.fabric import PHASES, Fabric
from knitcore.chart.segments import segment_map
from knitcore.chart.stitch_chart import StitchChart, as_chart

LEFT, RIGHT, BELOW, ABOVE = 1, 2, 4, 8
"""Bits of a surroundings code: that segment of the stitch is odd."""


def surroundings(
    chart: StitchChart, *, periodic: bool = False, stitch: Mask | None = None
) -> Codes:
    """The 4-bit code of odd segments around every stitch, shape (rows, columns).

    Parameters
    ----------
    chart : the chart, from the face side.
    periodic : treat the chart as a repeat. Otherwise a segment that would cross an edge takes the
        parity of the same stitch's segment on the other side (a lone row or column counts as
        even), so that a swatch of a pure fabric is pure up to its edge.
    stitch : bool (rows, columns), where a chart with an outline (not joined) has stitches; its
        outline is an edge like that of a rectangle. Codes elsewhere mean nothing.

    Examples
    --------
    >>> surroundings(StitchChart.parse("KKP"))
    array([[0, 2, 3]], dtype=uint8)
    """
    segments = segment_map(chart, periodic=periodic)
    course, wale = segments.course_odd.T, segments.wale_odd
    inside = np.ones_like(chart.purl) if stitch is None else stitch
    if periodic:
        left, right = np.roll(course, 1, axis=0), course
        below, above = np.roll(wale, 1, axis=0), wale
    else:
        left, right = _before_and_after(course, inside[:, 1:].T & inside[:, :-1].T)
        below, above = _before_and_after(wale, inside[1:] & inside[:-1])
    code = left.T * LEFT | right.T * RIGHT | below * BELOW | above * ABOVE
    return code.astype(np.uint8)


def quarter_phases(
    chart: StitchChart | str, *, periodic: bool = False, stitch: Mask | None = None
) -> Codes:
    """Phase of every quarter cell, with edges and outline as in :func:`surroundings`.

    Returns
    -------
    uint8 array (2 * rows, 2 * columns)
        Codes of :attr:`knitcore.chart.fabric.Fabric.phase`; row 0 is the lower half of the bottom
        row.

    Examples
    --------
    >>> quarter_phases(StitchChart.parse("KKP"))
    array([[0, 0, 0, 2, 2, 2],
           [0, 0, 0, 2, 2, 2]], dtype=uint8)
    """
    chart = as_chart(chart)
    if stitch is not None:
        stitch = as_stitches(stitch, chart)
    codes = surroundings(chart, periodic=periodic, stitch=stitch)
    phases = QUARTERS_OF_CODE[codes]  # (rows, columns, 2, 2)
    return phases.transpose(0, 2, 1, 3).reshape(2 * chart.rows, 2 * chart.columns)


def stitch_quarters(
    chart: StitchChart, *, periodic: bool = False, stitch: Mask | None = None
) -> Codes:
    """Phases of the four quarters of every stitch, (rows, columns, 4), as in
    :func:`quarter_phases`.
    """
    phases = quarter_phases(chart, periodic=periodic, stitch=stitch)
    by_stitch = phases.reshape(chart.rows, 2, chart.columns, 2).transpose(0, 2, 1, 3)
    return by_stitch.reshape(chart.rows, chart.columns, 4)


def as_stitches(stitch: ArrayLike, chart: StitchChart) -> Mask:
    """Take a table that says where a shaped piece has stitches, as an array.

    Raises
    ------
    InputError
        If it is no table of True and False for every stitch of the chart.
    """
    remedy = "Give True or False for every stitch of the chart, row 0 at the bottom."
    mask = as_mask("stitch", stitch, remedy)
    if mask.shape != chart.purl.shape:
        rows, columns = mask.shape
        problem = f"has {columns}x{rows} cells, the chart {chart.columns}x{chart.rows}."
        raise InputError("stitch", problem, remedy)
    return mask


def continued(chart: StitchChart, stitch: Mask) -> StitchChart:
    """A chart with its pattern mirrored about the stitches at its outline into "no stitch".

    So a segment that would cross the outline has the parity of the one on the stitch's other side,
    the rule of :func:`surroundings`, wherever the outline's two sides ask for the same.

    Parameters
    ----------
    stitch : bool (rows, columns), where there is a stitch: one at least.
    """
    from scipy.ndimage import distance_transform_edt

    if stitch.all():
        return chart
    near = distance_transform_edt(
        ~stitch, sampling=(stitch.size, 1), return_distances=False, return_indices=True
    )  # in the same row, if that has a stitch
    mirrored = 2 * near - np.indices(stitch.shape)
    mirrored = mirrored.clip(0, np.reshape(stitch.shape, (2, 1, 1)) - 1)
    purl = chart.purl[tuple(np.where(stitch[tuple(mirrored)], mirrored, near))]
    for step in (1, -1):  # cells just above a stitch, then those just below one
        inside, grid = stitch[::step], purl[::step]
        edge = inside[:-2] & inside[1:-1] & ~inside[2:]
        grid[2:][edge] = grid[:-2][edge]
    return StitchChart(purl)


def pure_fabric(chart: StitchChart) -> Fabric | None:
    """The pure fabric that a chart is up to its edges, if it is one.

    Examples
    --------
    >>> pure_fabric(StitchChart.of_fabric("seed", rows=31, columns=31))
    <Fabric.SEED: 'seed'>
    """
    phases = quarter_phases(chart)
    first = phases[0, 0]
    return PHASES[first] if (phases == first).all() else None


def reference_fabric(chart: StitchChart) -> Fabric:
    """The pure fabric with odd segments where the repeat has any."""
    phases = quarter_phases(chart, periodic=True)
    course_odd, wale_odd = bool((phases >= 2).any()), bool((phases % 2).any())
    return PHASES[2 * course_odd + wale_odd]


def _before_and_after(odd: Mask, there: Mask) -> tuple[Mask, Mask]:
    """Parity of the segments before and after each stitch along axis 0.

    A missing segment takes the parity of the other one.
    """
    framed = np.zeros((2, len(odd) + 2, odd.shape[1]), dtype=bool)
    framed[:, 1:-1] = odd & there, there
    odd, there = framed
    before, after = odd[:-1], odd[1:]
    return np.where(there[:-1], before, after), np.where(there[1:], after, before)


def _quarters_of_codes() -> Codes:
    codes = np.arange(16)
    course = np.stack([codes & LEFT, codes & RIGHT], axis=-1) > 0  # (16, left/right)
    wale = np.stack([codes & BELOW, codes & ABOVE], axis=-1) > 0  # (16, below/above)
    return (2 * course[:, None, :] + wale[:, :, None]).astype(np.uint8)


QUARTERS_OF_CODE = _quarters_of_codes()
"""Phases of the quarters of each surroundings code: uint8 (16, below/above, left/right)."""
