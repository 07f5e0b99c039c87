"""The heavy elastica: a rod clamped horizontally at one end that hangs under its own weight.

With arc length ``s`` in units of the hanging length L and the angle ``theta`` below the horizontal,
moment balance reads

    theta'' = -load (1 - s) cos(theta),   theta(0) = 0,   theta'(1) = 0,
    load = weight_per_length * L**3 / B,

so the shape depends on one number only.
"""

import numpy as np
import scipy

from knitcore.base.arrays import Array
from knitcore.base.bounds import check_range
from knitcore.base.errors import ConvergenceError

NODES = 401
MAX_LOAD = 1e6
"""Largest load; beyond it the bend is shorter than a hundredth of the yarn: no photo shows it."""


def heavy_elastica(load: float) -> tuple[Array, Array, Array]:
    """Arc length, horizontal distance and depth of a hanging rod, all in units of its length.

    Parameters
    ----------
    load : dimensionless weight, w L**3 / B, between 0 and 1e6.

    Returns
    -------
    (s, x, y), each of shape (NODES,); nodes are denser near the clamp.

    Raises
    ------
    InputError
        If the load is negative, not a number or too large.
    ConvergenceError
        If Newton's method does not converge.

    Examples
    --------
    A nearly weightless rod sags like a beam, by load / 8:

    >>> s, x, y = heavy_elastica(0.01)
    >>> round(float(y[-1] / 0.01), 4)
    0.125
    """
    check_range("load", load, 0, MAX_LOAD)
    # Even nodes in u with s = u**2 resolve the bend of a long yarn.
    u = np.linspace(0.0, 1.0, NODES)
    s = u**2
    left, right = np.diff(s)[:-1], np.diff(s)[1:]
    lower = 2.0 / (left * (left + right))
    upper = 2.0 / (right * (left + right))
    pull = load * (1.0 - s[1:-1])
    theta = np.pi / 2 * (1 - np.exp(-s * np.cbrt(load)))
    last = s[-1] - s[-2]
    for _ in range(100):
        residual = np.empty(NODES)
        residual[0] = theta[0]
        residual[1:-1] = (
            lower * theta[:-2]
            - (lower + upper) * theta[1:-1]
            + upper * theta[2:]
            + pull * np.cos(theta[1:-1])
        )
        # At the free end theta'' = 0 as well, so theta is flat to third order there.
        residual[-1] = (theta[-1] - theta[-2]) / last
        bands = np.zeros((3, NODES))
        bands[1, 0] = 1.0
        bands[0, 2:] = upper
        bands[1, 1:-1] = -(lower + upper) - pull * np.sin(theta[1:-1])
        bands[2, :-2] = lower
        bands[1, -1], bands[2, -2] = 1 / last, -1 / last
        step = scipy.linalg.solve_banded((1, 1), bands, residual)
        theta = theta - step * min(1.0, 0.5 / max(float(np.abs(step).max()), 1e-300))
        if np.abs(step).max() < 1e-11:
            break
    else:
        raise ConvergenceError(f"heavy elastica: no convergence at load {load:.3g}.")
    # d(s) = 2 u du
    x = scipy.integrate.cumulative_simpson(np.cos(theta) * 2 * u, x=u, initial=0.0)
    y = scipy.integrate.cumulative_simpson(np.sin(theta) * 2 * u, x=u, initial=0.0)
    return s, np.asarray(x), np.asarray(y)
