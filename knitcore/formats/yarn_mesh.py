"""The yarn of a chart as a solid: one closed tube a course, as glTF (metres) or STL (mm).

The geometry is that of a drawing, laid flat with the material's stitch sizes, not an equilibrium.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart, check_stitches
from knitcore.fabric import Fabric
from knitcore.garment.piece import Piece
from knitcore.geometry.lattice import flat_lattice
from knitcore.geometry.loops import loop_centre_line, loop_kinds
from knitcore.geometry.tubes import TriangleMesh, tube
from knitcore.materials import Material

MAX_STITCHES = 10_000
POINTS, SIDES = 17, 6
DEFAULT_DIAMETER_SHARE = 0.3
"""Yarn diameter over stitch width if the material has no yarn diameter."""


def course_centre_lines(
    chart: StitchChart | Piece, material: Material
) -> tuple[NDArray[np.float64], ...]:
    """The yarn of every course in mm, arrays (stitches * (POINTS - 1) + 1, 3)."""
    spans = (
        [(0, chart.columns)] * chart.rows if isinstance(chart, StitchChart) else chart.shaped.spans
    )
    chart = chart if isinstance(chart, StitchChart) else chart.shaped.continued()
    lattice, kinds = flat_lattice(chart, material), loop_kinds(chart)
    radius = yarn_radius_mm(chart, material)
    shapes = {int(kind): loop_centre_line(int(kind), POINTS) for kind in np.unique(kinds)}
    lines = []
    for row in range(chart.rows):
        parts = []
        for column in range(*spans[row]):
            scale = np.array([*lattice.sizes_mm[row, column], radius])
            offset = np.array([*lattice.centres_mm[row, column], 0.0])
            parts.append(shapes[int(kinds[row, column])] * scale + offset)
        joined = [part[:-1] for part in parts[:-1]] + [parts[-1]]
        lines.append(np.concatenate(joined))
    return tuple(lines)


def yarn_radius_mm(chart: StitchChart, material: Material) -> float:
    """Half the diameter of the yarn, measured if the material has it."""
    diameters = [material.yarn_diameter_mm(fabric) for fabric in Fabric]
    known = [d for d in diameters if d is not None]
    if known:
        return 0.5 * float(np.mean(known))
    widths = flat_lattice(chart, material).sizes_mm[..., 0]
    return 0.5 * DEFAULT_DIAMETER_SHARE * float(widths.mean())


def yarn_mesh(chart: StitchChart | Piece, material: Material) -> TriangleMesh:
    """All courses as closed tubes in mm.

    Raises
    ------
    InputError
        If there are too many stitches for a mesh of use.
    """
    grid = chart if isinstance(chart, StitchChart) else chart.shaped.continued()
    check_stitches(grid.stitches, MAX_STITCHES)
    return solid(course_centre_lines(chart, material), yarn_radius_mm(grid, material))


def solid(lines: Iterable[NDArray[np.float64]], radius_mm: float) -> TriangleMesh:
    """Closed tubes around centre lines, mm."""
    tubes = [_closed(tube(line, radius_mm, SIDES)) for line in lines]
    offsets = np.cumsum([0, *(len(t.vertices) for t in tubes[:-1])])
    return TriangleMesh(
        np.concatenate([t.vertices for t in tubes]),
        np.concatenate([t.faces + np.uint32(o) for t, o in zip(tubes, offsets, strict=True)]),
    )


def write_glb(chart: StitchChart | Piece, material: Material) -> bytes:
    """Binary glTF 2.0 in metres."""
    return export(yarn_mesh(chart, material), 0.001, "glb")


def write_stl(chart: StitchChart | Piece, material: Material) -> bytes:
    """Binary STL in mm."""
    return export(yarn_mesh(chart, material), 1.0, "stl")


def export(mesh: TriangleMesh, scale: float, kind: str) -> bytes:
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
