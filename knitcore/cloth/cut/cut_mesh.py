"""Meshes of cut pieces: quadrilaterals for upright rectangles, triangles for everything else.

Points lie evenly along the boundary and on a triangular lattice inside; their Delaunay
triangulation is cut along the outline. Where it leaves a side out, that side is halved and the
triangulation is made again, so that every side is made of edges of triangles.
"""

import math
from typing import Any

import numpy as np
import scipy
import shapely
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_positive
from knitcore.base.errors import InputError
from knitcore.cloth.cut.outline import CutPiece

Indices = NDArray[np.int64]

MAX_ELEMENTS = 20_000
DEFAULT_ELEMENTS = 600
"""Number of elements at which the default mesh size aims."""
MAX_EMPTY = 20
"""Largest ratio of the bounding box to the area of a piece for which elements keep their size."""
CLEARANCE = 0.55
"""Smallest distance of inner points from the boundary, over the mesh size."""
MAX_SPLITS = 12
SMOOTHINGS = 3


def mesh_of(piece: CutPiece, size_mm: float | None = None) -> Any:
    """A scikit-fem mesh (``MeshQuad`` or ``MeshTri``) whose boundaries are the named edges.

    Parameters
    ----------
    piece : the piece.
    size_mm : length of an element's side, about; by default such that there are some hundred.

    Raises
    ------
    InputError
        If the mesh would be too large, or the outline is too intricate for it.
    """
    from skfem import MeshQuad, MeshTri

    size = size_for(piece, DEFAULT_ELEMENTS) if size_mm is None else size_mm
    check_positive("mesh_mm", size, "mm", "a size")
    least = size_for(piece, MAX_ELEMENTS)
    if size < least:
        raise InputError(
            "mesh_mm", f"{size:.3g} mm is too fine for this piece.", f"Use at least {least:.3g} mm."
        )
    if piece.is_upright_rectangle:
        left, bottom, right, top = piece.polygon.bounds
        columns, rows = (max(2, round(d / size)) for d in (right - left, top - bottom))
        mesh = MeshQuad.init_tensor(
            np.linspace(left, right, columns + 1), np.linspace(bottom, top, rows + 1)
        )
    else:
        points, triangles = triangulation(piece, size)
        mesh = MeshTri(np.ascontiguousarray(points.T), np.ascontiguousarray(triangles.T))
    facets = mesh.boundary_facets()
    middles = mesh.p[:, mesh.facets[:, facets]].mean(axis=1).T
    side = shapely.STRtree(shapely.linestrings(piece.sides)).nearest(shapely.points(middles))
    return mesh.with_boundaries(
        {edge: facets[np.isin(side, piece.sides_of(edge))] for edge in piece.edges}
    )


def size_for(piece: CutPiece, elements: int) -> float:
    """Size (mm) of elements: a piece has about ``elements``, and no more along its boundary."""
    left, bottom, right, top = piece.polygon.bounds
    covered = max(piece.area_mm2, (right - left) * (top - bottom) / MAX_EMPTY)
    return max(math.sqrt(covered / elements), float(piece.polygon.length) / elements)


def triangulation(piece: CutPiece, size_mm: float) -> tuple[Array, Indices]:
    """Points (n, 2) in mm and counter-clockwise triangles (m, 3) of a piece.

    Raises
    ------
    InputError
        If the sides cannot be made of triangles' edges.
    """
    polygon = piece.polygon.segmentize(size_mm)
    rings = [np.asarray(r.coords)[:-1] for r in (polygon.exterior, *polygon.interiors)]
    inside = _lattice(piece.polygon, size_mm)
    for _ in range(MAX_SPLITS):
        boundary = np.concatenate(rings)
        points = np.concatenate([boundary, inside])
        try:
            triangles = scipy.spatial.Delaunay(points).simplices.astype(np.int64)
        except scipy.spatial.QhullError:
            break
        corners = points[triangles]
        doubled = _doubled_areas(corners)
        centres = corners.mean(axis=1)
        within = shapely.contains_xy(piece.polygon, centres[:, 0], centres[:, 1])
        triangles = triangles[within & (np.abs(doubled) > 1e-9 * size_mm**2)]
        missing = _missing(rings, triangles)
        if not any(lost.any() for lost in missing):
            used, places = np.unique(triangles, return_inverse=True)
            points, triangles = points[used], places.reshape(triangles.shape)
            points = _smoothed(points, triangles, len(boundary))
            flipped = _doubled_areas(points[triangles]) < 0
            triangles[flipped] = triangles[flipped][:, ::-1]
            return points, triangles
        rings = [_halved(ring, lost) for ring, lost in zip(rings, missing, strict=True)]
    raise InputError(
        "outline",
        "no mesh fits it: sides come too close to each other.",
        "Use a smaller mesh_mm, or a simpler outline.",
    )


def _lattice(polygon: shapely.Polygon, size: float) -> Array:
    """Points of a triangular lattice inside, clear of the boundary, (n, 2)."""
    left, bottom, right, top = polygon.bounds
    height = size * math.sqrt(3) / 2
    x, y = np.meshgrid(np.arange(left, right + size, size), np.arange(bottom, top + size, height))
    x[1::2] += size / 2
    points = np.column_stack([x.ravel(), y.ravel()])
    inside = shapely.contains_xy(polygon, points[:, 0], points[:, 1])
    points = points[inside]
    clear = shapely.distance(polygon.boundary, shapely.points(points)) > CLEARANCE * size
    return np.asarray(points[clear])


def _missing(rings: list[Array], triangles: Indices) -> list[NDArray[np.bool_]]:
    """The segments of the rings that are not edges of triangles."""
    edges = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    known = set(map(tuple, edges.tolist()))
    missing, first = [], 0
    for ring in rings:
        number = first + np.arange(len(ring))
        pairs = np.sort(np.column_stack([number, np.roll(number, -1)]), axis=1).tolist()
        missing.append(np.array([tuple(pair) not in known for pair in pairs]))
        first += len(ring)
    return missing


def _halved(ring: Array, lost: NDArray[np.bool_]) -> Array:
    """Insert points in the middle of some segments of a ring."""
    middles = (ring + np.roll(ring, -1, axis=0)) / 2
    return np.insert(ring, np.flatnonzero(lost) + 1, middles[lost], axis=0)


def _smoothed(points: Array, triangles: Indices, boundary: int) -> Array:
    """Move inner points to the mean of their neighbours, unless a triangle turns over."""
    pairs = np.concatenate([triangles[:, [i, j]] for i in range(3) for j in range(3) if i != j])
    inner = np.arange(len(points)) >= boundary
    sense = np.sign(_doubled_areas(points[triangles]))
    for _ in range(SMOOTHINGS):
        count = np.bincount(pairs[:, 0], minlength=len(points))
        mean = (
            np.column_stack(
                [np.bincount(pairs[:, 0], points[pairs[:, 1], k], len(points)) for k in range(2)]
            )
            / np.maximum(count, 1)[:, None]
        )
        moved = np.where(inner[:, None] & (count > 0)[:, None], mean, points)
        if np.any(np.sign(_doubled_areas(moved[triangles])) != sense):
            break
        points = moved
    return points


def _doubled_areas(corners: Array) -> Array:
    """Twice the signed areas of triangles (n, 3, 2)."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
