"""A piece that hangs under its own weight."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.choice import Choice
from knitcore.base.errors import Cancelled
from knitcore.base.gravity import STANDARD_GRAVITY_M_PER_S2
from knitcore.chart.in_space import ClothInSpace, corners_of
from knitcore.chart.phases import continued
from knitcore.chart.stitch_chart import StitchChart, as_chart
from knitcore.cloth.space.curl import TIME_LIMIT_S, check_piece
from knitcore.cloth.space.even_cloth import stitch_weights_n
from knitcore.cloth.space.sheet_shape import settle, shake_mm
from knitcore.cloth.space.stitch_sheet import sheet_of
from knitcore.materials import Material, as_material
from knitcore.prediction.neighbourhood import counted_over_computed
from knitcore.prediction.size import RelaxedSize


class HungBy(Choice):
    """The part of a hanging piece that is held: its top edge, or its two top corners."""

    EDGE = "edge"
    CORNERS = "corners"


@dataclass(frozen=True, eq=False, repr=False)
class HungPiece(ClothInSpace):
    """A hanging piece at rest: x along the rows, y up, z towards the face.

    Parameters
    ----------
    corners_mm : (rows + 1, columns + 1, 3), corners of the stitches, the lowest row first.
    weight_n : of the piece.
    drop_mm : from the highest corner to the lowest.
    width_mm, depth_mm : extent of the piece.
    lengthening : of the middle column, over its length at rest in the flat sheet.
    converged : whether every corner is in equilibrium.
    stitches : (rows, columns) False where the piece has none.
    """

    corners_mm: Array
    weight_n: float
    drop_mm: float
    width_mm: float
    depth_mm: float
    lengthening: float
    converged: bool
    stitches: NDArray[np.bool_]

    @property
    def weight_g(self) -> float:
        """Mass of the piece, g."""
        return 1000.0 * self.weight_n / STANDARD_GRAVITY_M_PER_S2


def hang(
    chart: StitchChart | str,
    material: Material | str,
    *,
    linear_density_g_per_m: float,
    stitches: NDArray[np.bool_] | None = None,
    size: RelaxedSize | None = None,
    by: HungBy = HungBy.EDGE,
    time_limit_s: float = TIME_LIMIT_S,
    cancelled: Cancelled | None = None,
) -> HungPiece:
    """A piece held by its top edge, spread to its width, or by its two top corners.

    Parameters
    ----------
    chart : the whole piece, from the face side.
    linear_density_g_per_m : of the yarn.
    stitches : (rows, columns) False where the piece has none, around it or in a hole.
    size : relaxed size of the mean stitch, if known.
    by : the part that does not move: the top edge of its highest stitches, or the two ends of
        that edge.
    time_limit_s : CPU time after which the current shape is returned, not converged.

    Raises
    ------
    InputError
        If the piece is too large or in several parts, or the material lacks data or a loop length.
    ConvergenceError
        If a fabric of the material does not relax at the yarn level.
    CancelledError
        If ``cancelled`` returned True.
    """
    chart, material = as_chart(chart), as_material(material)
    check_piece(chart, stitches)
    there = np.ones_like(chart.purl) if stitches is None else stitches
    chart = continued(chart, there)
    weights = stitch_weights_n(chart, material, linear_density_g_per_m, stitches=there)
    weights *= math.sqrt(counted_over_computed(chart, material, size, there).prod())
    sheet = sheet_of(chart, material, there, size).cut(there)
    load = sheet.load_n(weights[there], axis=1)
    used = corners_of(there)
    held = np.zeros_like(used)
    top = np.flatnonzero(used.any(axis=1))[-1]
    edge = np.flatnonzero(used[top])
    held[top, edge[[0, -1]] if by is HungBy.CORNERS else edge] = True
    begin = sheet.flat_mm + shake_mm(load.shape)
    begin[held.ravel()] = sheet.flat_mm[held.ravel()]
    shape = settle(
        sheet, begin, held=held.ravel(), load_n=load, time_limit_s=time_limit_s, cancelled=cancelled
    )
    corners = shape.x.reshape(*held.shape, 3)
    width, drop, depth = np.ptp(corners[used], axis=0)
    columns = np.flatnonzero(there.any(axis=0))
    middle = columns[len(columns) // 2]
    long = [
        np.linalg.norm(np.diff(x.reshape(*held.shape, 3)[:, middle], axis=0), axis=1)
        for x in (shape.x, sheet.flat_mm)
    ]
    lengths = [each[there[:, middle]].sum() for each in long]
    return HungPiece(
        corners_mm=corners,
        weight_n=float(weights.sum()),
        drop_mm=float(drop),
        width_mm=float(width),
        depth_mm=float(depth),
        lengthening=float(lengths[0] / lengths[1]) - 1.0,
        converged=shape.converged,
        stitches=there,
    )
