"""Hessian of a sheet's energy as a sparse matrix, compiled."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.base.elementary import arctan2, log
from knitcore.cloth.space.sheet_kernels import (
    NAP,
    bent,
    hinge_points,
    metric_energy,
    points_on,
    pressed,
    turn_slope,
    width_slope,
)
from knitcore.cloth.space.stitch_sheet import StitchSheet

Ints = NDArray[np.int64]

_TINY = 1e-30
"""Complex step: the derivative is exact to the last digit at any size."""
_FAR = 0.5
"""Share of a far corner in the middle between two."""


class Tangent:
    """The matrix of a sheet: its pattern is found once, its entries at every shape."""

    def __init__(self, sheet: StitchSheet) -> None:
        self._sheet = sheet
        self._count = len(sheet.flat_mm)
        net = (part.tobytes() for part in (sheet.quarters, sheet.hinges, sheet.quads))
        self._blocks, self._places = _pattern(self._count, *net)

    def is_apart(self, matrix: scipy.sparse.bsr_matrix) -> bool:
        """Tell if only neighbouring corners have an entry in the matrix."""
        return len(matrix.indices) == len(self._blocks)

    def matrix(
        self,
        x: Array,
        pairs: Ints,
        free: NDArray[np.bool_],
        *,
        convex: bool,
        shift: Array | float = 0.0,
    ) -> scipy.sparse.bsr_matrix:
        """Hessian at a shape, in blocks of (3, 3). Rows of coordinates that are not free are those
        of the unit matrix.

        Parameters
        ----------
        free : (corners, 3)
        convex : leave out the terms that may make it indefinite: the curvature of angles and of
            distances under compression.
        shift : added to the diagonal, N/mm, for all or for each coordinate (corners, 3).
        """
        sheet = self._sheet
        data = np.zeros((len(self._blocks), 3, 3))
        _quarters(x, sheet.quarters, sheet.membrane, self._places[0], convex, data)
        _hinges(x, sheet.hinges, sheet.turning, self._places[1], convex, data)
        _twists(sheet.twisting, self._places[2], data)
        blocks = self._blocks
        touching, stiff = _touches(
            x, sheet.points, pairs, sheet.thickness_mm, sheet.touch_n_per_mm, convex
        )
        if len(touching):
            keys = touching[:, 0] * self._count + touching[:, 1]
            keys, data = np.concatenate([blocks, keys]), np.concatenate([data, stiff])
            order = np.argsort(keys, kind="stable")
            blocks, first = np.unique(keys[order], return_index=True)
            data = np.add.reduceat(data[order], first)
        row, column = np.divmod(blocks, self._count)
        data *= free[row][:, :, None] & free[column][:, None, :]
        own = row == column
        data[own] += np.where(free, shift, 1.0)[:, :, None] * np.eye(3)
        start = np.searchsorted(row, np.arange(self._count + 1))
        size = 3 * self._count
        return scipy.sparse.bsr_matrix((data, column, start), shape=(size, size))


@lru_cache(maxsize=8)
def _pattern(
    count: int, quarters: bytes, hinges: bytes, quads: bytes
) -> tuple[Ints, tuple[Ints, ...]]:
    """Numbers of the blocks, row · count + column, and where the parts of the net add to them.

    It is the same for all pieces of a size, such as those between two strokes of a brush.
    """
    parts = [
        np.frombuffer(part, np.int64).reshape(-1, corners)
        for part, corners in ((quarters, 3), (hinges, 6), (quads, 4))
    ]
    keys = [(part[:, :, None] * count + part[:, None, :]).ravel() for part in parts]
    own = np.arange(count) * (count + 1)
    blocks, inverse = np.unique(np.concatenate([*keys, own]), return_inverse=True)
    places = np.split(inverse[: -len(own)], np.cumsum([len(key) for key in keys])[:-1])
    return blocks, tuple(
        place.reshape(len(part), part.shape[1], part.shape[1])
        for part, place in zip(parts, places, strict=True)
    )


@compiled
def _convex(
    q1: float, q2: float, g: float, parameters: Array, slope: Array, curvature: Array
) -> None:
    """Keep the tensile part of a quarter's stress and the positive part of its stiffness."""
    _, _, c11, c22, c12, shear = parameters
    slope[0], slope[1], slope[2] = max(slope[0], 0.0), max(slope[1], 0.0), 0.0
    curvature[:] = 0.0
    curvature[0, 0] = 0.25 * c11 / q1**2
    curvature[1, 1] = 0.25 * c22 / q2**2
    curvature[0, 1] = curvature[1, 0] = 0.25 * c12 / (q1 * q2)
    curvature[2, 2] = shear / (q1 * q2 - g * g)


@compiled
def _quarters(
    x: Array, corners: Ints, parameters: Array, places: Ints, convex: bool, data: Array
) -> None:
    block = np.empty((2, 2, 3, 3))
    slope, u, v = np.empty(3), np.empty(3), np.empty(3)
    curvature = np.empty((3, 3))
    for k in range(corners.shape[0]):
        c, a, b = corners[k]
        l1, l2 = parameters[k, 0], parameters[k, 1]
        for m in range(3):
            u[m], v[m] = (x[a, m] - x[c, m]) / l1, (x[b, m] - x[c, m]) / l2
        q1 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2]
        q2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
        g = u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
        metric_energy(q1, q2, g, parameters[k], slope, curvature)
        if convex:
            _convex(q1, q2, g, parameters[k], slope, curvature)
        for m in range(3):
            for n in range(3):
                same = 1.0 if m == n else 0.0
                block[0, 0, m, n] = (
                    4.0 * curvature[0, 0] * u[m] * u[n]
                    + 2.0 * curvature[0, 2] * (u[m] * v[n] + v[m] * u[n])
                    + curvature[2, 2] * v[m] * v[n]
                    + 2.0 * slope[0] * same
                ) / l1**2
                block[1, 1, m, n] = (
                    4.0 * curvature[1, 1] * v[m] * v[n]
                    + 2.0 * curvature[1, 2] * (u[m] * v[n] + v[m] * u[n])
                    + curvature[2, 2] * u[m] * u[n]
                    + 2.0 * slope[1] * same
                ) / l2**2
                block[0, 1, m, n] = (
                    4.0 * curvature[0, 1] * u[m] * v[n]
                    + 2.0 * curvature[0, 2] * u[m] * u[n]
                    + 2.0 * curvature[1, 2] * v[m] * v[n]
                    + curvature[2, 2] * v[m] * u[n]
                    + slope[2] * same
                ) / (l1 * l2)
                block[1, 0, n, m] = block[0, 1, m, n]
        for i in range(2):
            for j in range(2):
                both, row = places[k, 1 + i, 1 + j], places[k, 1 + i, 0]
                column, own = places[k, 0, 1 + j], places[k, 0, 0]
                for m in range(3):
                    for n in range(3):
                        value = block[i, j, m, n]
                        data[both, m, n] += value
                        data[column, m, n] -= value
                        data[row, m, n] -= value
                        data[own, m, n] += value


@compiled
def _add_square(slope: Array, factor: float, matrix: Array) -> None:
    for i in range(12):
        for j in range(12):
            matrix[i, j] += factor * slope[i // 3, i % 3] * slope[j // 3, j % 3]


@compiled
def _step(points: Array, j: int, stepped: NDArray[np.complex128]) -> None:
    """Points with a complex step in their coordinate j."""
    for i in range(4):
        for m in range(3):
            stepped[i, m] = points[i, m]
    stepped[j // 3, j % 3] += 1j * _TINY


@compiled
def _add_column(slope: NDArray[np.complex128], factor: float, j: int, matrix: Array) -> None:
    for i in range(12):
        matrix[i, j] += factor * slope[i // 3, i % 3].imag / _TINY


@compiled
def _hinges(
    x: Array, nodes: Ints, parameters: Array, places: Ints, convex: bool, data: Array
) -> None:
    points = np.empty((4, 3))
    slope = np.empty((4, 3))
    stepped = np.empty((4, 3), np.complex128)
    complex_slope = np.empty((4, 3), np.complex128)
    matrix = np.empty((12, 12))
    for k in range(nodes.shape[0]):
        hinge_points(x, nodes[k], points)
        sine, cosine, left, right = turn_slope(points, slope)
        _, moment, stiffness = bent(arctan2(sine, cosine), parameters[k])
        matrix[:] = 0.0
        _add_square(slope, stiffness, matrix)
        if not convex:
            for j in range(12):
                _step(points, j, stepped)
                turn_slope(stepped, complex_slope)
                _add_column(complex_slope, moment, j, matrix)
        for side in range(2, 4):
            if (left if side == 2 else right) >= parameters[k, 3]:
                continue
            narrow = log(width_slope(points, side, slope) / parameters[k, 3])
            _add_square(slope, parameters[k, 0], matrix)
            if not convex:
                for j in range(12):
                    _step(points, j, stepped)
                    width_slope(stepped, side, complex_slope)
                    _add_column(complex_slope, parameters[k, 0] * narrow, j, matrix)
        for i in range(6):
            pi = i if i < 2 else (2 if i < 4 else 3)
            wi = 1.0 if i < 2 else _FAR
            for j in range(6):
                pj = j if j < 2 else (2 if j < 4 else 3)
                wj = 1.0 if j < 2 else _FAR
                to = places[k, i, j]
                for m in range(3):
                    for n in range(3):
                        data[to, m, n] += wi * wj * matrix[3 * pi + m, 3 * pj + n]


@compiled
def _twists(stiffness: Array, places: Ints, data: Array) -> None:
    signs = (1.0, -1.0, -1.0, 1.0)
    for k in range(places.shape[0]):
        for i in range(4):
            for j in range(4):
                for m in range(3):
                    data[places[k, i, j], m, m] += stiffness[k] * signs[i] * signs[j]


@compiled
def _touches(
    x: Array, points: Ints, pairs: Ints, thickness_mm: float, stiffness: float, convex: bool
) -> tuple[Ints, Array]:
    """Corners (m, 2) and blocks (m, 3, 3) of the pairs in touch."""
    at = points_on(x, points)
    reach = (1.0 + NAP) * thickness_mm
    apart = np.empty(pairs.shape[0])
    count = 0
    for k in range(pairs.shape[0]):
        i, j = pairs[k, 0], pairs[k, 1]
        dx, dy, dz = at[j, 0] - at[i, 0], at[j, 1] - at[i, 1], at[j, 2] - at[i, 2]
        apart[k] = np.sqrt(dx * dx + dy * dy + dz * dz)
        if apart[k] < reach:
            count += 1
    where = np.empty((64 * count, 2), np.int64)
    blocks = np.empty((64 * count, 3, 3))
    block, off = np.empty((3, 3)), np.empty(3)
    place = 0
    for k in range(pairs.shape[0]):
        if apart[k] >= reach:
            continue
        i, j = pairs[k, 0], pairs[k, 1]
        for m in range(3):
            off[m] = at[j, m] - at[i, m]
        distance = max(apart[k], 1e-9)
        _, force, along = pressed(reach - distance, thickness_mm, stiffness)
        aside = 0.0 if convex else -force / distance
        for m in range(3):
            for n in range(3):
                block[m, n] = (along - aside) * off[m] * off[n] / distance**2
            block[m, m] += aside
        for s in range(8):
            for t in range(8):
                first = points[i, s] if s < 4 else points[j, s - 4]
                second = points[i, t] if t < 4 else points[j, t - 4]
                sign = 1.0 if (s < 4) == (t < 4) else -1.0
                where[place, 0] = first
                where[place, 1] = second
                for m in range(3):
                    for n in range(3):
                        blocks[place, m, n] = sign / 16.0 * block[m, n]
                place += 1
    return where, blocks
