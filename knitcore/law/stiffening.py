"""The strain-stiffening term of the constitutive law, as functions of s = alpha * strain.

With ``w``, ``w'`` and ``w''`` from here, a direction's stiffening energy density is
``beta / alpha * w(s)``, its stress ``beta * w'(s)`` and its stiffness ``alpha * beta * w''(s)``.

Two forms by name:

``full``
    The law as the paper states it (Note 7), ``w = s**3 / (1 - s)``, for ``0 <= s <= 0.98``. Slack
    yarn does not stiffen, so ``w = 0`` for ``s < 0``; continued to compression the printed term
    loses convexity in half of the paper's rows. Beyond 0.98 (1 is the lock-up) the energy goes on
    as its osculating quadratic, twice continuously differentiable, so that a solver may overshoot.
``published``
    What the paper's finite-element demonstration solved (Note 9): the energy truncated at quartic
    order in the strain, ``w = s**3 + s**4``, in tension and compression. It never locks.
"""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

EXTENSION_START = 0.98
"""s above which the full form is continued by its osculating quadratic."""


class StiffeningForm(StrEnum):
    """Which form of the stiffening term is meant."""

    FULL = "full"
    PUBLISHED = "published"


def stiffening(
    s: ArrayLike, form: StiffeningForm = StiffeningForm.FULL
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """``w``, ``w'`` and ``w''`` at s (dimensionless arrays of the shape of s)."""
    x = np.asarray(s, dtype=float)
    if form is StiffeningForm.PUBLISHED:
        return x**3 * (1 + x), x**2 * (3 + 4 * x), x * (6 + 12 * x)
    inside = np.clip(x, 0.0, EXTENSION_START)
    gap = 1.0 - inside
    energy = inside**3 / gap
    slope = inside**2 * (3 - 2 * inside) / gap**2
    curvature = 2.0 / gap**3 - 2.0
    beyond = np.maximum(x - EXTENSION_START, 0.0)
    energy = energy + slope * beyond + 0.5 * curvature * beyond**2
    slope = slope + curvature * beyond
    return energy, slope, curvature
