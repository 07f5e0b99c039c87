"""A displacement field as a camera would see it, made with a known law."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import griddata

from knitcore.chart.fabric import Direction
from knitcore.cloth.flat import QuarterGrid, Sheet, SheetModel, pull
from knitcore.law.constitutive import ConstitutiveLaw

PITCH_PX = 8.0


def camera_arrays(
    law: ConstitutiveLaw, model: SheetModel
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """``displacement`` and ``frame`` of a swatch pulled wale-wise, along the picture's y."""
    grid = QuarterGrid.uniform(60, 20, 960.0, 320.0)
    test = pull(Sheet(grid, [law], model), Direction.WALE, np.array([0.15, 0.3]))
    rows, columns = 75, 125
    row, column = np.mgrid[0:rows, 0:columns]
    picture = np.column_stack([(column.ravel() - 62) * PITCH_PX, (37 - row.ravel()) * PITCH_PX])
    x, y = picture.T
    frames = [np.zeros((2, rows, columns))]
    frames[0][0].ravel()[(np.abs(x) <= 480) & (np.abs(y) <= 160)] = 1e-13
    for state in test.states:
        u = griddata(state.corners, state.corners - grid.corners, picture)
        # griddata fills the convex hull; the waist is narrower
        left, right = (
            np.interp(y, state.corners[grid.edge(name), 1], state.corners[grid.edge(name), 0])
            for name in ("left", "right")
        )
        u[~np.isfinite(u).all(axis=1) | (x < left) | (x > right)] = 0
        frames.append(np.stack([u[:, 0].reshape(rows, -1), -u[:, 1].reshape(rows, -1)]))
    return np.array(frames), np.array([1, 2, 3])
