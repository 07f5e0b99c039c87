"""Tubes around centre lines, as triangle meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.errors import InputError


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """Vertices in mm, shape (V, 3), and outward-facing triangles, shape (F, 3)."""

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]


def tube(centre_line: NDArray[np.float64], radius_mm: float, sides: int = 8) -> TriangleMesh:
    """A tube of constant radius, open at both ends.

    Frames are carried along the line by parallel transport, so the tube does not twist.

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
    line = np.asarray(centre_line, dtype=float)
    if line.ndim != 2 or line.shape[0] < 2 or line.shape[1] != 3:
        raise InputError("centre_line", "is no line in space.", "Give an array (points >= 2, 3).")
    if radius_mm <= 0 or sides < 3:
        raise InputError("tube", "has no body.", "Use a radius above 0 mm and at least 3 sides.")
    tangent = np.gradient(line, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = _transported_normals(tangent)
    binormal = np.cross(tangent, normal)
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = (
        np.cos(angle)[None, :, None] * normal[:, None, :]
        + np.sin(angle)[None, :, None] * binormal[:, None, :]
    )
    vertices = (line[:, None, :] + radius_mm * ring).reshape(-1, 3)

    here = np.arange(len(line) - 1)[:, None] * sides + np.arange(sides)[None, :]
    beside = np.arange(len(line) - 1)[:, None] * sides + (np.arange(sides)[None, :] + 1) % sides
    faces = np.concatenate(
        [
            np.stack([here, beside, here + sides], axis=-1).reshape(-1, 3),
            np.stack([beside, beside + sides, here + sides], axis=-1).reshape(-1, 3),
        ]
    )
    return TriangleMesh(vertices.astype(np.float32), faces.astype(np.uint32))


def _transported_normals(tangent: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit normals carried from point to point by the smallest rotation of the tangent."""
    normals = np.empty_like(tangent)
    helper = np.eye(3)[np.argmin(np.abs(tangent[0]))]
    normal = np.cross(tangent[0], helper)
    for index, direction in enumerate(tangent):
        normal = normal - direction * (normal @ direction)
        normal = normal / np.linalg.norm(normal)
        normals[index] = normal
    return normals
