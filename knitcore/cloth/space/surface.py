"""Points on and above a curled piece."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array


def filled(corners_mm: Array, used: NDArray[np.bool_]) -> Array:
    """Fill in the corners (rows + 1, columns + 1, 3) that no stitch has, as smoothly as possible.

    They minimise the squares of second differences along rows and columns.
    """
    if used.all():
        return corners_mm
    second = [line[2:] - 2.0 * line[1:-1] + line[:-2] for line in map(_unit, used.shape)]
    rows, columns = map(_unit, used.shape)
    both = scipy.sparse.vstack(
        [scipy.sparse.kron(second[0], columns), scipy.sparse.kron(rows, second[1])], format="csc"
    )
    corners, there = corners_mm.reshape(-1, 3).copy(), used.ravel()
    missing = both[:, ~there]
    corners[~there] = -scipy.sparse.linalg.splu((missing.T @ missing).tocsc()).solve(
        missing.T @ (both[:, there] @ corners[there])
    )
    return corners.reshape(corners_mm.shape)


def _unit(count: int) -> scipy.sparse.csr_array:
    return scipy.sparse.eye_array(count, format="csr")


def _halved(lines: Array) -> Array:
    """Split a single strip in two, since a spline of degree 1 has no slope."""
    if len(lines) > 2:
        return lines
    return np.stack([lines[0], 0.5 * (lines[0] + lines[1]), lines[1]])


class Surface:
    """A smooth surface through the corners of the stitches.

    Parameters
    ----------
    corners_mm : (rows + 1, columns + 1, 3)
    """

    def __init__(self, corners_mm: Array) -> None:
        rows, columns = (n - 1 for n in corners_mm.shape[:2])
        self._size = columns, rows
        corners_mm = _halved(_halved(corners_mm).swapaxes(0, 1)).swapaxes(0, 1)
        up = np.linspace(0.0, rows, len(corners_mm))
        along = np.linspace(0.0, columns, corners_mm.shape[1])
        kx, ky = min(3, len(up) - 1), min(3, len(along) - 1)
        self._parts = [
            scipy.interpolate.RectBivariateSpline(up, along, corners_mm[..., m], kx=kx, ky=ky)
            for m in range(3)
        ]

    def at(self, across: Array, up: Array, height_mm: Array) -> Array:
        """Points (…, 3), mm, at places counted in stitches from the lower left corner.

        Beyond the edges the surface is continued straight.
        """
        inside = np.clip(across, 0.0, self._size[0]), np.clip(up, 0.0, self._size[1])
        along, rising = self._of(*inside, 0, 1), self._of(*inside, 1, 0)
        beyond = across - inside[0], up - inside[1]
        normal = np.cross(along, rising)
        normal /= np.maximum(np.linalg.norm(normal, axis=-1), 1e-12)[..., None]
        foot = self._of(*inside, 0, 0) + along * beyond[0][..., None]
        return np.asarray(foot + rising * beyond[1][..., None] + normal * height_mm[..., None])

    def _of(self, across: Array, up: Array, by_up: int, by_across: int) -> Array:
        return np.stack(
            [part.ev(up, across, dx=by_up, dy=by_across) for part in self._parts], axis=-1
        )
