"""A curled piece as a file: its corners as arrays, or its yarn as a solid."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.formats.yarn_mesh import course_centre_lines, mesh_file, solid, yarn_radius_mm
from knitcore.materials import Material
from knitcore.shell.curl import CurledPiece


def write_curled_glb(
    chart: StitchChart,
    corners_mm: NDArray[np.float64],
    material: Material,
    stitches: NDArray[np.bool_] | None = None,
) -> bytes:
    """Binary glTF 2.0 in metres: the loops on a curled surface, courses as closed tubes.

    Parameters are those of :func:`~knitcore.formats.yarn_mesh.course_centre_lines`.
    """
    corners = corners_mm if stitches is None else _continued(corners_mm, stitches)
    lines = course_centre_lines(chart, corners, material, stitches)
    return mesh_file(solid(lines, yarn_radius_mm(chart, material)), 0.001, "glb")


def write_curled_npz(piece: CurledPiece) -> bytes:
    """NumPy archive: ``corners_mm`` and ``flat_mm``, (rows + 1, columns + 1, 3), and ``purl``."""
    stream = BytesIO()
    np.savez_compressed(
        stream, corners_mm=piece.corners_mm, flat_mm=piece.flat_mm, purl=piece.chart.purl
    )
    return stream.getvalue()


def _continued(corners_mm: NDArray[np.float64], stitches: NDArray[np.bool_]) -> Array:
    """Corners that no stitch has, in the line of those beside them."""
    found, around = corners_mm.copy(), np.pad(stitches, 1)
    used = around[1:, 1:] | around[1:, :-1] | around[:-1, 1:] | around[:-1, :-1]
    for line, there in zip(found, used, strict=True):
        first, *_, last = np.flatnonzero(there)
        right, left = np.arange(last, len(line)), np.arange(first + 1)
        slopes = line[last] - line[last - 1], line[first + 1] - line[first]
        line[right] = line[last] + np.outer(right - last, slopes[0])
        line[left] = line[first] + np.outer(left - first, slopes[1])
    return found
