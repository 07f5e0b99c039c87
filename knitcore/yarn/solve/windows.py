"""Part of a large cell that moves while the yarn around it rests.

A window is a block of stitches of a periodic sheet. Its control points are free; those of the
stitches around it, as far as strands reach, stay where they are and touch it. The sizes of a stitch
are held, and every course keeps the length of yarn that it has inside the window, so that any
number of windows can be relaxed one after the other and together lower the energy of the sheet.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, product

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.linear.dense import times
from knitcore.yarn.kernels.curve_samples import sample_curve
from knitcore.yarn.kernels.structures import Ints, Pairs
from knitcore.yarn.model.cell import YarnCell
from knitcore.yarn.model.constraints import (
    FOOT,
    Surroundings,
    foot_weights,
    independent,
    lean_weights,
    middle_weights,
    tip_weights,
)
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.spline import SUPPORT

Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Extent:
    """The rows, or the wales, of a window in a periodic sheet.

    Attributes
    ----------
    stitches : (n,) which ones the window's cell holds, those around it included.
    free : (n,) which of them move.
    cut : whether the sheet continues beyond; else the window is as large as the sheet, and repeats.
    """

    stitches: Ints
    free: Bools
    cut: bool

    @property
    def own(self) -> Ints:
        """The rows or wales that move."""
        return self.stitches[self.free]


Window = tuple[Extent, Extent]
"""Rows and wales of a window."""


def windows(around: Ints, size: int, first: tuple[int, int]) -> list[Window]:
    """Windows that cover a sheet without overlap.

    Parameters
    ----------
    around : (2, rows, wales) how many rows, and wales, the strands of a stitch reach beyond it.
    size : most rows and wales of a window.
    first : row and wale where the first window begins.
    """
    counts = around.shape[1:]
    rows, wales = (
        _spans(count, size, int(reach.max()), begin)
        for count, reach, begin in zip(counts, around, first, strict=True)
    )
    covering = []
    for row, wale in product(rows, wales):
        beside = around[:, (row % counts[0])[:, None], wale % counts[1]].max(axis=(1, 2))
        covering.append(
            (_extent(row, counts[0], int(beside[0])), _extent(wale, counts[1], int(beside[1])))
        )
    return covering


def touch(window: Window, other: Window) -> bool:
    """Tell whether a window holds stitches that move in another, so that only one may move."""
    return any(
        all(np.isin(a.own, b.stitches).any() for a, b in zip(*both, strict=True))
        for both in ((window, other), (other, window))
    )


def _spans(count: int, size: int, around: int, first: int) -> list[Ints]:
    """Places of one direction, ``size`` at most; all of them if hardly any would rest."""
    if count <= size + 2 * around:
        return [np.arange(count)]
    edges = first + np.linspace(0, count, -(-count // size) + 1).round().astype(int)
    return [np.arange(begin, end) for begin, end in pairwise(edges)]


def _extent(own: Ints, count: int, around: int) -> Extent:
    if len(own) == count:
        return Extent(own, np.ones(count, bool), cut=False)
    places = np.arange(own[0] - around, own[-1] + 1 + around)
    return Extent(places % count, (places >= own[0]) & (places <= own[-1]), cut=True)


@dataclass(frozen=True, eq=False, kw_only=True)
class WindowCell(YarnCell):
    """Shape space of a window: the control points of its free stitches.

    Parameters
    ----------
    resting : (rows, controls, 3) control points, zero where they are free.
    free : (rows, controls) which are free.
    """

    resting: Array
    free: Bools

    @cached_property
    def _ties(self) -> tuple[Ints, Array, int]:
        dof = np.zeros((*self.free.shape, 3), np.int64)
        count = 3 * int(self.free.sum())
        dof[self.free] = np.arange(count).reshape(-1, 3)
        sign = np.repeat(self.free[..., None], 3, axis=2).astype(float)
        return dof, sign, count

    def controls(self, state: Array) -> Array:
        """Control points (rows, controls, 3), mm, without the drift of the cell."""
        return self.resting + super().controls(state)


@dataclass(frozen=True, eq=False, kw_only=True)
class WindowEnergy(CellEnergy):
    """Energy of a window and the yarn that rests around it.

    Parameters
    ----------
    cut : (2,) whether the sheet continues beyond the window's cell, across and up.
    moving : (rows * S,) samples that depend on free control points.
    resting_curve : (rows * S, 4, 3) the curve around.
    own_rows : rows of the cell that have free stitches.
    length_mm : (k,) length of yarn that each of them is to have in the cell.
    stitch_mm : length of yarn that counts as one stitch of the sheet; None for the mean of the
        window's rows.
    around : surroundings of the free stitches where the sheet lies flat; None where it does not.

    ``flat`` holds the middle of every free stitch at height zero, its foot, and its posture.
    """

    cell: WindowCell
    cut: tuple[bool, bool]
    moving: Bools
    resting_curve: Array
    own_rows: Ints
    length_mm: Array
    around: Surroundings | None
    stitch_mm: float | None = None

    @property
    def stitch_of_yarn_mm(self) -> float:
        """Length of yarn that counts as one stitch where a yarn does not touch itself."""
        return self.mean_loop_mm if self.stitch_mm is None else self.stitch_mm

    @cached_property
    def prescribed_mm(self) -> Array:
        """(k,) the lengths that are prescribed."""
        return self.length_mm

    @cached_property
    def stretch_of(self) -> Ints:
        """Index of the prescribed length that each sample belongs to; 0 where nothing moves."""
        of_row = np.zeros(self.cell.rows, np.int64)
        of_row[self.own_rows] = np.arange(len(self.own_rows))
        return np.repeat(of_row, len(self.cell.place))

    @cached_property
    def held(self) -> Array:
        """(h, unknowns): height of the middle and slope at the foot of every free stitch, mm, and
        differences of posture, less what rests of them."""
        return self._rules[0]

    @cached_property
    def _rules(self) -> tuple[Array, Array]:
        """The rows of ``held``, and what the resting control points add to each."""
        grid = self.cell.grid
        rules = [self._rule(0, middle_weights(grid), 2), self._rule(FOOT, foot_weights(grid), 1)]
        if self.around is not None:
            tips, leans = (
                np.column_stack(self._rule(0, of(grid), 2)) for of in (tip_weights, lean_weights)
            )
            unlike = independent(self.around.alike(tips, leans))
            rules.append((unlike[:, :-1], unlike[:, -1]))
        return np.concatenate([r for r, _ in rules]), np.concatenate([rest for _, rest in rules])

    def _rule(self, first: int, weights: Array, axis: int) -> tuple[Array, Array]:
        """A weighted sum of control points of every free stitch, from the first after its foot."""
        cell, count = self.cell, self.cell.grid.controls
        row, wale = np.nonzero(cell.free[:, ::count] & self.flat)
        place = (count * wale[:, None] + first + np.arange(len(weights))) % cell.controls_per_course
        rows = np.zeros((len(row), cell.unknowns))
        free = cell.free[row[:, None], place] * weights
        np.add.at(rows, (np.arange(len(row))[:, None], cell.dof[row[:, None], place, axis]), free)
        return rows, (cell.resting[row[:, None], place, axis] * weights).sum(axis=1)

    def curve(self, state: Array) -> Array:
        """(rows * S, 4, 3): samples with three derivatives, as the sheet has them."""
        return np.where(self.moving[:, None, None], super().curve(state), self.resting_curve)

    def pairs(self, curve: Array, state: Array, reach: float) -> tuple[Pairs, Ints]:
        """Pairs nearer than ``reach`` of which one moves."""
        return self._near(curve, state, reach, self.moving, self.cut)

    def excess(self, state: Array, curve: Array) -> Array:
        """Lengths of the rows less those prescribed, and what ``held`` keeps at zero, mm."""
        lengths = row_lengths(self.cell, curve)[self.own_rows] - self.length_mm
        held = times(self.held, state) + self._rules[1]
        return np.concatenate([lengths, held])

    def length_gradients(self, curve: Array) -> Array:
        """(k, unknowns): gradient of each prescribed length."""
        tangent = self._tangent(curve).reshape(self.cell.rows, -1, 3)
        every = self._by_tangent(tangent.reshape(-1, 3))
        rows = np.zeros((len(self.own_rows), self.cell.unknowns))
        for row, own in zip(rows, self.own_rows, strict=True):
            unknowns = self.cell.dof[own, self.cell.free[own]].ravel()
            row[unknowns] = every[unknowns]
            row[-2] = tangent[own, :, 0].sum()
        return rows


def row_lengths(cell: YarnCell, curve: Array) -> Array:
    """(rows,) length of yarn in each row of a cell, mm."""
    speed = np.sqrt(np.einsum("im,im->i", curve[:, 1], curve[:, 1]))
    return np.asarray(speed.reshape(cell.rows, -1).sum(axis=1) / cell.grid.samples)


def window_energy(
    sheet: CellEnergy, controls: Array, sizes: Array, window: Window, missing: Array, *, flat: bool
) -> tuple[WindowEnergy, Array]:
    """The energy of a window of a sheet, and the state of the window there.

    Parameters
    ----------
    sheet : energy of the whole sheet, a plain periodic cell with a loop length a course.
    controls : (rows, controls, 3) of the sheet, mm.
    sizes : (2,) of a stitch, mm.
    missing : (rows,) length that each course of the sheet lacks, mm per stitch.
    flat : hold the middle of every free stitch at height zero.
    """
    rows, wales = window
    grid = sheet.cell.grid
    own = np.ix_(rows.stitches, each(wales.stitches, grid.controls))
    free = rows.free[:, None] & np.repeat(wales.free, grid.controls)
    here = controls[own]
    cell = WindowCell(
        purl=sheet.cell.purl[np.ix_(rows.stitches, wales.stitches)],
        mirror_course=False, mirror_wale=False, axis=None, grid=grid,
        resting=np.where(free[..., None], 0.0, here), free=free,
    )  # fmt: skip
    across = sample_curve(controls[rows.stitches], sizes[0], 1, grid.basis)
    curve = across[:, each(wales.stitches, grid.samples)].reshape(-1, 4, 3)
    touched = np.zeros_like(free)
    for shift in range(SUPPORT):  # a span depends on the control points from 2 before to 3 after it
        touched |= np.roll(free, 2 - shift, axis=1)
    moving = np.repeat(touched, grid.per_span, axis=1).ravel()
    own_rows = np.flatnonzero(rows.free)
    share = int(wales.free.sum()) * missing[rows.stitches[own_rows]]
    energy = WindowEnergy(
        cell=cell, yarn=sheet.yarn, loop_length_mm=sheet.loop_length_mm[rows.stitches],
        convention=sheet.convention, flat=flat,
        spacing_per_bending=sheet.spacing_per_bending, cut=(wales.cut, rows.cut), moving=moving,
        resting_curve=curve, own_rows=own_rows,
        length_mm=row_lengths(cell, curve)[own_rows] + share,
        around=Surroundings.of(sheet.cell).at(rows.own, wales.own) if flat else None,
        stitch_mm=shortest if (shortest := sheet.stitch_of_yarn_mm) < sheet.mean_loop_mm else None,
    )  # fmt: skip
    state = np.concatenate([here[free].ravel(), sizes])
    return energy, state


def each(stitches: Ints, count: int) -> Ints:
    """Places of ``count`` points a stitch."""
    return np.asarray((stitches[:, None] * count + np.arange(count)).ravel())
