"""The yarn of a chart as a solid: one closed tube a course, as glTF (metres) or STL (mm).

The loops are drawn; the cloth lies flat at rest, with the stitch size that `predict` gives.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from knitcore.base.arrays import Array, Indices, Mask
from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.cloth.space.surface import Surface, corners_of, filled
from knitcore.draw.laid_out import laid_corners_mm
from knitcore.draw.loops import loop_centre_line, loop_kinds
from knitcore.draw.tubes import TriangleMesh, tube_mesh
from knitcore.garment.piece import Piece
from knitcore.materials import Material
from knitcore.prediction.predict import predict

MAX_STITCHES = 10_000
POINTS, SIDES = 17, 6
DEFAULT_DIAMETER_SHARE = 0.3
"""Yarn diameter over stitch width if the material has no yarn diameter."""


def course_centre_lines(
    chart: StitchChart, corners_mm: Array, material: Material, stitches: Mask | None = None
) -> tuple[Array, ...]:
    """The yarn of every course on a surface, mm: (stitches * (POINTS - 1) + 1, 3).

    Parameters
    ----------
    corners_mm : (rows + 1, columns + 1, 3)
    stitches : (rows, columns) False where there are none, which cut a course into several.
    """
    shown = np.ones(chart.purl.shape, dtype=bool) if stitches is None else stitches
    surface = Surface(corners_mm)
    radius, kinds = yarn_radius_mm(chart, material), loop_kinds(chart)
    lines: list[Array] = []
    for row in range(chart.rows):
        for columns in _runs(shown[row]):
            shapes = np.stack([loop_centre_line(int(k), POINTS) for k in kinds[row, columns]])
            shapes[..., 0] += columns[:, None] + 0.5
            shapes[..., 1] += row + 0.5
            line = np.concatenate([shapes[:, :-1].reshape(-1, 3), shapes[-1, -1:]])
            lines.append(surface.at(line[:, 0], line[:, 1], radius * line[:, 2]))
    return tuple(lines)


def yarn_radius_mm(chart: StitchChart, material: Material) -> float:
    """Half the diameter of the yarn, measured if the material has it."""
    diameters = [material.yarn_diameter_mm(fabric) for fabric in Fabric]
    known = [d for d in diameters if d is not None]
    if known:
        return 0.5 * float(np.mean(known))
    return 0.5 * DEFAULT_DIAMETER_SHARE * predict(chart, material).relaxed_course_mm


def yarn_mesh(chart: StitchChart | Piece, material: Material) -> TriangleMesh:
    """All courses as closed tubes in mm.

    Raises
    ------
    InputError
        If there are too many stitches for a mesh of use.
    """
    piece = Piece.of(chart)
    check_stitches(piece.chart.stitches, MAX_STITCHES)
    shown, grid = piece.shaped.stitch, piece.shaped.continued()
    laid = laid_corners_mm(piece.shaped, material, piece.gauge)
    corners = np.pad(laid, ((0, 0), (0, 0), (0, 1)))
    lines = course_centre_lines(grid, corners, material, shown)
    return solid(lines, yarn_radius_mm(grid, material))


def solid(lines: Iterable[Array], radius_mm: float) -> TriangleMesh:
    """Closed tubes around centre lines, mm."""
    tubes = [_closed(tube_mesh(line, radius_mm, SIDES)) for line in lines]
    offsets = np.cumsum([0, *(len(t.vertices) for t in tubes[:-1])])
    return TriangleMesh(
        np.concatenate([t.vertices for t in tubes]),
        np.concatenate([t.faces + np.uint32(o) for t, o in zip(tubes, offsets, strict=True)]),
    )


def write_glb(chart: StitchChart | Piece, material: Material) -> bytes:
    """Binary glTF 2.0 in metres."""
    return mesh_file(yarn_mesh(chart, material), 0.001, "glb")


def write_stl(chart: StitchChart | Piece, material: Material) -> bytes:
    """Binary STL in mm."""
    return mesh_file(yarn_mesh(chart, material), 1.0, "stl")


def write_curled_glb(
    chart: StitchChart, corners_mm: Array, material: Material, stitches: Mask | None = None
) -> bytes:
    """Binary glTF 2.0 in metres: the loops on a curled surface, courses as closed tubes.

    Parameters are those of :func:`course_centre_lines`.
    """
    corners = corners_mm if stitches is None else filled(corners_mm, corners_of(stitches))
    lines = course_centre_lines(chart, corners, material, stitches)
    return mesh_file(solid(lines, yarn_radius_mm(chart, material)), 0.001, "glb")


def mesh_file(mesh: TriangleMesh, scale: float, kind: str) -> bytes:
    """A file of a kind that trimesh writes (``glb``, ``stl``)."""
    import trimesh

    solid: Any = trimesh.Trimesh(mesh.vertices * scale, mesh.faces, process=False)
    content = solid.export(file_type=kind)
    return bytes(content)


def _closed(mesh: TriangleMesh) -> TriangleMesh:
    """The tube with a fan over each end."""
    last = len(mesh.vertices) - SIDES
    ring = np.arange(1, SIDES - 1)
    zero = np.zeros_like(ring)
    start = np.stack([zero, ring + 1, ring], axis=-1)
    end = last + np.stack([zero, ring, ring + 1], axis=-1)
    faces = np.concatenate([mesh.faces, start, end]).astype(np.uint32)
    return TriangleMesh(mesh.vertices, faces)


def _runs(stitches: Mask) -> list[Indices]:
    """Columns of the stitches of a row, those side by side together."""
    columns = np.flatnonzero(stitches)
    runs = np.split(columns, np.flatnonzero(np.diff(columns) > 1) + 1)
    return [run for run in runs if len(run)]
