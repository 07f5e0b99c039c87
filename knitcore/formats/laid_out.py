"""A piece as files show it: laid flat at rest, with the stitch size that `predict` gives."""

from __future__ import annotations

import numpy as np

from knitcore.answer.choose import choose
from knitcore.arrays import Array
from knitcore.fabric import Direction
from knitcore.garment.piece import Piece
from knitcore.geometry.lattice import resting_lattice
from knitcore.materials import Material


def mean_stitch_mm(piece: Piece, material: Material) -> Array:
    """Width and height at rest, (2,): the answer's, or of a piece with an outline its lattice's.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    if piece.is_rectangle:
        answer = choose(piece.chart, material)
        return np.array([answer.along(direction).relaxed_mm for direction in Direction])
    lattice = resting_lattice(piece.shaped.continued(), material)
    return np.asarray(lattice.sizes_mm[piece.shaped.stitch].mean(axis=0))


def laid_corners_mm(piece: Piece, material: Material) -> Array:
    """Corners of all cells in the plane, (rows + 1, columns + 1, 2), the lowest x and y at 0.

    They are those of the resting lattice, to the scale of :func:`mean_stitch_mm`.

    Raises
    ------
    InputError
        If the material lacks a pure fabric that the chart needs.
    """
    lattice = resting_lattice(piece.shaped.continued(), material)
    drawn = lattice.sizes_mm[piece.shaped.stitch].mean(axis=0)
    corners = lattice.corners_mm * (mean_stitch_mm(piece, material) / drawn)
    return np.asarray(corners - corners.min(axis=(0, 1)))
