"""How the yarn of a repeat is knotted: a number that no motion of the yarn can change.

The fabric repeats in the plane, so its yarn is a link in a thickened torus. Seen from above it is a
diagram of crossings; every piece of yarn from one passage below another to the next is an arc.
A crossing relates three arcs,

    t^s u_in + (1 - t^s) x^a y^b o - u_out = 0,

``s`` its sign, ``o`` the arc above, ``(a, b)`` the repeat that ``o`` lies in as seen from the lower
arc. The determinant of these relations is the torsion of the space around the yarn relative to its
upper side: up to a factor ± t^i x^j y^k it is the same however the yarn is moved and from wherever
it is seen, as long as it does not pass through itself (Fox calculus on the Wirtinger presentation,
equivariant under the translations of the fabric). With |t| = |x| = |y| = 1 the factor has modulus
one, so the modulus of the determinant is an invariant. Courses that have come loose give the value
of parallel lines, and a stitch on the wrong side yet another.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.base.threads import in_one_blas_thread
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.kernels.structures import Ints
from knitcore.yarn.model.cell import YarnCell, plain_cell
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.tiling import centre_lines

_TILT = np.array([0.0137, 0.0071])
"""Direction of view: a little off the normal, so that symmetric shapes show no double crossings."""
_PLACES = np.exp(1j * np.array([[0.7, 1.9, 2.6], [0.9, 0.9, 1.3], [0.5, 2.9, 0.5]]))
"""Where (t, x, y) the determinant is taken. As |1 - t| < 1, rounding does not grow from arc to arc,
which would spoil it in charts of thousands of crossings."""
_SAME = 1e-6
_DENSE_UP_TO = 1500
"""Crossings up to which the matrix is dense; it has at most three entries in a row."""


def clasp_code(lines: Array, width_mm: float, height_mm: float) -> Array:
    """Logarithm of the modulus of the determinant at three places, (3,).

    Parameters
    ----------
    lines : (courses, points, 3) centre lines of a repeat, mm, bottom course first.
    width_mm, height_mm : the repeat's period along the course and along the wale.
    """
    courses, points, _ = lines.shape
    ahead = lines[:, :1] + (width_mm, 0.0, 0.0)
    closed = np.concatenate([lines, ahead], axis=1)
    flat = closed.copy()
    flat[..., :2] -= closed[..., 2:] * _TILT
    crossed = crossings(flat, width_mm, height_mm)
    return _determinants(crossed, courses, points)


def same_clasps(code: Array, other: Array) -> bool:
    """Tell whether two codes are those of the same link."""
    return bool(np.allclose(code, other, rtol=_SAME, atol=_SAME))


@lru_cache(maxsize=256)
def knitted_code(chart: StitchChart) -> tuple[float, ...]:
    """The code of a repeat as it is knitted: every loop through the one below, on its side."""
    grid = SplineGrid(16, 3)
    cell = plain_cell(chart, grid)
    length, radius = 12.0, 0.6
    state = start_state(cell, length, radius)
    lines = centre_lines(cell, state, chart.rows, chart.columns)
    code = clasp_code(lines, chart.columns * float(state[-2]), chart.rows * float(state[-1]))
    return tuple(code.tolist())


def is_knitted(chart: StitchChart, lines: Array, course_mm: float, wale_mm: float) -> bool:
    """Tell whether centre lines of a repeat are knotted as its chart says.

    Parameters
    ----------
    chart : the repeat.
    lines : (rows, points, 3) centre lines once across the repeat, mm, bottom course first.
    course_mm, wale_mm : size of one stitch.
    """
    code = clasp_code(lines, chart.columns * course_mm, chart.rows * wale_mm)
    return same_clasps(code, np.array(knitted_code(chart)))


def cell_is_knitted(cell: YarnCell, state: Array) -> bool:
    """Tell whether a state of a cell is knotted as the cell's stitches say."""
    rows = cell.rows * (2 if cell.mirror_wale else 1)
    wales = cell.wales * (2 if cell.mirror_course else 1)
    lines = centre_lines(cell, state, rows, wales)
    if cell.code is not None:
        code = clasp_code(lines, wales * float(state[-2]), rows * float(state[-1]))
        return same_clasps(code, np.array(cell.code))
    purl = [[cell.purl_at(row, wale) for wale in range(wales)] for row in range(rows)]
    return is_knitted(StitchChart(np.array(purl)), lines, float(state[-2]), float(state[-1]))


def crossings(lines: Array, width: float, height: float) -> Array:
    """All crossings seen from above, each once.

    Parameters
    ----------
    lines : (courses, points + 1, 3), each course closed by its first point one period on.

    Returns
    -------
    (n, 7): course and place (in points) of the lower strand, the same of the upper one, the
    repeats (a, b) by which the upper one is moved to get there, sign of the crossing.
    """
    low, high = lines[:, :, :2].min(axis=1), lines[:, :, :2].max(axis=1)
    period = np.array([width, height])
    far = np.ceil((high.max(axis=0) - low.min(axis=0)) / period).astype(np.int64)
    boxes = np.stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]], axis=1)
    out = np.empty((64 * lines.shape[0] * lines.shape[1], 7))
    while (count := _crossings(lines, width, height, far, boxes, out)) > len(out):
        out = np.empty((count, 7))
    return out[:count]


@compiled
def _crossings(  # noqa: PLR0912 - compiled: loops over boxes, then segments
    lines: Array, width: float, height: float, far: Ints, boxes: Array, out: Array
) -> int:
    """Fill ``out`` and tell the number of crossings; those without room are only counted.

    Parameters
    ----------
    far : (2,) repeats beyond which no course reaches, across and up.
    boxes : (courses, 4) least and greatest x, least and greatest y of each course.
    """
    courses, count, _ = lines.shape
    n = 0
    for j in range(courses):
        for s in range(count - 1):
            px, py, pz = lines[j, s, 0], lines[j, s, 1], lines[j, s, 2]
            ux = lines[j, s + 1, 0] - px
            uy = lines[j, s + 1, 1] - py
            left, right = min(px, px + ux), max(px, px + ux)
            down, up = min(py, py + uy), max(py, py + uy)
            for b in range(-far[1], far[1] + 1):
                for k in range(courses):
                    if boxes[k, 2] + b * height > up or boxes[k, 3] + b * height < down:
                        continue
                    for a in range(-far[0], far[0] + 1):
                        if boxes[k, 0] + a * width > right or boxes[k, 1] + a * width < left:
                            continue
                        for q in range(count - 1):
                            qx = lines[k, q, 0] + a * width
                            rx = lines[k, q + 1, 0] + a * width
                            if max(qx, rx) < left or min(qx, rx) > right:
                                continue
                            qy = lines[k, q, 1] + b * height
                            ry = lines[k, q + 1, 1] + b * height
                            if max(qy, ry) < down or min(qy, ry) > up:
                                continue
                            vx, vy = rx - qx, ry - qy
                            turn = ux * vy - uy * vx
                            if turn == 0.0:
                                continue
                            f = ((qx - px) * vy - (qy - py) * vx) / turn
                            g = ((qx - px) * uy - (qy - py) * ux) / turn
                            if f < 0.0 or f >= 1.0 or g < 0.0 or g >= 1.0:
                                continue
                            z = pz + f * (lines[j, s + 1, 2] - pz)
                            over = lines[k, q, 2] + g * (lines[k, q + 1, 2] - lines[k, q, 2])
                            if over <= z:
                                continue  # met again from the other strand
                            if n < out.shape[0]:
                                out[n, 0], out[n, 1] = j, s + f
                                out[n, 2], out[n, 3] = k, q + g
                                out[n, 4], out[n, 5] = a, b
                                # upper strand to lower strand, counter-clockwise: positive
                                out[n, 6] = 1.0 if turn < 0.0 else -1.0
                            n += 1
    return n


def _determinants(crossed: Array, courses: int, points: int) -> Array:
    order = np.lexsort((crossed[:, 1], crossed[:, 0]))
    crossed = crossed[order]
    lower = crossed[:, 0].astype(int)
    counts = np.bincount(lower, minlength=courses)
    loose = np.flatnonzero(counts == 0)
    first = np.concatenate([[0], np.cumsum(counts)])
    size = len(crossed) + len(loose)
    arc, wrapped = _arcs(crossed, first, loose, points)
    before = np.arange(len(crossed)) - 1
    starts = first[lower] == np.arange(len(crossed))
    before[starts] = first[lower[starts] + 1] - 1
    rows = np.arange(len(crossed))
    codes = []
    for t, x, y in _PLACES:
        sign = t ** crossed[:, 6]
        moved = x ** (crossed[:, 4] - wrapped) * y ** crossed[:, 5]
        alone = np.arange(len(crossed), size)
        entries = np.concatenate([
            sign * np.where(starts, 1.0 / x, 1.0), (1.0 - sign) * moved,
            np.full(len(crossed), -1.0), np.full(len(loose), 1.0 - x),
        ])  # fmt: skip
        places = (
            np.concatenate([rows, rows, rows, alone]),
            np.concatenate([before, arc, rows, alone]),
        )
        codes.append(_log_modulus(scipy.sparse.coo_array((entries, places), shape=(size, size))))
    return np.array(codes)


@in_one_blas_thread
def _log_modulus(matrix: scipy.sparse.coo_array) -> float:
    """Logarithm of the modulus of a determinant."""
    if matrix.shape[0] <= _DENSE_UP_TO:
        return float(np.linalg.slogdet(matrix.toarray())[1])
    return float(np.log(np.abs(scipy.sparse.linalg.splu(matrix.tocsc()).U.diagonal())).sum())


def _arcs(
    crossed: Array, first: NDArray[np.intp], loose: NDArray[np.intp], points: int
) -> tuple[Ints, Ints]:
    """Arc that each crossing's upper strand belongs to, and 1 where it began a period earlier."""
    arc = np.empty(len(crossed), np.int64)
    wrapped = np.zeros(len(crossed), np.int64)
    upper = crossed[:, 2].astype(int)
    for course in np.unique(upper):
        own = np.flatnonzero(upper == course)
        begin, end = first[course], first[course + 1]
        if begin == end:
            arc[own] = len(crossed) + int(np.searchsorted(loose, course))
            continue
        place = np.searchsorted(crossed[begin:end, 1], crossed[own, 3], side="right") - 1
        wrapped[own] = place < 0
        arc[own] = np.where(place < 0, end - 1, begin + place)
    return arc, wrapped
