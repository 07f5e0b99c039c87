"""The yarn of a chart as a solid: one closed tube a course, as glTF (metres) or STL (mm).

The cloth lies flat at rest, with the stitch size that `predict` gives. A loop has the right
topology for any neighbours: feet go behind the loops of the row below, legs pass in front, the head
passes behind the legs of the row above; a purl is the mirror image. Only its proportions are drawn,
not computed: lengths and contacts are those of the stitch cell and the yarn's diameter.
"""

from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import scipy

from knitcore.base.arrays import Array, Codes, Mask, runs
from knitcore.chart.fabric import Fabric
from knitcore.chart.in_space import corners_of
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.cloth.space.surface import Surface, filled
from knitcore.draw.laid_out import laid_corners_mm
from knitcore.draw.looped import shapes_of
from knitcore.draw.placing import placed_lines, unstretched
from knitcore.draw.tubes import TriangleMesh, resampled, tube_mesh
from knitcore.garment.piece import Piece
from knitcore.materials import Material
from knitcore.prediction.predict import predict

MAX_STITCHES = 10_000
POINTS, SIDES = 17, 6
DEFAULT_DIAMETER_SHARE = 0.3
"""Yarn diameter over stitch width if the material has no yarn diameter."""

SELF, LEFT, RIGHT, ABOVE = 1, 2, 4, 8
"""Bits of a kind of loop; a bit is set if that stitch is a purl."""

_NECK = 0.17
"""Lean of the legs, out at the head and in at the neck, in stitch widths (0: a cosine)."""
_REACH = 0.78
"""Half the height of a loop in row heights: loops reach through those of the row below."""
_KNOTS = np.array([0.0, 0.08, 0.21, 0.29, 0.42, 0.5])
"""Foot centre, foot end, lower leg, upper leg, head end, head centre; fractions of a stitch."""


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
        for start, stop, is_shown in runs(shown[row]):
            if not is_shown:
                continue
            shapes = np.stack([loop_centre_line(int(k), POINTS) for k in kinds[row, start:stop]])
            shapes[..., 0] += np.arange(start, stop)[:, None] + 0.5
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


def looped_mesh(chart: SymbolChart, material: Material) -> TriangleMesh:
    """All rows of a chart of any stitches as closed tubes in mm, as they are knitted.

    Raises
    ------
    InputError
        As :func:`yarn_mesh`.
    """
    check_stitches(chart.rows * chart.columns, MAX_STITCHES)
    shapes = shapes_of(chart, material)
    shapes = replace(shapes, lines=resampled(shapes.lines, 2 * POINTS))
    rows = placed_lines(shapes, unstretched(shapes))
    lines = (np.append(row[:, :-1].reshape(-1, 3), row[-1, -1:], axis=0) for row in rows)
    return solid(lines, shapes.yarn_radius_mm)


def solid(lines: Iterable[Array], radius_mm: float) -> TriangleMesh:
    """Closed tubes around centre lines, mm."""
    tubes = [_closed(tube_mesh(line, radius_mm, SIDES)) for line in lines]
    offsets = np.cumsum([0, *(len(t.vertices) for t in tubes[:-1])])
    return TriangleMesh(
        np.concatenate([t.vertices for t in tubes]),
        np.concatenate([t.faces + np.uint32(o) for t, o in zip(tubes, offsets, strict=True)]),
    )


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


def loop_kinds(chart: StitchChart) -> Codes:
    """Kind of loop of each stitch, 0 to 15, shape (rows, columns).

    The stitch itself, its left and right neighbours and the one above decide how the yarn runs; at
    an edge the stitch itself stands in for the missing neighbour.
    """
    purl = chart.purl.astype(np.uint8)
    wide, high = np.pad(purl, ((0, 0), (1, 1)), "edge"), np.pad(purl, ((0, 1), (0, 0)), "edge")
    kinds: Codes = purl * SELF | wide[:, :-2] * LEFT | wide[:, 2:] * RIGHT | high[1:] * ABOVE
    return kinds


@lru_cache(maxsize=256)
def loop_centre_line(kind: int, points: int = 48) -> Array:
    """Centre line of one kind of loop, shape (points, 3).

    x and y are in units of stitch width and row height, from the centre of the cell, z in units of
    the yarn's radius, positive towards the face. It begins and ends on the cell's left and right
    edges, where it meets the neighbours' loops. The array is cached and read-only.
    """
    u = np.linspace(0.0, 1.0, points)
    side, left, right, above = (1.0 - 2.0 * bool(kind & bit) for bit in (SELF, LEFT, RIGHT, ABOVE))
    x = u - 0.5 + _NECK * np.sin(4 * np.pi * u)
    y = -_REACH * np.cos(2 * np.pi * u)
    half_left = scipy.interpolate.PchipInterpolator(
        _KNOTS, [(side + left) / 2, side, -side, -above, above, above]
    )
    half_right = scipy.interpolate.PchipInterpolator(
        _KNOTS, [(side + right) / 2, side, -side, -above, above, above]
    )
    z = np.where(u <= 0.5, half_left(np.minimum(u, 0.5)), half_right(np.minimum(1 - u, 0.5)))
    line = np.stack([x, y, -z], axis=1)
    line.setflags(write=False)
    return line
