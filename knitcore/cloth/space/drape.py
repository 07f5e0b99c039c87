"""The drape coefficient: a round piece of cloth that hangs over a smaller disc.

Cusick, "The dependence of fabric drape on bending and shear stiffness", J. Text. Inst. 56 (1965)
T596: the share of the ring outside the disc that its shadow covers, 1 for a stiff board.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.signal import find_peaks

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import Cancelled, InputError
from knitcore.cloth.space.even_cloth import EvenCloth
from knitcore.cloth.space.sheet_shape import Shape, settle, shake_mm
from knitcore.cloth.space.stitch_sheet import StitchSheet

PIECE_MM, DISC_MM = 300.0, 180.0
"""Diameters of the standard test."""
ACROSS = 60
"""Rectangles across the piece."""
MAX_ACROSS = 80
STARTS = (5, 6, 7)
"""Waves of the rim with which the descents begin: draped cloth has several states of rest."""
_WAVE = 0.2
"""Height of these waves over the distance from the disc."""
_SHAKEN_MM = 0.01


@dataclass(frozen=True, eq=False)
class Drape:
    """A draped piece: the state of least energy of those found; z up.

    Parameters
    ----------
    coefficient : shadow of the ring over its area.
    coefficients : of all states of rest, one for each start.
    folds : number of folds around the rim.
    fall_mm : from the disc to the lowest point.
    corners_mm : (lines up, lines across, 3) of the rectangles; NaN outside the piece.
    converged : whether all descents came to rest.
    """

    coefficient: float
    coefficients: tuple[float, ...]
    folds: int
    fall_mm: float
    corners_mm: Array
    converged: bool


def drape(
    cloth: EvenCloth,
    *,
    piece_mm: float = PIECE_MM,
    disc_mm: float = DISC_MM,
    across: int = ACROSS,
    starts: tuple[int, ...] = STARTS,
    time_limit_s: float = 120.0,
    cancelled: Cancelled | None = None,
) -> Drape:
    """A round piece held between two discs, its rim free.

    Parameters
    ----------
    cloth : taken as flat at rest.
    piece_mm, disc_mm : diameters.
    across : rectangles across the piece.
    starts : numbers of waves of the rim with which the descents begin.
    time_limit_s : CPU time of all descents.

    Raises
    ------
    InputError
        If the piece is not larger than the disc, or the rectangles are too many or too few.
    CancelledError
        If ``cancelled`` returned True.
    """
    if not 0.0 < disc_mm < 0.95 * piece_mm:
        raise InputError("disc_mm", f"{disc_mm:g} mm is too large.", "Give less than the piece.")
    check_range("across", across, 10, MAX_ACROSS)
    sheet, held = _round(cloth, piece_mm, disc_mm, across)
    load = np.zeros_like(sheet.flat_mm)
    load[:, 2] = -sheet.shared(np.full(len(sheet.quads), cloth.weight_n_per_mm2 * _area(sheet)))
    shapes = [
        settle(
            sheet.clamped(held), _waved(sheet, held, waves), held=held, load_n=load,
            time_limit_s=time_limit_s / len(starts), cancelled=cancelled,
        )
        for waves in starts
    ]  # fmt: skip
    covered = [_coefficient(sheet, shape.x, disc_mm) for shape in shapes]
    best = int(np.argmin([shape.energy_n_mm for shape in shapes]))
    corners = np.where(sheet.used[:, None], shapes[best].x, np.nan)
    return Drape(
        coefficient=covered[best],
        coefficients=tuple(covered),
        folds=_folds(sheet, shapes[best], 0.5 * (piece_mm - disc_mm)),
        fall_mm=float(-shapes[best].x[:, 2].min()),
        corners_mm=corners.reshape(across + 1, across + 1, 3),
        converged=all(shape.converged for shape in shapes),
    )


def _round(
    cloth: EvenCloth, piece_mm: float, disc_mm: float, across: int
) -> tuple[StitchSheet, NDArray[np.bool_]]:
    """The round piece, and a mask of its corners in the clamp."""
    size = piece_mm / across
    whole = cloth.flat().sheet(across, across, (size, size))
    middle = whole.flat_mm[whole.quads].mean(axis=1)
    inside = np.linalg.norm(middle, axis=1) <= 0.5 * piece_mm
    sheet = whole.cut(inside.reshape(across, across))
    radius = np.linalg.norm(sheet.flat_mm, axis=1)
    reach = np.sort(radius[sheet.quads].max(axis=1))
    clamped = round(0.25 * math.pi * disc_mm**2 / size**2)  # rectangles as large as the disc
    return sheet, radius <= reach[clamped - 1]


def _waved(sheet: StitchSheet, held: NDArray[np.bool_], waves: int) -> Array:
    x = sheet.flat_mm.copy()
    out = np.linalg.norm(x, axis=1) - np.linalg.norm(x[held], axis=1).max()
    wave = _WAVE * out * np.cos(waves * np.arctan2(x[:, 1], x[:, 0]))
    noise = shake_mm((len(x),), _SHAKEN_MM)
    x[~held, 2] += (wave + noise)[~held]
    return x


def _area(sheet: StitchSheet) -> float:
    return float(sheet.membrane[0, :2].prod())


def _coefficient(sheet: StitchSheet, x: Array, disc_mm: float) -> float:
    disc = 0.25 * math.pi * disc_mm**2
    ring = len(sheet.quads) * _area(sheet) - disc
    return (_shadow(x[:, :2], sheet.quads) - disc) / ring


def _shadow(at: Array, quads: NDArray[np.int64]) -> float:
    """Area that rectangles cover, seen from above, each as two triangles."""
    triangles = np.concatenate([at[quads[:, [0, 1, 3, 0]]], at[quads[:, [0, 3, 2, 0]]]])
    shapes = shapely.polygons(triangles)
    solid = shapes[shapely.area(shapes) > 1e-9]
    return float(shapely.union_all(solid, grid_size=1e-4).area)


def _folds(sheet: StitchSheet, shape: Shape, ring_mm: float) -> int:
    """Crests around the rim, at least a tenth as high as the ring is wide."""
    rim = np.linalg.norm(sheet.flat_mm, axis=1) >= 0.92 * sheet.flat_mm[:, 0].max()
    rim &= sheet.used
    angle = np.arctan2(sheet.flat_mm[rim, 1], sheet.flat_mm[rim, 0])
    grid = np.linspace(-np.pi, np.pi, 144, endpoint=False)
    order = np.argsort(angle)
    height = np.interp(grid, angle[order], shape.x[rim, 2][order], period=2.0 * np.pi)
    smooth = np.convolve(np.tile(height, 3), np.full(5, 0.2), mode="same")
    crests, _ = find_peaks(smooth, prominence=0.1 * ring_mm)
    return int(np.count_nonzero((crests >= 144) & (crests < 288)))
