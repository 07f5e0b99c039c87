"""Even cloth: a repeat as a uniform material, and sheets made of it.

A sheet of stitches (:mod:`knitcore.cloth.space.stitch_sheet`) is for pieces whose stitches differ.
Tests of a fabric are made on hundreds of equal repeats; here a rectangle of the sheet stands for
several stitches. Its size and stiffness come from the prediction, its bending from the yarn level.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array, rounded
from knitcore.base.bounds import check_linear_density
from knitcore.base.gravity import STANDARD_GRAVITY_M_PER_S2
from knitcore.chart.fabric import PHASES, Direction
from knitcore.chart.in_space import ClothInSpace
from knitcore.chart.phases import pure_fabric, quarter_phases
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.bending_constants import bends_of, mirrored_bending
from knitcore.cloth.space.stitch_sheet import TWIST, Net, StitchSheet
from knitcore.materials import Material
from knitcore.materials.yarn_per_stitch import yarn_per_stitch
from knitcore.prediction.predict import predict
from knitcore.prediction.size import RelaxedSize
from knitcore.yarn.library.yarns import yarn_for
from knitcore.yarn.study.bending import MAX_STITCHES, ROLLS_FROM, bending_length_mm

_MAX_POISSON = 0.95
"""Upper limit of √(ν_xy ν_yx); from 1 on, the membrane energy is not positive definite."""


@dataclass(frozen=True)
class EvenCloth:
    """A repeat as a uniform sheet; pairs of numbers are along the rows and along the columns.

    Parameters
    ----------
    stitch_mm : size of the mean stitch at rest.
    membrane_n_per_mm : C₁₁, C₂₂, C₁₂ and G.
    rigidity_n_mm : of bending, with the other size free.
    twist_n_mm : D₆₆, so that twisting by κ_xy has the energy 2 D₆₆ κ_xy² per area.
    curvature_per_mm : at rest, positive with the face outside.
    thickness_mm : of the fabric.
    weight_n_per_mm2 : of the relaxed fabric.
    from_quarters : whether bending is the mean over the quarters of the repeat, because it is too
        large for the yarn level. Folds, which stiffen wide ribs, are then left out.
    """

    stitch_mm: tuple[float, float]
    membrane_n_per_mm: tuple[float, float, float, float]
    rigidity_n_mm: tuple[float, float]
    twist_n_mm: float
    curvature_per_mm: tuple[float, float]
    thickness_mm: float
    weight_n_per_mm2: float
    from_quarters: bool = False

    @property
    def moment_n(self) -> tuple[float, float]:
        """Size of the moment per width that holds it flat, (2,), along the rows and columns."""
        course, wale = (
            d * abs(c) for d, c in zip(self.rigidity_n_mm, self.curvature_per_mm, strict=True)
        )
        return course, wale

    def bending_length_mm(self, axis: int) -> float:
        """Peirce's bending length of a strip along the rows (0) or the columns (1)."""
        return bending_length_mm(self.rigidity_n_mm[axis], self.weight_n_per_mm2)

    @property
    def weight_g_per_m2(self) -> float:
        """Mass per area."""
        return 1e9 * self.weight_n_per_mm2 / STANDARD_GRAVITY_M_PER_S2

    @property
    def curls(self) -> bool:
        """True if free edges roll up (:data:`knitcore.yarn.study.bending.ROLLS_FROM`)."""
        return 0.5 * self.thickness_mm * max(map(abs, self.curvature_per_mm)) >= ROLLS_FROM

    def flat(self) -> EvenCloth:
        """The cloth without its curvature at rest."""
        return replace(self, curvature_per_mm=(0.0, 0.0))

    def turned(self) -> EvenCloth:
        """The cloth with rows and columns exchanged."""
        c11, c22, c12, shear = self.membrane_n_per_mm
        return replace(
            self,
            stitch_mm=self.stitch_mm[::-1],
            membrane_n_per_mm=(c22, c11, c12, shear),
            rigidity_n_mm=self.rigidity_n_mm[::-1],
            curvature_per_mm=self.curvature_per_mm[::-1],
        )

    def sheet(self, rows: int, columns: int, size_mm: tuple[float, float]) -> StitchSheet:
        """A flat sheet of rectangles.

        Parameters
        ----------
        size_mm : of a rectangle, along the rows and along the columns.
        """
        net, count = Net.of(rows, columns), rows * columns
        area = size_mm[0] * size_mm[1]
        stiff = 0.25 * area * np.array(self.membrane_n_per_mm)
        lines = []
        for axis, number in ((0, rows * (columns - 1)), (1, columns * (rows - 1))):
            length, width = size_mm[axis], size_mm[1 - axis]
            closed = 2.0 * math.atan(length / self.thickness_mm)
            rest = float(np.clip(length * self.curvature_per_mm[axis], -closed, closed))
            stiffness = self.rigidity_n_mm[axis] * width / length
            lines.append(np.tile([stiffness, rest, closed, 0.25 * length**2], (number, 1)))
        flat = np.zeros(((rows + 1) * (columns + 1), 3))
        flat[:, 0] = np.tile(size_mm[0] * (np.arange(columns + 1) - 0.5 * columns), rows + 1)
        flat[:, 1] = np.repeat(size_mm[1] * (np.arange(rows + 1) - 0.5 * rows), columns + 1)
        mean = (self.membrane_n_per_mm[0] + self.membrane_n_per_mm[1]) / 2.0
        return StitchSheet(
            rows=rows,
            columns=columns,
            flat_mm=rounded(flat),
            quarters=net.quarters,
            membrane=rounded(np.tile([*size_mm, *stiff], (4 * count, 1))),
            hinges=net.hinges,
            turning=rounded(np.concatenate(lines)),
            quads=net.quads,
            twisting=rounded(np.full(count, 4.0 * self.twist_n_mm / area)),
            thickness_mm=float(rounded(self.thickness_mm)),
            touch_n_per_mm=float(rounded(mean * area / self.thickness_mm**2)),
        )


def cloth_of(
    chart: StitchChart,
    material: Material,
    *,
    linear_density_g_per_m: float,
    size: RelaxedSize | None = None,
) -> EvenCloth:
    """The cloth of a repeat.

    Parameters
    ----------
    linear_density_g_per_m : of the yarn.
    size : relaxed size of the mean stitch, if known.

    Raises
    ------
    InputError
        If the yarn's weight is impossible, or the material lacks a fabric or its loop length.
    ConvergenceError
        If it does not relax at the yarn level, or folds by itself.
    """
    repeat = chart.repeat()
    prediction = predict(repeat, material, size)
    course, wale = prediction.along(Direction.COURSE), prediction.along(Direction.WALE)
    poisson = np.sqrt(max(course.poisson * wale.poisson, 0.0)).clip(max=_MAX_POISSON)
    stiff = [along.modulus_n_per_mm / (1.0 - poisson**2) for along in (course, wale)]
    coupling = float(poisson) * math.sqrt(stiff[0] * stiff[1])
    stitch = course.relaxed_mm, wale.relaxed_mm
    rigidity, curvature, thickness = _bent(repeat, material)
    weight = float(stitch_weights_n(repeat, material, linear_density_g_per_m, periodic=True).mean())
    if size is not None:
        computed = predict(repeat, material)
        area = computed.course.relaxed_mm * computed.wale.relaxed_mm
        weight *= math.sqrt(stitch[0] * stitch[1] / area)
    return EvenCloth(
        stitch_mm=stitch,
        membrane_n_per_mm=(*stiff, coupling, prediction.shear_modulus_n_per_mm),
        rigidity_n_mm=rigidity,
        twist_n_mm=TWIST * math.sqrt(rigidity[0] * rigidity[1]),
        curvature_per_mm=curvature,
        thickness_mm=thickness,
        weight_n_per_mm2=weight / (stitch[0] * stitch[1]),
        from_quarters=repeat.stitches > MAX_STITCHES,
    )


@dataclass(frozen=True, eq=False, repr=False)
class StitchedCloth(ClothInSpace):
    """The stitches of a sheet of even cloth in a test, lines following the columns.

    Attributes
    ----------
    chart : the repeat, continued over the sheet.
    stitches : (rows, columns) those within the piece.
    corners_mm : (rows + 1, columns + 1, 3), float32; a hundredth of a millimetre apart and flat
        where there is no cloth, so that a picture hides them.
    """

    chart: StitchChart
    stitches: NDArray[np.bool_]
    corners_mm: NDArray[np.float32]


def stitched(
    corners_mm: Array,
    rectangle_mm: tuple[float, float],
    stitch_mm: tuple[float, float],
    repeat: StitchChart,
) -> StitchedCloth:
    """Lay the stitches of a repeat on a sheet of rectangles.

    Parameters
    ----------
    corners_mm : (lines, points, 3) corners of the rectangles, NaN outside the piece.
    rectangle_mm, stitch_mm : sizes at rest, along the points of a line and from line to line.
    """
    at = []
    for rectangle, stitch, lines in zip(
        rectangle_mm, stitch_mm, corners_mm.shape[1::-1], strict=True
    ):
        wide = rectangle * (lines - 1)
        count = max(1, int(wide / stitch))
        at.append((0.5 * (wide - count * stitch) + stitch * np.arange(count + 1)) / rectangle)
    grid = np.meshgrid(at[1], at[0], indexing="ij")
    parts = np.moveaxis(corners_mm, 2, 0)
    corners = np.stack(
        [scipy.ndimage.map_coordinates(part, grid, order=1, cval=np.nan) for part in parts], axis=-1
    )
    known = np.isfinite(corners)
    stitches = known[1:, 1:, 0] & known[1:, :-1, 0] & known[:-1, 1:, 0] & known[:-1, :-1, 0]
    rows, columns = stitches.shape
    small = repeat.repeat()
    tiled = small.tile(-(-rows // small.rows), -(-columns // small.columns))
    row, column = np.indices(corners.shape[:2])
    hidden = 0.01 * np.stack([column, row, 0 * row], axis=-1)
    shown = np.where(known, corners, hidden).astype(np.float32)
    return StitchedCloth(StitchChart(tiled.purl[:rows, :columns]), stitches, shown)


def stitch_weights_n(
    chart: StitchChart,
    material: Material,
    linear_density_g_per_m: float,
    *,
    periodic: bool = False,
    stitches: NDArray[np.bool_] | None = None,
) -> Array:
    """Weight of every stitch, (rows, columns), N; 0 where the mask ``stitches`` (rows, columns) is
    False.

    Raises
    ------
    InputError
        If the yarn's weight is impossible, or the material lacks a loop length.
    """
    check_linear_density(linear_density_g_per_m)
    loops = yarn_per_stitch(chart, material, periodic=periodic, stitch=stitches).stitch_mm
    weights = 1e-6 * STANDARD_GRAVITY_M_PER_S2 * linear_density_g_per_m * loops
    return np.asarray(weights if stitches is None else np.where(stitches, weights, 0.0))


def _bent(
    repeat: StitchChart, material: Material
) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Rigidities, free curvatures and thickness of a repeat."""
    fabric = pure_fabric(repeat.tile(2, 2))
    if fabric is not None:
        bend = bends_of(material)[fabric]
        sign = -1.0 if repeat.purl.all() else 1.0
        return (
            (bend.rigidity_course_n_mm, bend.rigidity_wale_n_mm),
            (sign * bend.curvature_course_per_mm, sign * bend.curvature_wale_per_mm),
            bend.thickness_mm,
        )
    if repeat.stitches > MAX_STITCHES:
        return _mean_bend(repeat, material)
    bending = mirrored_bending(repeat, yarn_for(material, repeat))
    return (
        (bending.course.rigidity_n_mm, bending.wale.rigidity_n_mm),
        (bending.course.curvature_per_mm, bending.wale.curvature_per_mm),
        bending.thickness_mm,
    )


def _mean_bend(
    repeat: StitchChart, material: Material
) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Rigidities, free curvatures and thickness of a large repeat: means over its quarters."""
    phases = quarter_phases(repeat, periodic=True)
    sign = np.where(repeat.purl, -1.0, 1.0).repeat(2, axis=0).repeat(2, axis=1)
    bends = bends_of(material)
    of = [bends[fabric] for fabric in PHASES]
    rigidity = np.array([(b.rigidity_course_n_mm, b.rigidity_wale_n_mm) for b in of])
    curved = np.array([(b.curvature_course_per_mm, b.curvature_wale_per_mm) for b in of])
    mean = rigidity[phases].mean(axis=(0, 1))
    moment = (sign[..., None] * (rigidity * curved)[phases]).mean(axis=(0, 1))
    course, wale = mean.tolist()
    free_course, free_wale = (moment / mean).tolist()
    thickness = np.array([b.thickness_mm for b in of])[phases].mean()
    return (course, wale), (free_course, free_wale), float(thickness)
