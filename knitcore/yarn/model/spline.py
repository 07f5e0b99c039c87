"""Uniform quintic B-splines of a periodic yarn.

A course is one curve gamma(t), t in stitches: control points sit at t = c / N and a sample at t
depends on the six nearest of them. Quintic splines have four continuous derivatives, so bending
and the regularisation |d²t/ds²|² are integrated without kinks at the knots.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np

from knitcore.base.arrays import Array

DEGREE = 5
SUPPORT = DEGREE + 1
DERIVATIVES = 4
"""Value and three derivatives are tabulated."""


def quintic_basis(offset: Array, derivative: int) -> Array:
    """Basis functions of the six control points around a span.

    Parameters
    ----------
    offset : array (n,)
        Place in the span, 0 to 1.
    derivative : 0 to 5, with respect to the offset.

    Returns
    -------
    array (n, 6)
        Column a belongs to the control point ``span - 2 + a``.
    """
    u = np.asarray(offset, dtype=float)
    distance = u[:, None] + 2.0 - np.arange(SUPPORT)[None, :]  # u - (position of the control point)
    powers = np.arange(SUPPORT + 1)
    coefficient = np.array(
        [(-1.0) ** k * factorial(6) / factorial(k) / factorial(6 - k) for k in powers]
    )
    shifted = distance[..., None] + 3.0 - powers
    degree = DEGREE - derivative
    truncated = np.where(shifted > 0.0, _power(shifted, degree), 0.0)
    basis: Array = (truncated * coefficient).sum(axis=-1) / factorial(degree)
    return basis


def _power(base: Array, exponent: int) -> Array:
    """A power by products, whose last digits are the same on every processor."""
    power: Array = np.prod(np.broadcast_to(base, (exponent, *base.shape)), axis=0)
    return power


@dataclass(frozen=True)
class SplineGrid:
    """Resolution of a yarn curve.

    Parameters
    ----------
    controls : control points per stitch.
    per_span : samples (quadrature and contact points) per control point.
    """

    controls: int = 16
    per_span: int = 5

    @property
    def samples(self) -> int:
        """Samples per stitch."""
        return self.controls * self.per_span

    @cached_property
    def basis(self) -> Array:
        """Array (4, per_span, 6): derivatives with respect to t at the mid-point samples."""
        offset = (np.arange(self.per_span) + 0.5) / self.per_span
        return np.stack(
            [quintic_basis(offset, d) * float(self.controls) ** d for d in range(DERIVATIVES)]
        )

    def interpolate(self, values: Array, *, antiperiodic: bool = False) -> Array:
        """Control values whose spline passes through ``values`` at the knots t = c / N.

        Parameters
        ----------
        values : array (n,), one period.
        antiperiodic : the curve changes sign from one period to the next.
        """
        n = len(values)
        data = np.concatenate([values, -values]) if antiperiodic else values
        weights = quintic_basis(np.array([0.0]), 0)[0, :5]  # controls -2 … 2 of a knot
        kernel = np.zeros(len(data))
        for shift, weight in zip(range(-2, 3), weights, strict=True):
            kernel[shift % len(data)] += weight
        spectrum = np.fft.rfft(data) / np.fft.rfft(kernel)
        return np.fft.irfft(spectrum, len(data))[:n]

    def refine(self, finer: SplineGrid, controls: Array) -> Array:
        """Control points (n, 3) of the same periodic curve on a finer grid (interpolated)."""
        ratio = finer.controls / self.controls
        n_fine = round(len(controls) * ratio)
        place = np.arange(n_fine) / ratio
        span = np.floor(place + 1e-12).astype(int)
        weights = quintic_basis(place - span, 0)
        index = (span[:, None] - 2 + np.arange(SUPPORT)) % len(controls)
        values = np.einsum("ia,ia...->i...", weights, controls[index])
        return np.stack([finer.interpolate(v) for v in values.T], axis=-1)
