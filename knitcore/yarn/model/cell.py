"""The periodic cell of yarn that represents a chart, with the symmetries imposed on it.

A repeat of K and P is one curve per course. Two kinds of symmetry make it smaller:

- a shift by half the repeat that swaps K and P (1x1 rib, garter, seed, basket) halves the cell; the
  next cell is its image in the plane of the fabric (the paper's operation M). The four pure
  fabrics become a single stitch;
- a wale axis about which the repeat is its own mirror image ties control points in pairs.

Both are imposed in the ``mirrored`` branch and dropped in the ``free`` one.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.kernels.structures import Layout
from knitcore.yarn.model.spline import SplineGrid

FACE_LEGS = 1.0
"""Side (sign of z) of a knit's legs: the face of the fabric looks towards +z."""


@dataclass(frozen=True, eq=False)
class YarnCell:
    """Shape space of a cell.

    Parameters
    ----------
    purl : bool (rows, wales), the stitches of the cell, bottom row first.
    mirror_course, mirror_wale : the next cell that way has K and P swapped and z reflected.
    axis : place of the imposed wale axis in half stitches (1 = middle of the first stitch), None
        if there is none.
    grid : resolution of the curves.
    code : how its yarn is knotted, if it has other stitches than knits and purls.
    """

    purl: NDArray[np.bool_]
    mirror_course: bool
    mirror_wale: bool
    axis: int | None
    grid: SplineGrid
    code: tuple[float, ...] | None = None

    @property
    def rows(self) -> int:
        """Courses in the cell."""
        return int(self.purl.shape[0])

    @property
    def wales(self) -> int:
        """Wales in the cell."""
        return int(self.purl.shape[1])

    @property
    def stitches(self) -> int:
        """Stitches in the cell."""
        return self.rows * self.wales

    @property
    def mirror(self) -> tuple[int, int]:
        """Sign of z from one cell to the next, along the course and along the wale."""
        return (-1 if self.mirror_course else 1), (-1 if self.mirror_wale else 1)

    @property
    def symmetric(self) -> bool:
        """Tell whether a symmetry is imposed."""
        return self.mirror_course or self.mirror_wale or self.axis is not None

    @property
    def controls_per_course(self) -> int:
        """Control points of one course."""
        return self.wales * self.grid.controls

    @cached_property
    def place(self) -> Array:
        """Parameter t of the samples of a course, in stitches."""
        samples = self.wales * self.grid.samples
        return (np.arange(samples) + 0.5) / self.grid.samples

    def purl_at(self, row: int, wale: int) -> bool:
        """Kind of any stitch of the infinite fabric."""
        swaps = self.mirror_course * (wale // self.wales) + self.mirror_wale * (row // self.rows)
        return bool(self.purl[row % self.rows, wale % self.wales]) ^ bool(swaps % 2)

    @cached_property
    def _ties(self) -> tuple[NDArray[np.int64], Array, int]:
        """Index and sign of the unknown behind every control coordinate."""
        count = self.controls_per_course
        dof = np.zeros((self.rows, count, 3), np.int64)
        sign = np.zeros((self.rows, count, 3))
        free = 0
        for row in range(self.rows):
            for c in range(count):
                partner, swaps = c, 0
                if self.axis is not None:
                    partner = self.axis * self.grid.controls - c
                    swaps = partner // count
                    partner %= count
                z_sign = -1.0 if self.mirror_course and swaps % 2 else 1.0
                signs = (1.0, 1.0, 1.0) if self.axis is None else (-1.0, 1.0, z_sign)
                for m in range(3):
                    if partner < c:
                        dof[row, c, m] = dof[row, partner, m]
                        sign[row, c, m] = signs[m] * sign[row, partner, m]
                    elif partner > c or signs[m] > 0:
                        dof[row, c, m], sign[row, c, m] = free, 1.0
                        free += 1
        return dof, sign, free

    @property
    def dof(self) -> NDArray[np.int64]:
        """(rows, controls, 3) index of the unknown of each control coordinate."""
        return self._ties[0]

    @property
    def sign(self) -> Array:
        """(rows, controls, 3) sign of that unknown in it; 0 where symmetry makes it zero."""
        return self._ties[1]

    @property
    def unknowns(self) -> int:
        """Number of unknowns: free control coordinates and the two sizes of a stitch."""
        return self._ties[2] + 2

    @cached_property
    def layout(self) -> Layout:
        """Map from the unknowns to the curves, in the kernels' form."""
        return Layout(
            self.rows, self.wales, self.mirror[0], self.place, self.grid.basis, self.dof,
            self.sign, self.unknowns,
        )  # fmt: skip

    def controls(self, state: Array) -> Array:
        """Control points (rows, controls, 3), mm, without the drift of the cell."""
        return state[self.dof] * self.sign

    def state(self, controls: Array, course_mm: float, wale_mm: float) -> Array:
        """Unknowns of the given control points, averaged over tied ones."""
        total = np.zeros(self.unknowns)
        weight = np.zeros(self.unknowns)
        np.add.at(total, self.dof, controls * self.sign)
        np.add.at(weight, self.dof, np.abs(self.sign))
        total[:-2] /= weight[:-2]
        total[-2:] = course_mm, wale_mm
        return total


def mirrored_cell(chart: StitchChart, grid: SplineGrid) -> YarnCell:
    """The cell with every symmetry of the chart imposed.

    Examples
    --------
    >>> cell = mirrored_cell(StitchChart.parse("KKPP"), SplineGrid())
    >>> cell.rows, cell.wales, cell.mirror_course, cell.axis
    (1, 2, True, 2)
    """
    purl = chart.repeat().purl
    purl, mirror_course = _halved(purl.T)
    purl, mirror_wale = _halved(purl.T)
    free = YarnCell(purl, mirror_course, mirror_wale, None, grid)
    return YarnCell(purl, mirror_course, mirror_wale, _wale_axis(free), grid)


def free_cell(chart: StitchChart, grid: SplineGrid) -> YarnCell:
    """The cell without imposed symmetry: the repeat, at least two stitches each way."""
    repeat = chart.repeat()
    whole = repeat.tile(2 if repeat.rows == 1 else 1, 2 if repeat.columns == 1 else 1)
    return YarnCell(whole.purl, False, False, None, grid)


def plain_cell(chart: StitchChart, grid: SplineGrid) -> YarnCell:
    """The chart as it stands, not reduced and without symmetries."""
    return YarnCell(chart.purl, False, False, None, grid)


def _halved(purl: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], bool]:
    """Half of the grid along axis 0 if the other half is the same with K and P swapped."""
    half = purl.shape[0] // 2
    if purl.shape[0] == 2 * half and np.array_equal(purl[:half], ~purl[half:]):
        return purl[:half], True
    return purl, False


def _wale_axis(cell: YarnCell) -> int | None:
    for axis in range(1, 2 * cell.wales + 1):
        if all(
            cell.purl_at(row, wale) == cell.purl_at(row, axis - 1 - wale)
            for row in range(cell.rows)
            for wale in range(cell.wales)
        ):
            return axis
    return None
