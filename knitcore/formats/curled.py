"""A curled piece as a file: its corners as arrays, or its yarn as a solid."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from knitcore.arrays import Array
from knitcore.chart import StitchChart
from knitcore.formats.yarn_mesh import POINTS, export, solid, yarn_radius_mm
from knitcore.geometry.loops import loop_centre_line, loop_kinds
from knitcore.materials import Material
from knitcore.shell.curl import CurledPiece
from knitcore.shell.surface import Surface


def curled_centre_lines(
    chart: StitchChart,
    corners_mm: NDArray[np.float64],
    material: Material,
    stitches: NDArray[np.bool_] | None = None,
) -> tuple[NDArray[np.float64], ...]:
    """The yarn of every course on a curled surface, mm: (stitches * (POINTS - 1) + 1, 3).

    Parameters
    ----------
    corners_mm : (rows + 1, columns + 1, 3)
    stitches : (rows, columns) False where there are none, which cut a course into several.
    """
    shown = np.ones(chart.purl.shape, dtype=bool) if stitches is None else stitches
    surface = Surface(_continued(corners_mm, shown))
    radius, kinds = yarn_radius_mm(chart, material), loop_kinds(chart)
    lines = []
    for row in range(chart.rows):
        for columns in _runs(shown[row]):
            shapes = np.stack([loop_centre_line(int(k), POINTS) for k in kinds[row, columns]])
            shapes[..., 0] += columns[:, None] + 0.5
            shapes[..., 1] += row + 0.5
            line = np.concatenate([shapes[:, :-1].reshape(-1, 3), shapes[-1, -1:]])
            lines.append(surface.at(line[:, 0], line[:, 1], radius * line[:, 2]))
    return tuple(lines)


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


def _runs(stitches: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Columns of the stitches of a row, those side by side together."""
    columns = np.flatnonzero(stitches)
    runs = np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1)
    return [run for run in runs if len(run)]


def write_curled_glb(
    chart: StitchChart,
    corners_mm: NDArray[np.float64],
    material: Material,
    stitches: NDArray[np.bool_] | None = None,
) -> bytes:
    """Binary glTF 2.0 in metres: the loops on a curled surface, courses as closed tubes.

    Parameters are those of :func:`curled_centre_lines`.
    """
    lines = curled_centre_lines(chart, corners_mm, material, stitches)
    return export(solid(lines, yarn_radius_mm(chart, material)), 0.001, "glb")


def write_curled_npz(piece: CurledPiece) -> bytes:
    """NumPy archive: ``corners_mm`` and ``flat_mm``, (rows + 1, columns + 1, 3), and ``purl``."""
    stream = BytesIO()
    np.savez_compressed(
        stream, corners_mm=piece.corners_mm, flat_mm=piece.flat_mm, purl=piece.chart.purl
    )
    return stream.getvalue()
