"""A curled piece as a file: its corners as arrays, or its yarn as a solid."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.formats.yarn_mesh import POINTS, export, solid, yarn_radius_mm
from knitcore.geometry.loops import loop_centre_line, loop_kinds
from knitcore.geometry.tubes import TriangleMesh
from knitcore.materials import Material
from knitcore.shell.curl import CurledPiece
from knitcore.shell.surface import Surface


def curled_centre_lines(
    chart: StitchChart, corners_mm: NDArray[np.float64], material: Material
) -> tuple[NDArray[np.float64], ...]:
    """The yarn of every course on a curled surface, mm: (stitches * (POINTS - 1) + 1, 3)."""
    surface = Surface(corners_mm)
    radius, kinds = yarn_radius_mm(chart, material), loop_kinds(chart)
    lines = []
    for row in range(chart.rows):
        shapes = np.stack([loop_centre_line(int(kind), POINTS) for kind in kinds[row]])
        shapes[..., 0] += np.arange(chart.columns)[:, None] + 0.5
        shapes[..., 1] += row + 0.5
        line = np.concatenate([shapes[:, :-1].reshape(-1, 3), shapes[-1, -1:]])
        lines.append(surface.at(line[:, 0], line[:, 1], radius * line[:, 2]))
    return tuple(lines)


def curled_mesh(
    chart: StitchChart, corners_mm: NDArray[np.float64], material: Material
) -> TriangleMesh:
    """All courses as closed tubes, mm."""
    lines = curled_centre_lines(chart, corners_mm, material)
    return solid(lines, yarn_radius_mm(chart, material))


def write_curled_glb(
    chart: StitchChart, corners_mm: NDArray[np.float64], material: Material
) -> bytes:
    """Binary glTF 2.0 in metres: the loops on a curled surface, (rows + 1, columns + 1, 3)."""
    return export(curled_mesh(chart, corners_mm, material), 0.001, "glb")


def write_curled_npz(piece: CurledPiece) -> bytes:
    """NumPy archive: ``corners_mm`` and ``flat_mm``, (rows + 1, columns + 1, 3), and ``purl``."""
    stream = BytesIO()
    np.savez_compressed(
        stream, corners_mm=piece.corners_mm, flat_mm=piece.flat_mm, purl=piece.chart.purl
    )
    return stream.getvalue()
