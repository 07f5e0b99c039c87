"""A piece of knitting as a sheet of stitches in space.

Every stitch is a quadrilateral between four corners. Its size is the relaxed size of its
surroundings (:mod:`knitcore.prediction.neighbourhood`), without the narrowing that folds account
for (:mod:`knitcore.cloth.space.folds`). The rest comes from its quarters, each of which is one of
the four pure fabrics (:mod:`knitcore.chart.phases`): stiffness of the membrane from the material,
bending rigidity and free curvature from the yarn level. Two neighbours of one kind with even
segments all around turn as stockinette does, knits with the face outside and purls with the back,
and less where folds oppose them; where segments are odd (garter, rib, seed) the next stitch cancels
the curvature, and the line between them stays flat.

Fabric cannot fold tighter than its thickness t allows: at 2 arctan(l / t) between stitches of size
l its inner surface is closed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array, rounded
from knitcore.chart.fabric import PHASES, Fabric
from knitcore.chart.phases import quarter_phases
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space import sheet_kernels as kernels
from knitcore.cloth.space.bending_constants import Bend, bends_of
from knitcore.cloth.space.folds import folds_of, rest_turns, turning
from knitcore.materials import Material
from knitcore.prediction.neighbourhood import counted_over_computed
from knitcore.prediction.size import RelaxedSize

Ints = NDArray[np.int64]

TWIST = 0.4
"""Rigidity of twist D₆₆ in units of the mean rigidity √(D_x D_y): that of a plate with ν = 0.2."""
APART = 1.6
"""Smallest distance within the sheet, in thicknesses, of points that may touch: a hairpin is π/2
long."""


@dataclass(frozen=True, eq=False)
class StitchSheet:
    """A sheet of stitches.

    Parameters
    ----------
    rows, columns : numbers of stitches; corners are numbered along the rows, the lowest first.
    flat_mm : (corners, 3) where they are in the flat sheet.
    quarters, membrane : see :func:`knitcore.cloth.space.sheet_kernels.quarters`.
    hinges, turning : see :func:`knitcore.cloth.space.sheet_kernels.hinges`.
    quads, twisting : see :func:`knitcore.cloth.space.sheet_kernels.twists`.
    thickness_mm, touch_n_per_mm : of the fabric, and the stiffness of its contact with itself, see
        :func:`knitcore.cloth.space.sheet_kernels.touches`.
    """

    rows: int
    columns: int
    flat_mm: Array
    quarters: Ints
    membrane: Array
    hinges: Ints
    turning: Array
    quads: Ints
    twisting: Array
    thickness_mm: float
    touch_n_per_mm: float

    @cached_property
    def rigidity_n_mm(self) -> float:
        """Mean bending rigidity of the lines between stitches, as stiffness of a turn."""
        return float(self.turning[:, 0].mean()) if len(self.turning) else 1.0

    @cached_property
    def stiffness_n_per_mm(self) -> float:
        """Mean stiffness of the membrane."""
        area = 0.25 * self.membrane[:, :2].prod(axis=1)
        return float((self.membrane[:, 2:4] / area[:, None]).mean())

    @property
    def force_scale_n(self) -> float:
        """Force that turns a line between stitches by a radian."""
        return self.rigidity_n_mm / float(self.membrane[:, :2].mean())

    @cached_property
    def used(self) -> NDArray[np.bool_]:
        """Mask (corners,) of the corners that a stitch has."""
        used = np.zeros(len(self.flat_mm), dtype=bool)
        used[self.quads] = True
        return used

    @cached_property
    def points(self) -> Ints:
        """Corners (k, 4) of the points that may touch: corners, and middles of stitches."""
        corners = np.repeat(np.flatnonzero(self.used)[:, None], 4, axis=1)
        return np.concatenate([corners, self.quads])

    def cut(self, stitches: NDArray[np.bool_]) -> StitchSheet:
        """The sheet without some of its stitches; its corners keep their numbers.

        Parameters
        ----------
        stitches : (rows, columns) those that stay.
        """
        kept = stitches.ravel()
        along, up = stitches[:, 1:] & stitches[:, :-1], stitches[1:] & stitches[:-1]
        lines = np.concatenate([along.ravel(), up.T.ravel()])
        return replace(
            self, quarters=self.quarters[kept.repeat(4)], membrane=self.membrane[kept.repeat(4)],
            hinges=self.hinges[lines], turning=self.turning[lines], quads=self.quads[kept],
            twisting=self.twisting[kept],
        )  # fmt: skip

    def part(self, rows: slice, columns: slice) -> tuple[StitchSheet, Ints, NDArray[np.bool_]]:
        """A rectangle of the sheet, the numbers that its corners have in the whole, and whether
        each is on the rim, where stitches outside act on it.

        Parameters
        ----------
        rows, columns : of corners.
        """
        corners = np.arange(len(self.flat_mm)).reshape(self.rows + 1, -1)[rows, columns]
        number = np.full(len(self.flat_mm), -1)
        number[corners.ravel()] = np.arange(corners.size)
        rim = np.zeros(corners.size + 1, dtype=bool)  # the last one is outside

        def within(net: Ints, values: Array) -> tuple[Ints, Array]:
            numbers = number[net]
            whole = (numbers >= 0).all(axis=1)
            rim[numbers[~whole]] = True
            return numbers[whole], values[whole]

        quarters, membrane = within(self.quarters, self.membrane)
        hinges, turning = within(self.hinges, self.turning)
        quads, twisting = within(self.quads, self.twisting)
        part = replace(
            self, rows=corners.shape[0] - 1, columns=corners.shape[1] - 1,
            flat_mm=self.flat_mm[corners.ravel()], quarters=quarters, membrane=membrane,
            hinges=hinges, turning=turning, quads=quads, twisting=twisting,
        )  # fmt: skip
        return part, corners.ravel(), rim[:-1]

    def clamped(self, held: NDArray[np.bool_]) -> StitchSheet:
        """The sheet with lines at the edge of a clamp twice as stiff: only their outer half bends.

        Parameters
        ----------
        held : (corners,) in the clamp.
        """
        at_edge = held[self.hinges[:, :2]].all(axis=1) & ~held[self.hinges].all(axis=1)
        turning = self.turning.copy()
        turning[at_edge, 0] *= 2.0
        turning[at_edge, 1] *= 0.5
        return replace(self, turning=turning)

    def shared(self, of_stitches: Array) -> Array:
        """Share a quantity of stitches, such as weight, equally among their corners, (corners,).

        Parameters
        ----------
        of_stitches : (stitches,) in the order of ``quads``.
        """
        parts = 0.25 * of_stitches.repeat(4)
        return np.asarray(
            np.bincount(self.quads.ravel(), parts, minlength=len(self.flat_mm)), dtype=float
        )

    def load_n(self, of_stitches: Array | float, axis: int = 2) -> Array:
        """Weights of stitches as forces (corners, 3) against an axis.

        Parameters
        ----------
        of_stitches : N, of each, (stitches,) in the order of ``quads``, or of all alike.
        axis : up.
        """
        load = np.zeros_like(self.flat_mm)
        load[:, axis] = -self.shared(np.broadcast_to(of_stitches, len(self.quads)))
        return load

    @cached_property
    def home_mm(self) -> Array:
        """Places (k, 2) of these points in the flat sheet."""
        return kernels.points_on(self.flat_mm, self.points)[:, :2].copy()

    def pairs(self, x: Array, skin_mm: float = 0.0) -> Ints:
        """Pairs of points that touch or nearly touch, and are not neighbours in the sheet.

        Parameters
        ----------
        skin_mm : how much farther apart than touching they may be.
        """
        at = kernels.points_on(x, self.points)
        reach = (1.0 + kernels.NAP) * self.thickness_mm + skin_mm
        return kernels.near_pairs(at, self.home_mm, reach, APART * self.thickness_mm)

    def energy(self, x: Array, pairs: Ints) -> tuple[float, Array]:
        """Energy, N·mm, and its gradient (corners, 3), N."""
        gradient = np.zeros_like(x)
        total = kernels.quarters(x, self.quarters, self.membrane, gradient)
        total += kernels.hinges(x, self.hinges, self.turning, gradient)
        total += kernels.twists(x, self.quads, self.twisting, gradient)
        total += kernels.touches(
            x, self.points, pairs, self.thickness_mm, self.touch_n_per_mm, gradient
        )
        return total, gradient


_QUARTERS = ((0, 1, 2), (1, 0, 3), (2, 3, 0), (3, 2, 1))
"""Corner of a stitch, its neighbour along the row, and that along the column, of every quarter."""


@dataclass(frozen=True, eq=False)
class Net:
    """Groups of corners that belong together; see :class:`StitchSheet`.

    Hinges between neighbours in a row, row by row, come before hinges between neighbours in a
    column, column by column.
    """

    quads: Ints
    quarters: Ints
    hinges: Ints

    @classmethod
    def of(cls, rows: int, columns: int) -> Net:
        """The net of a sheet with this number of rows and columns of stitches."""
        corner = np.arange((rows + 1) * (columns + 1)).reshape(rows + 1, columns + 1)
        quads = np.stack(
            [corner[:-1, :-1], corner[:-1, 1:], corner[1:, :-1], corner[1:, 1:]], axis=-1
        ).reshape(-1, 4)
        quarters = np.stack([quads[:, order] for order in _QUARTERS], axis=1).reshape(-1, 3)
        across = _between(corner.T)
        across[:, [0, 1]] = across[:, [1, 0]]  # the face stays on the same side
        hinges = np.concatenate([_between(corner), across])
        return cls(*(np.ascontiguousarray(part) for part in (quads, quarters, hinges)))


def _between(corner: Ints) -> Ints:
    """Corners of the lines between the neighbours of a row."""
    return np.stack(
        [
            corner[:-1, 1:-1], corner[1:, 1:-1], corner[:-1, :-2], corner[1:, :-2],
            corner[:-1, 2:], corner[1:, 2:],
        ],
        axis=-1,
    ).reshape(-1, 6)  # fmt: skip


def sheet_of(
    chart: StitchChart,
    material: Material,
    stitches: NDArray[np.bool_] | None = None,
    size: RelaxedSize | None = None,
) -> StitchSheet:
    """The sheet of a chart; :meth:`StitchSheet.cut` leaves out places without a stitch.

    Parameters
    ----------
    chart : continued where the piece has no stitch (:func:`knitcore.chart.phases.continued`).
    stitches : (rows, columns) False where the piece has none: its edges are free there.
    size : relaxed size of the mean stitch, if known.

    Raises
    ------
    InputError, ConvergenceError
        If the material lacks a fabric, or its yarn does not relax.
    """
    rows, columns = chart.rows, chart.columns
    phases = quarter_phases(chart)
    if stitches is not None:
        own = stitches.repeat(2, axis=0).repeat(2, axis=1)
        phases = np.where(own, quarter_phases(chart, stitch=stitches), phases)
    ratio = counted_over_computed(chart, material, size, stitches)
    of = _Fabrics.of(material, ratio)
    folds = folds_of(chart, material, of.free_turns, stitches)
    sizes = folds.sizes_mm * ratio  # (rows, columns, 2)
    net = Net.of(rows, columns)
    by_stitch = phases.reshape(rows, 2, columns, 2).transpose(0, 2, 1, 3).reshape(-1, 4)
    quarter_size = sizes.reshape(-1, 2).repeat(4, axis=0)
    area = 0.25 * quarter_size.prod(axis=1, keepdims=True)
    membrane = np.concatenate([quarter_size, area * of.membrane[by_stitch].reshape(-1, 4)], axis=1)
    side = turning(chart, stitches)
    along = _turning(side, chart.purl, phases, of, folds.share[..., 0])
    across = _turning(side.T, chart.purl.T, phases.T, of.turned(), folds.share[..., 1].T)
    rigidity = np.sqrt(of.rigidity_n_mm.prod(axis=1))[by_stitch].mean(axis=1)
    twisting = 4.0 * TWIST * rigidity / sizes.reshape(-1, 2).prod(axis=1)
    mean = sizes.mean(axis=(0, 1))
    flat = np.zeros(((rows + 1) * (columns + 1), 3))
    flat[:, 0] = np.tile(np.append(0.0, np.cumsum(sizes[..., 0].mean(axis=0))), rows + 1)
    flat[:, 1] = np.repeat(np.append(0.0, np.cumsum(sizes[..., 1].mean(axis=1))), columns + 1)
    flat[:, :2] -= flat[:, :2].mean(axis=0)
    return StitchSheet(
        rows=rows,
        columns=columns,
        flat_mm=rounded(flat),
        quarters=net.quarters,
        membrane=rounded(membrane),
        hinges=net.hinges,
        turning=rounded(np.concatenate([along, across])),
        quads=net.quads,
        twisting=rounded(twisting),
        thickness_mm=float(rounded(of.thickness_mm)),
        touch_n_per_mm=float(
            rounded(of.membrane[..., :2].mean() * mean.prod() / of.thickness_mm**2)
        ),
    )


@dataclass(frozen=True, eq=False)
class _Fabrics:
    """Tables of the four fabrics, by phase; along the rows first, then along the columns.

    Parameters
    ----------
    size_mm : (4, 2).
    membrane : (4, 4) C₁₁, C₂₂, C₁₂, G, N/mm.
    rigidity_n_mm : (4, 2).
    curvature_per_mm : (4, 2) of a knit.
    thickness_mm : of stockinette.
    """

    size_mm: Array
    membrane: Array
    rigidity_n_mm: Array
    curvature_per_mm: Array
    thickness_mm: float

    @classmethod
    def of(cls, material: Material, ratio: Array) -> _Fabrics:
        """Tables of a material whose stitches are wider and higher by a ratio (2,)."""
        bends: Mapping[Fabric, Bend] = bends_of(material)
        records = [material.record(fabric) for fabric in PHASES]
        laws = [record.law for record in records]
        curvature = np.zeros((len(PHASES), 2))
        knit = bends[Fabric.STOCKINETTE]
        curvature[Fabric.STOCKINETTE.phase] = (
            knit.curvature_course_per_mm, knit.curvature_wale_per_mm
        )  # fmt: skip
        return cls(
            ratio * [r.stitch_mm for r in records],
            np.array(
                [
                    (
                        law.stiffness_xxxx, law.stiffness_yyyy,
                        0.5 * (law.stiffness_xxyy + law.stiffness_yyxx), law.shear_modulus,
                    )
                    for law in laws
                ]
            ),
            np.array(
                [(bends[f].rigidity_course_n_mm, bends[f].rigidity_wale_n_mm) for f in PHASES]
            ),
            curvature,
            knit.thickness_mm,
        )  # fmt: skip

    @property
    def free_turns(self) -> Array:
        """Turn (2,) between stitches of stockinette at rest, rad."""
        phase = Fabric.STOCKINETTE.phase
        size = self.size_mm[phase]
        closed = 2.0 * np.arctan(size / self.thickness_mm)
        return np.asarray(np.minimum(np.abs(self.curvature_per_mm[phase]) * size, closed))

    def turned(self) -> _Fabrics:
        """Exchange rows and columns; phases keep their names."""
        return _Fabrics(
            self.size_mm[:, ::-1], self.membrane[:, [1, 0, 2, 3]], self.rigidity_n_mm[:, ::-1],
            self.curvature_per_mm[:, ::-1], self.thickness_mm,
        )  # fmt: skip


def _turning(
    side: NDArray[np.int8],
    purl: NDArray[np.bool_],
    phases: NDArray[np.uint8],
    of: _Fabrics,
    share: Array,
) -> Array:
    """Parameters of the lines between neighbours in a row, row after row."""
    sign = np.where(purl, -1.0, 1.0).repeat(2, axis=0).repeat(2, axis=1)
    rows, columns = purl.shape

    def beside(values: Array) -> Array:
        """Mean over the four quarters that meet at a line."""
        inner = values[:, 1:-1].reshape(rows, 2, columns - 1, 2)
        return np.asarray(inner.mean(axis=(1, 3)))

    length = beside(of.size_mm[phases][..., 0])
    width = beside(of.size_mm[phases][..., 1])
    rigidity = beside(of.rigidity_n_mm[phases][..., 0])
    closed = 2.0 * np.arctan(length / of.thickness_mm)
    unhindered = length * beside(sign * of.curvature_per_mm[phases][..., 0])
    free = np.clip(unhindered, -closed, closed)
    stiffness = rigidity * width / length
    turn = 0.5 * (share[:, 1:] + share[:, :-1]) * free
    rest = np.clip(rest_turns(side, turn, free, stiffness), -closed, closed)
    return np.stack([stiffness, rest, closed, 0.25 * length**2], axis=-1).reshape(-1, 4)
