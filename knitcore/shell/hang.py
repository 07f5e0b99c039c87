"""A piece that hangs under its own weight."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.choice import Choice
from knitcore.errors import Cancelled
from knitcore.materials import Material
from knitcore.shell.cloth import stitch_weights_n
from knitcore.shell.curl import TIME_LIMIT_S, check_piece
from knitcore.shell.relax import settle, shake_mm
from knitcore.shell.sheet import sheet_of


class HungBy(Choice):
    """What holds a hanging piece."""

    EDGE = "edge"
    CORNERS = "corners"


@dataclass(frozen=True, eq=False)
class HungPiece:
    """A hanging piece at rest: x along the rows, y up, z towards the face.

    Parameters
    ----------
    corners_mm : (rows + 1, columns + 1, 3), corners of the stitches, the lowest row first.
    weight_n : of the piece.
    drop_mm : from the highest corner to the lowest.
    width_mm, depth_mm : extent of the piece.
    lengthening : of the middle column, over its length at rest in the flat sheet.
    converged : whether every corner is in equilibrium.
    """

    corners_mm: Array
    weight_n: float
    drop_mm: float
    width_mm: float
    depth_mm: float
    lengthening: float
    converged: bool


def hang(
    chart: StitchChart,
    material: Material,
    *,
    linear_density_g_per_m: float,
    by: HungBy = HungBy.EDGE,
    time_limit_s: float = TIME_LIMIT_S,
    cancelled: Cancelled | None = None,
) -> HungPiece:
    """A piece held by its top edge, spread to its width, or by its two top corners.

    Parameters
    ----------
    chart : the whole piece, from the face side.
    linear_density_g_per_m : of the yarn.
    by : the whole top edge does not move, or its two corners.
    time_limit_s : CPU time after which the current shape is returned, not converged.

    Raises
    ------
    InputError
        If the piece is too large, or the material lacks data or a loop length.
    ConvergenceError
        If a fabric of the material does not relax at the yarn level.
    CancelledError
        If ``cancelled`` says so.
    """
    check_piece(chart)
    weights = stitch_weights_n(chart, material, linear_density_g_per_m)
    sheet = sheet_of(chart, material)
    load = np.zeros_like(sheet.flat_mm)
    load[:, 1] = -sheet.shared(weights.ravel())
    held = np.zeros((chart.rows + 1, chart.columns + 1), dtype=bool)
    held[-1, :: chart.columns if by is HungBy.CORNERS else 1] = True
    begin = sheet.flat_mm + shake_mm(load.shape)
    begin[held.ravel()] = sheet.flat_mm[held.ravel()]
    found = settle(
        sheet, begin, held=held.ravel(), load_n=load, time_limit_s=time_limit_s, cancelled=cancelled
    )
    corners = found.x.reshape(*held.shape, 3)
    width, drop, depth = np.ptp(corners, axis=(0, 1))
    middle = [
        _length(x.reshape(*held.shape, 3)[:, chart.columns // 2]) for x in (found.x, sheet.flat_mm)
    ]
    return HungPiece(
        corners_mm=corners,
        weight_n=float(weights.sum()),
        drop_mm=float(drop),
        width_mm=float(width),
        depth_mm=float(depth),
        lengthening=middle[0] / middle[1] - 1.0,
        converged=found.converged,
    )


def _length(line: Array) -> float:
    return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
