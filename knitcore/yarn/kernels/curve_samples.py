"""The curve of a course at its samples, and which control points a sample depends on."""

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled


@compiled
def sample_curve(controls: Array, course_mm: float, mirror: int, basis: Array) -> Array:
    """Position and three derivatives at every sample.

    Parameters
    ----------
    controls : (courses, C, 3), periodic part: x without the drift ``course_mm * t``.
    course_mm : size of a stitch along the course.
    mirror : -1 if z changes its sign from one period to the next, else 1.
    basis : (4, per_span, 6)

    Returns
    -------
    (courses, S, 4, 3); x of the position is without the drift, x of d1 has it.
    """
    courses, count, _ = controls.shape
    per_span = basis.shape[1]
    out = np.zeros((courses, count * per_span, 4, 3))
    for j in range(courses):
        for span in range(count):
            for o in range(per_span):
                s = span * per_span + o
                for a in range(6):
                    c, sign = control_of(span, a, count, mirror)
                    x = controls[j, c, 0]
                    y = controls[j, c, 1]
                    z = sign * controls[j, c, 2]
                    for d in range(4):
                        w = basis[d, o, a]
                        out[j, s, d, 0] += w * x
                        out[j, s, d, 1] += w * y
                        out[j, s, d, 2] += w * z
                out[j, s, 1, 0] += course_mm
    return out


@compiled
def control_of(span: int, a: int, count: int, mirror: int) -> tuple[int, float]:
    """Control point a of a span within its course, and the sign of its z there."""
    c = span - 2 + a
    if c < 0:
        return c + count, float(mirror)
    if c >= count:
        return c - count, float(mirror)
    return c, 1.0


@compiled
def laid_out(curve: Array, place: Array, course_mm: float, wale_mm: float) -> Array:
    """(n, 6) of every sample: x, y and z with the drift of the cell, t and row, and |d1|."""
    samples = place.shape[0]
    out = np.empty((curve.shape[0], 6))
    for i in range(curve.shape[0]):
        t, row = place[i % samples], float(i // samples)
        out[i, 0] = curve[i, 0, 0] + t * course_mm
        out[i, 1] = curve[i, 0, 1] + row * wale_mm
        out[i, 2] = curve[i, 0, 2]
        out[i, 3] = t
        out[i, 4] = row
        out[i, 5] = np.sqrt(curve[i, 1, 0] ** 2 + curve[i, 1, 1] ** 2 + curve[i, 1, 2] ** 2)
    return out
