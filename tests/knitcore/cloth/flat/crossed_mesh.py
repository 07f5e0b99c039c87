"""The crossed triangulation of a quarter grid as a mesh of scikit-fem, to compare with."""

import numpy as np
from skfem import MeshTri

from knitcore.cloth.flat.grid import QuarterGrid


def crossed_mesh(grid: QuarterGrid) -> MeshTri:
    """Nodes are numbered as in the grid, the centres after the corners; edges have its names."""
    corners, points = grid.cell_corners, np.vstack([grid.corners, grid.centres])
    centre = len(grid.corners) + np.arange(len(corners))
    sides = [np.column_stack([corners[:, i], corners[:, (i + 1) % 4], centre]) for i in range(4)]
    triangles = np.stack(sides, axis=1).reshape(-1, 3)
    mesh = MeshTri(np.ascontiguousarray(points.T), np.ascontiguousarray(triangles.T))
    x, y = grid.column_lines, grid.row_lines
    return mesh.with_boundaries(
        {
            "left": lambda p: np.isclose(p[0], x[0]),
            "right": lambda p: np.isclose(p[0], x[-1]),
            "bottom": lambda p: np.isclose(p[1], y[0]),
            "top": lambda p: np.isclose(p[1], y[-1]),
        }
    )
