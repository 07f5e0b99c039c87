"""Tubes around centre lines, as triangle meshes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.errors import InputError
from knitcore.base.kinds import as_numbers


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices in mm, shape (V, 3), and outward-facing triangles, shape (F, 3)."""

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]


def tube_mesh(centre_line: Array, radius_mm: float, sides: int = 8) -> TriangleMesh:
    """A tube of constant radius around one line, open at both ends.

    Parameters
    ----------
    centre_line : (points, 3) in mm, at least two distinct points.
    radius_mm : the yarn's radius.
    sides : corners of the cross-section.

    Raises
    ------
    InputError
        If there are too few points or sides, or the radius is not positive.
    """
    remedy = "Give at least two points of three coordinates, in mm."
    line = as_numbers("centre_line", centre_line, remedy)
    if line.ndim != 2 or line.shape[0] < 2 or line.shape[1] != 3:
        raise InputError("centre_line", "is not a line in space.", remedy)
    return TriangleMesh(
        tube_vertices(line[None], radius_mm, sides)[0], tube_faces(len(line), sides)
    )


def tube_vertices(centre_lines: Array, radius_mm: float, sides: int = 8) -> NDArray[np.float32]:
    """Vertices of tubes around many lines of equally many points, (lines, points * sides, 3).

    The cross-sections are carried along a line without twist, and turned a little on the way so
    that they begin and end with a corner towards +y and successive tubes meet corner to corner.

    Parameters
    ----------
    centre_lines : (lines, points, 3) in mm.
    radius_mm : the yarn's radius.
    sides : corners of the cross-section.

    Raises
    ------
    InputError
        If there are too few sides, or the radius is not positive.
    """
    if radius_mm <= 0 or sides < 3:
        raise InputError("tube", "has no body.", "Use a radius above 0 mm and at least 3 sides.")
    lines = np.asarray(centre_lines, dtype=float)
    tangent = np.gradient(lines, axis=1)
    tangent /= np.linalg.norm(tangent, axis=2, keepdims=True)
    normal = _carried_normals(tangent)
    binormal = np.cross(tangent, normal)
    last = _upward(tangent[:, -1])
    twist = np.arctan2(_dot(last, binormal[:, -1]), _dot(last, normal[:, -1]))
    along = np.linspace(0.0, 1.0, lines.shape[1])
    angle = 2 * np.pi * np.arange(sides) / sides + (twist[:, None] * along)[..., None]
    ring = (
        np.cos(angle)[..., None] * normal[:, :, None]
        + np.sin(angle)[..., None] * binormal[:, :, None]
    )
    around = lines[:, :, None] + radius_mm * ring
    size = (len(lines), lines.shape[1] * sides, 3)
    vertices: NDArray[np.float32] = around.reshape(size).astype(np.float32)
    return vertices


def tube_faces(points: int, sides: int) -> NDArray[np.uint32]:
    """Outward-facing triangles of a tube, (2 * (points - 1) * sides, 3)."""
    here = np.arange(points - 1)[:, None] * sides + np.arange(sides)[None, :]
    beside = np.arange(points - 1)[:, None] * sides + (np.arange(sides)[None, :] + 1) % sides
    faces = np.concatenate(
        [
            np.stack([here, beside, here + sides], axis=-1).reshape(-1, 3),
            np.stack([beside, beside + sides, here + sides], axis=-1).reshape(-1, 3),
        ]
    )
    return faces.astype(np.uint32)


def resampled(lines: Array, points: int) -> Array:
    """Give lines (n, P, …) another number of points, and keep their ends."""
    place = np.linspace(0.0, lines.shape[1] - 1, points)
    before = np.minimum(place.astype(int), lines.shape[1] - 2)
    share = (place - before)[:, None]
    between: Array = lines[:, before] * (1.0 - share) + lines[:, before + 1] * share
    return between


def _carried_normals(tangent: Array) -> Array:
    """Unit normals carried from point to point by the smallest rotation of the tangent."""
    normals = np.empty_like(tangent)
    normal = _upward(tangent[:, 0])
    for point in range(tangent.shape[1]):
        direction = tangent[:, point]
        normal = normal - direction * _dot(normal, direction)[:, None]
        normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
        normals[:, point] = normal
    return normals


def _upward(tangent: Array) -> Array:
    """The unit normal nearest to +y; nearest to +x for a line along y."""
    steep = np.abs(tangent[:, 1]) > 0.95
    helper = np.where(steep[:, None], (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    normal = helper - tangent * _dot(helper, tangent)[:, None]
    unit: Array = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return unit


def _dot(a: Array, b: Array) -> Array:
    product: Array = np.einsum("ij,ij->i", a, b)
    return product
