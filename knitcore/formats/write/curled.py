"""A curled piece as a file: its corners as arrays, or its yarn as a solid."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.curl import CurledPiece
from knitcore.cloth.space.surface import corners_of, filled
from knitcore.formats.write.yarn_mesh import course_centre_lines, mesh_file, solid, yarn_radius_mm
from knitcore.materials import Material


def write_curled_glb(
    chart: StitchChart,
    corners_mm: NDArray[np.float64],
    material: Material,
    stitches: NDArray[np.bool_] | None = None,
) -> bytes:
    """Binary glTF 2.0 in metres: the loops on a curled surface, courses as closed tubes.

    Parameters are those of :func:`~knitcore.formats.write.yarn_mesh.course_centre_lines`.
    """
    corners = corners_mm if stitches is None else filled(corners_mm, corners_of(stitches))
    lines = course_centre_lines(chart, corners, material, stitches)
    return mesh_file(solid(lines, yarn_radius_mm(chart, material)), 0.001, "glb")


def write_curled_npz(piece: CurledPiece) -> bytes:
    """NumPy archive of :meth:`~knitcore.cloth.space.curl.CurledPiece.arrays`."""
    stream = BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **piece.arrays())
    return stream.getvalue()
