"""Densities of a chart: what its mixture of stitches is like, as means over the stitches.

Each density is the mean of a field over the chart, and each field at a stitch depends on its
neighbourhood alone. So densities do not change when a chart is shifted, mirrored, turned over,
seen with K and P swapped, or tiled; one stitch in n changes them by about 1/n; and the mean over a
window describes a part of a large chart.

With the signs s = +1 (K) and -1 (P) the fields are

- whether a stitch has 0, 1 or 2 odd segments course-wise and as many wale-wise,
- products of s at two stitches some lag apart, and of four in a square,
- squares of s smoothed along the course, along the wale, and both ways,
- squared sines of the slopes of a plate on an elastic bed that the stitches bend: a knit curls one
  way, a purl the other, oppositely along course and wale, so that ribs and welts fold. In Fourier
  space the plate's deflection is k_x² s / (k⁴ + q⁴) course-wise and k_y² s / (k⁴ + q⁴) wale-wise.

From each, the values of the pure fabrics are taken off, weighted by their shares: a density is 0 in
a pure fabric, and small where large areas of pure fabrics meet.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from knitcore.chart import StitchChart
from knitcore.fabric import PHASES
from knitcore.phases import ABOVE, BELOW, LEFT, QUARTERS_OF_CODE, RIGHT, surroundings

Array = NDArray[np.float64]

_LAGS = ((0, 2), (0, 3), (0, 4), (2, 0), (3, 0), (4, 0), (1, 1), (1, 2), (2, 1), (2, 2))
_SMOOTHED_OVER = (1.5, 4.0)
"""Standard deviations, in stitches, of the weights that smooth s."""
_BEDS = (0.3, 0.9)
"""q: a plate's folds reach about 1 / q stitches."""


@dataclass(frozen=True, eq=False)
class Densities:
    """What a chart is made of.

    Attributes
    ----------
    shares : (4,) shares of the pure fabrics among the quarter cells, by phase code.
    excess : densities less those of the pure fabrics, weighted by the shares.
    straight : (2,) how straight fold lines run on, from 0 to 1. First along columns, which folds
        the width: 1 in a rib, 0 in a welt and in stockinette; then along rows: 1 in a welt.
    """

    shares: Array
    excess: Array
    straight: Array

    @property
    def features(self) -> Array:
        """Shares (without stockinette's, which the others leave) and excess."""
        return np.concatenate([self.shares[1:], self.excess])


def densities(chart: StitchChart) -> Densities:
    """Densities of a repeat.

    Examples
    --------
    >>> found = densities(StitchChart.parse("KKPP"))
    >>> found.shares.tolist(), found.straight.round(2).tolist()
    ([0.5, 0.0, 0.5, 0.0], [1.0, 0.0])
    """
    return of_means(local_fields(chart).mean(axis=(1, 2)))


def of_means(fields: Array) -> Densities:
    """Densities from the means of :func:`local_fields` over a chart or a part of it."""
    shares, values = fields[:4], fields[4:-4]
    changes, smoothed = fields[-4::2], fields[-3::2]
    # even columns, times changes from one to the next that go on upwards; and so for rows
    lines = np.divide(smoothed, changes, out=np.zeros(2), where=changes > 1e-12)
    return Densities(shares, values - shares @ _pure(), values[[-1, -2]] * lines)


@cache
def _pure() -> Array:
    """(4, densities) of the pure fabrics."""
    charts = [StitchChart.of_fabric(fabric, 2, 2) for fabric in PHASES]
    return np.array([local_fields(chart)[4:-4].mean(axis=(1, 2)) for chart in charts])


def local_fields(chart: StitchChart) -> Array:
    """(fields, rows, columns) of a repeat: the four shares, the densities' fields, fold lines."""
    sign = np.where(chart.purl, -1.0, 1.0)
    codes = surroundings(chart, periodic=True)
    course = ((codes & LEFT) > 0).astype(int) + ((codes & RIGHT) > 0)
    wale = ((codes & BELOW) > 0).astype(int) + ((codes & ABOVE) > 0)
    fields = [*_SHARE_OF_CODE[:, codes]]
    fields += [(course == i) & (wale == j) for i in range(3) for j in range(3) if i + j > 0]
    fields += [_product(sign, up, right) for up, right in _LAGS]
    fields.append(sign * _lagged(sign, 0, 1) * _lagged(sign, 1, 0) * _lagged(sign, 1, 1))
    fields += _smoothed(sign)
    return np.array(fields, dtype=float)


_SHARE_OF_CODE = np.stack(
    [(QUARTERS_OF_CODE.reshape(16, 4) == phase).mean(axis=1) for phase in range(4)]
)


def _lagged(sign: Array, up: int, right: int) -> Array:
    return np.roll(sign, (-up, -right), axis=(0, 1))


def _product(sign: Array, up: int, right: int) -> Array:
    """s times s at a lag, in the mean of both diagonals."""
    there = _lagged(sign, up, right)
    if up and right:
        there = (there + _lagged(sign, up, -right)) / 2
    return sign * there


def _leaning(slope: Array) -> Array:
    """Sine of the angle: however steep, it stays below 1."""
    return np.asarray(slope / np.sqrt(1.0 + slope**2))


def _smoothed(sign: Array) -> list[Array]:
    """Leanings of the plates, squares of s smoothed, squares of changes of s (plain, smoothed)."""
    rows, columns = sign.shape
    wave = np.fft.rfft2(sign)
    ky = 2 * np.pi * np.fft.fftfreq(rows)[:, None]
    kx = 2 * np.pi * np.fft.rfftfreq(columns)[None, :]

    def back(factor: Array) -> Array:
        return np.asarray(np.fft.irfft2(wave * factor, s=sign.shape))

    fields = []
    square = kx**2 + ky**2
    for bed in _BEDS:
        bent = 1 / (square**2 + bed**4)
        for slope in (np.abs(kx), np.abs(ky)):
            course, wale = (_leaning(back(slope * k**2 * bent)) for k in (kx, ky))
            fields += [course * course, course * wale, wale * wale]
    for length in _SMOOTHED_OVER:
        along, up = (np.exp(-((k * length) ** 2) / 2) for k in (kx, ky))
        # both ways, then along the course (rows), then along the wale (columns)
        fields += [back(f) ** 2 for f in (along * up, along + 0 * square, up + 0 * square)]
    for k, smooth in ((kx, up), (ky, along)):
        change = np.abs(np.sin(k / 2))
        fields += [back(change + 0 * square) ** 2, back(change * smooth) ** 2]
    return fields
