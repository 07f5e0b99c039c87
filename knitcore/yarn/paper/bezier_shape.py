"""Eight quintic Bezier curves that make one stitch of one of the four fabrics.

In yarn order: B1, c11, A1', c12', A2', c22, B2, c21. A and B are the two strands of a crossover,
1 and 2 the two crossovers of the stitch, c the connectors; a prime means moved up to the next
course (mirrored in z where the courses alternate). The end of c21 meets the start of B1 one stitch
on (mirrored in z where the wales alternate). Neighbouring curves share position, tangent and
curvature vector. Crossover 2 is the mirror image x -> -x of crossover 1.

A curve leaves an end e with tangent t and curvature vector c by

    k0 = e,   k1 = k0 + α t / 5,   k2 = k1 + α² c / 20 + β t,

and reaches its other end likewise. The 34 parameters of this description are listed in
:data:`PARAMETERS`; each fabric ties some of them (:func:`ties`).
"""

import numpy as np
import numpy.typing as npt

from knitcore.base.arrays import Array
from knitcore.base.compiled import compiled
from knitcore.chart.fabric import Fabric

ComplexArray = npt.NDArray[np.complex128]

_END = ("polar", "azimuth", "alpha", "kappa", "normal", "beta")
PARAMETERS = (
    "centre_x",  # distance of the two crossovers, mm
    "centre_z",  # minus twice the height of their centres, mm
    *("frame_x", "frame_y", "frame_z"),  # angles of the frame R = Rx Ry Rz
    "half_length",  # mm
    "tilt",
    *(f"shared_{name}" for name in _END),  # start of strand A and end of strand B
    *(f"a1_{name}" for name in _END),  # end of strand A
    *(f"b0_{name}" for name in _END),  # start of strand B
    "twist",
    *("c12_alpha", "c12_beta", "c21_alpha", "c21_beta", "c11_alpha", "c11_beta"),
    *("cell_course", "cell_wale"),  # mm
)
"""Names of the parameters, in their order."""

COUNT = len(PARAMETERS)
CELL_COURSE, CELL_WALE = COUNT - 2, COUNT - 1
# The eight curves in yarn order: B1, c11, A1, c12, A2, c22, B2, c21.


def ties(fabric: Fabric) -> Array:
    """Matrix that makes the 34 parameters from a fabric's own unknowns.

    Stockinette and garter put the crossovers at a quarter of the cell and have equal connectors c12
    and c21, stockinette also puts them in the plane z = 0. That leaves 28, 29, 32 and 32 unknowns
    of stockinette, garter, rib and seed, and the two sizes of the cell.

    Returns
    -------
    Array of shape (34, unknowns); the last two unknowns are the cell's sizes.
    """
    index = {name: i for i, name in enumerate(PARAMETERS)}
    tied: dict[str, tuple[str, float] | None] = {}
    if not fabric.course_odd:
        tied["centre_x"] = ("cell_course", 0.5)
        tied["c21_alpha"] = ("c12_alpha", 1.0)
        tied["c21_beta"] = ("c12_beta", 1.0)
        if not fabric.wale_odd:
            tied["centre_z"] = None
    free = [name for name in PARAMETERS if name not in tied]
    matrix = np.zeros((COUNT, len(free)))
    for column, name in enumerate(free):
        matrix[index[name], column] = 1.0
    for name, source in tied.items():
        if source is not None:
            matrix[index[name], free.index(source[0])] = source[1]
    return matrix


def unknown_names(fabric: Fabric) -> tuple[str, ...]:
    """Names of a fabric's own unknowns, in their order."""
    matrix = ties(fabric)
    return tuple(
        next(n for i, n in enumerate(PARAMETERS) if column[i] == 1.0) for column in matrix.T
    )


@compiled
def _cross(a: ComplexArray, b: ComplexArray, out: ComplexArray) -> None:
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        out[i] = a[j] * b[k] - a[k] * b[j]


@compiled
def _frame(p: ComplexArray, axes: ComplexArray) -> None:
    """Write the rows e1, e2, e3 of a crossover: R y, R z, R x with R = Rx Ry Rz."""
    sx, sy, sz = np.sin(p[2]), np.sin(p[3]), np.sin(p[4])
    cx, cy, cz = np.cos(p[2]), np.cos(p[3]), np.cos(p[4])
    axes[0, 0], axes[0, 1], axes[0, 2] = -cy * sz, cx * cz + sx * sy * sz, sx * cz - cx * sy * sz
    axes[1, 0], axes[1, 1], axes[1, 2] = -sy, -sx * cy, cx * cy
    axes[2, 0], axes[2, 1], axes[2, 2] = cy * cz, cx * sz - sx * sy * cz, sx * sz + cx * sy * cz


@compiled
def _direct(
    end: ComplexArray, p: ComplexArray, at: int, axes: ComplexArray, strand: float, last: float
) -> None:
    """Write tangent and curvature vector of a strand's end into rows 1 and 2 of ``end``.

    ``strand`` is 1 for A and -1 for B, ``last`` -1 where the strand ends and 1 where it starts;
    ``axes`` holds E1, E2, e3 of that end as rows, ``p[at : at + 6]`` its six parameters.
    """
    polar, azimuth, kappa, normal = p[at], p[at + 1], p[at + 3], p[at + 4]
    sine = np.sin(polar)
    along, across = strand * last * np.cos(polar), strand * sine * np.sin(azimuth)
    up = sine * np.cos(azimuth)
    for m in range(3):
        end[1, m] = along * axes[0, m] + across * axes[1, m] + up * axes[2, m]
    binormal, turned = np.empty(3, np.complex128), np.empty(3, np.complex128)
    _cross(axes[0], end[1], binormal)
    _cross(end[1], binormal, turned)
    bend, cosine, sine = kappa / sine, np.cos(normal), np.sin(normal)
    for m in range(3):
        end[2, m] = bend * (cosine * binormal[m] + sine * turned[m])


@compiled
def _crossover(p: ComplexArray) -> ComplexArray:
    """Ends A0, A1, B0, B1 of crossover 1: position, tangent, curvature vector, shape (4, 3, 3)."""
    last_axes, first_axes = np.empty((3, 3), np.complex128), np.empty((3, 3), np.complex128)
    _frame(p, last_axes)
    sine, cosine = np.sin(p[25]), np.cos(p[25])
    for m in range(3):
        first_axes[0, m] = cosine * last_axes[0, m] + sine * last_axes[1, m]
        first_axes[1, m] = cosine * last_axes[1, m] - sine * last_axes[0, m]
        first_axes[2, m] = last_axes[2, m]
    along, across = p[5] * np.cos(p[6]), p[5] * np.sin(p[6])
    ends = np.empty((4, 3, 3), np.complex128)
    for strand in range(2):
        sign = 1.0 - 2.0 * strand
        first, last = ends[2 * strand], ends[2 * strand + 1]
        for m in range(3):
            centre = 0.5 * p[0] if m == 0 else 0.5 * p[1] if m == 2 else 0.0 * p[0]
            first[0, m] = -along * last_axes[2, m] - sign * across * first_axes[1, m] - centre
            last[0, m] = along * last_axes[2, m] + sign * across * last_axes[1, m] - centre
        _direct(first, p, 7 if strand == 0 else 19, first_axes, sign, 1.0)
        _direct(last, p, 13 if strand == 0 else 7, last_axes, sign, -1.0)
    return ends


@compiled
def _moved(
    ends: ComplexArray, mirror_x: float, mirror_z: float, x: complex, y: complex
) -> ComplexArray:
    """Ends mirrored in x (-1: run through in the other sense) and z, and shifted."""
    out = np.empty(ends.shape, np.complex128)
    for k in range(ends.shape[0]):
        for i in range(3):
            sense = mirror_x if i == 1 else 1.0
            out[k, i, 0] = mirror_x * sense * ends[k, i, 0]
            out[k, i, 1] = sense * ends[k, i, 1]
            out[k, i, 2] = mirror_z * sense * ends[k, i, 2]
        out[k, 0, 0] += x
        out[k, 0, 1] += y
    return out


@compiled
def _bezier(
    start: ComplexArray,
    alpha0: complex,
    beta0: complex,
    end: ComplexArray,
    alpha1: complex,
    beta1: complex,
    out: ComplexArray,
) -> None:
    for m in range(3):
        out[0, m] = start[0, m]
        out[1, m] = start[0, m] + alpha0 * start[1, m] / 5.0
        out[2, m] = out[1, m] + alpha0 * alpha0 * start[2, m] / 20.0 + beta0 * start[1, m]
        out[5, m] = end[0, m]
        out[4, m] = end[0, m] - alpha1 * end[1, m] / 5.0
        out[3, m] = out[4, m] + alpha1 * alpha1 * end[2, m] / 20.0 - beta1 * end[1, m]


@compiled
def control_points(p: ComplexArray, course_odd: bool, wale_odd: bool) -> ComplexArray:
    """Control points, mm, shape (8 curves, 6 points, 3), from the 34 parameters.

    Everything is complex so that an imaginary step gives exact derivatives.
    """
    none = 0.0 * p[33]
    lower = _crossover(p)
    upper = _moved(lower, 1.0, -1.0 if wale_odd else 1.0, none, p[33])
    following = _moved(lower, 1.0, -1.0 if course_odd else 1.0, p[32], none)[2]
    right, upper_right = _moved(lower, -1.0, 1.0, none, none), _moved(upper, -1.0, 1.0, none, none)
    shared, a1, b0 = (p[9], p[12]), (p[15], p[18]), (p[21], p[24])
    c12, c21, c11 = (p[26], p[27]), (p[28], p[29]), (p[30], p[31])

    out = np.empty((8, 6, 3), dtype=np.complex128)
    _bezier(lower[2], b0[0], b0[1], lower[3], shared[0], shared[1], out[0])
    _bezier(lower[3], c11[0], c11[1], upper[0], c11[0], c11[1], out[1])
    _bezier(upper[0], shared[0], shared[1], upper[1], a1[0], a1[1], out[2])
    _bezier(upper[1], c12[0], c12[1], upper_right[1], c12[0], c12[1], out[3])
    _bezier(upper_right[1], a1[0], a1[1], upper_right[0], shared[0], shared[1], out[4])
    _bezier(upper_right[0], c11[0], c11[1], right[3], c11[0], c11[1], out[5])
    _bezier(right[3], shared[0], shared[1], right[2], b0[0], b0[1], out[6])
    _bezier(right[2], c21[0], c21[1], following, c21[0], c21[1], out[7])
    return out


@compiled
def control_points_and_jacobian(
    parameters: Array, course_odd: bool, wale_odd: bool
) -> tuple[Array, Array]:
    """Control points (8, 6, 3) and their derivatives (34, 8, 6, 3) by the complex step."""
    count = parameters.shape[0]
    p = np.empty(count, np.complex128)
    for i in range(count):
        p[i] = parameters[i]
    controls, jacobian = np.empty((8, 6, 3)), np.empty((count, 8, 6, 3))
    step = 1e-30
    for i in range(count):
        p[i] += step * 1j
        points = control_points(p, course_odd, wale_odd)
        for curve in range(8):
            for k in range(6):
                for m in range(3):
                    jacobian[i, curve, k, m] = points[curve, k, m].imag / step
                    controls[curve, k, m] = points[curve, k, m].real
        p[i] -= step * 1j
    return controls, jacobian
