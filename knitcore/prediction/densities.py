"""Densities of a chart: descriptors of its mixture of stitches, as means over the stitches.

Each density is the mean of a property of a stitch and its neighbourhood. So densities do not change
when a chart is shifted, mirrored, turned over, tiled, or has K and P swapped, and one stitch in n
changes them by about 1/n. With the signs s = +1 (K) and -1 (P) they are

- the shares of stitches with 0, 1 or 2 odd segments course-wise and as many wale-wise,
- products of s at two stitches some lag apart, and of four: in a square, in the corners of one two
  rows high, and in a row,
- squares of s smoothed along the course, along the wale, and both ways,
- squared sines of the slopes of a plate on an elastic bed that the stitches bend: a knit curls one
  way, a purl the other, oppositely along course and wale, so that ribs and welts fold. In Fourier
  space the plate's deflection is k_x² s / (k⁴ + q⁴) course-wise and k_y² s / (k⁴ + q⁴) wale-wise.

The values of the pure fabrics, weighted by their shares, are subtracted from each: a density is 0
in a pure fabric, and small where large areas of pure fabrics meet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import PHASES
from knitcore.chart.stitch_chart import StitchChart

_LAGS = ((0, 2), (0, 3), (0, 4), (2, 0), (3, 0), (4, 0), (1, 2), (2, 1), (2, 2))
"""Lags, rows up and columns right; those of (0, 1), (1, 0) and (1, 1) follow from the shares."""
_PAIRS = ((1, 0), (2, 0), (0, 2))
"""Lags between two pairs of neighbours in a row."""
_SMOOTHED_OVER = (1.5, 4.0)
"""Standard deviations, in stitches, of the weights that smooth s."""
_BEDS = (0.3, 0.9)
"""q: a plate's folds reach about 1 / q stitches."""
FEATURES = {
    "shares": 3,
    "sides": 8,
    "products of two": len(_LAGS),
    "products of four": len(_PAIRS),
    "plates": 6 * len(_BEDS),
    "smoothed": 3 * len(_SMOOTHED_OVER),
}
"""Number of features of each kind, in their order."""
Mean = Callable[[NDArray[np.generic]], Array]
"""Function that averages values of the stitches (…, rows, columns)."""
_NO_CHANGE = 1e-12
_FEW_CROSSINGS = 0.1
"""Share of stitches with odd segments both ways, among those with any, at which a chart counts as
half two-dimensional."""

_FEW_OTHERS = 0.05
"""Share of other fabrics at which a chart is about as uncertain as a mixed one."""


@dataclass(frozen=True, eq=False)
class Densities:
    """Composition of charts; leading axes (…) are those of the charts.

    Attributes
    ----------
    shares : (…, 4) shares of the pure fabrics among the quarter cells, by phase code.
    excess : (…, densities) less those of the pure fabrics, weighted by the shares.
    straight : (…, 2) straightness of the fold lines, from 0 to 1. First along columns, which folds
        the width: 1 in a rib, 0 in a welt and in stockinette; then along rows: 1 in a welt.
    even : (…, 2) how even the runs beside those lines are, from 0 to 1: 1 in KKPP, 0.4 in KKKP.
    ways : (…, 4) parts, adding up to 1, in which the chart is a rib, a welt, and neither, by its
        odd segments: along the course, along the wale, and at one stitch along both. Of the last,
        sparse purls (or knits) come last: all of it where they are a seventh of all stitches, none
        where they are half of them.
    """

    shares: Array
    excess: Array
    straight: Array
    even: Array
    ways: Array

    @property
    def arrays(self) -> tuple[Array, Array, Array, Array, Array]:
        """All of them, in the order in which they are given."""
        return self.shares, self.excess, self.straight, self.even, self.ways

    @property
    def mixed(self) -> Array:
        """Uncertainty of the model for a chart over that for a mixed one, (…,).

        It is 0 in a pure fabric, and nearly 1 from a tenth of other fabrics on.
        """
        return np.asarray(1 - np.exp((self.shares.max(axis=-1) - 1) / _FEW_OTHERS))

    @property
    def uncertainty(self) -> Array:
        """(…, 4) weights of the model's scales of uncertainty: ways, less near a pure fabric."""
        return np.asarray(self.mixed[..., None] * self.ways)

    @property
    def features(self) -> Array:
        """Shares (without stockinette's, which the others leave) and excess."""
        return np.concatenate([self.shares[..., 1:], self.excess], axis=-1)

    def towards(self, other: Densities, share: float) -> Densities:
        """Densities between these (share 0) and others (1)."""
        pairs = zip(self.arrays, other.arrays, strict=True)
        return Densities(*((1 - share) * own + share * theirs for own, theirs in pairs))

    def __iter__(self) -> Iterator[Densities]:
        """Iterate over the compositions of the single charts."""
        return (Densities(*chart) for chart in zip(*self.arrays, strict=True))


def _mean(values: NDArray[np.generic]) -> Array:
    """Mean over the stitches."""
    return np.asarray(values.mean(axis=(-2, -1)))


def densities(chart: StitchChart) -> Densities:
    """Densities of a repeat.

    Examples
    --------
    >>> rib = densities(StitchChart.parse("KKPP"))
    >>> rib.shares.tolist(), rib.straight.round(2).tolist()
    ([0.5, 0.0, 0.5, 0.0], [1.0, 0.0])
    """
    return densities_of(chart.purl)


def densities_of(purl: NDArray[np.bool_], mean: Mean = _mean) -> Densities:
    """Densities of repeats of one size, bool (…, rows, columns).

    Parameters
    ----------
    purl : the repeats.
    mean : what takes means of values of the stitches (…, rows, columns); of all stitches of a
        repeat, or of those of each of its parts.
    """
    sign = np.where(purl, -1.0, 1.0)
    odd_course, odd_wale = _odd_sides(sign, -1), _odd_sides(sign, -2)
    seed = mean(odd_course * odd_wale) / 4
    garter, rib = mean(odd_wale) / 2 - seed, mean(odd_course) / 2 - seed
    shares = np.stack([1 - garter - rib - seed, garter, rib, seed], axis=-1)
    values = _values(sign, mean)
    # even columns (rows), times changes from one to the next that go on upwards (across)
    straight = values[..., [-1, -2]] * _lines(sign, mean)
    both = mean((odd_course > 0) & (odd_wale > 0))
    either = mean((odd_course > 0) | (odd_wale > 0))
    neither = both / (both + _FEW_CROSSINGS * either + _NO_CHANGE)
    course = (rib + seed + _NO_CHANGE) / (rib + garter + 2 * seed + 2 * _NO_CHANGE)
    one_sided = mean(sign) ** 2
    sparse = 4 * one_sided * (1 - one_sided)
    parts = course * (1 - neither), (1 - course) * (1 - neither)
    ways = np.stack([*parts, neither * (1 - sparse), neither * sparse], axis=-1)
    return Densities(shares, values - shares @ _pure(), straight, _evenness(sign, mean), ways)


@cache
def _pure() -> Array:
    """(4, densities) of the pure fabrics."""
    charts = [StitchChart.of_fabric(fabric) for fabric in PHASES]
    return np.array([_values(np.where(chart.purl, -1.0, 1.0), _mean) for chart in charts])


def _values(sign: Array, mean: Mean) -> Array:
    """(…, densities), the squares of s smoothed along the course and along the wale last."""
    odd_course, odd_wale = _odd_sides(sign, -1), _odd_sides(sign, -2)
    sides = [(i, j) for i in range(3) for j in range(3) if i + j > 0]
    values = [mean((odd_course == i) & (odd_wale == j)) for i, j in sides]
    values += [mean(_product(sign, up, right)) for up, right in _LAGS]
    pair = sign * _lagged(sign, 0, 1)
    values += [mean(pair * _lagged(pair, up, right)) for up, right in _PAIRS]
    kx, ky, back = _waves(sign)
    for bed in _BEDS:
        bent = 1 / ((kx**2 + ky**2) ** 2 + bed**4)
        for slope in (kx, ky):
            course, wale = (_leaning(back(slope * k**2 * bent)) for k in (kx, ky))
            values += [mean(course * course), mean(course * wale), mean(wale * wale)]
    for length in _SMOOTHED_OVER:
        along, up = _weights(kx, length), _weights(ky, length)
        values += [mean(back(weights) ** 2) for weights in (along * up, along, up)]
    return np.stack(values, axis=-1)


def _lines(sign: Array, mean: Mean) -> Array:
    """(…, 2) part of the changes from column to column that goes on upwards; of those of rows."""
    kx, ky, back = _waves(sign)
    shares = []
    for across, along in ((kx, ky), (ky, kx)):
        change = np.sin(across / 2)
        plain = mean(back(change) ** 2)
        smooth = mean(back(change * _weights(along, _SMOOTHED_OVER[-1])) ** 2)
        shares.append(np.divide(smooth, plain, out=np.zeros_like(plain), where=plain > _NO_CHANGE))
    return np.stack(shares, axis=-1)


def _evenness(sign: Array, mean: Mean) -> Array:
    """(…, 2) how even runs of K and P are beside the changes along the course, then the wale.

    In a folded rib the shorter runs hide behind the longer ones, so the width falls at most to the
    share of the longer: by ln 2 if the runs are equal, by ln 6/5 if one column in six is purl
    (Spencer, *Knitting Technology*, on 1×1 and 6×3 ribs). This is that logarithm over ln 2, the
    mean over all changes.
    """
    kx, ky, back = _waves(sign)
    means = []
    for across, axis in ((kx, -1), (ky, -2)):
        longer = 1 + np.abs(back(_weights(across, _SMOOTHED_OVER[-1])))
        changes = _odd_sides(sign, axis)
        even = mean(changes * (1 - np.log2(np.minimum(longer, 2.0))))
        number = mean(changes)
        means.append(np.divide(even, number, out=np.zeros_like(even), where=number > _NO_CHANGE))
    return np.stack(means, axis=-1)


def _waves(sign: Array) -> tuple[Array, Array, Callable[[Array], Array]]:
    """|k_x|, |k_y| (rad a stitch), and s with its Fourier components multiplied by weights."""
    rows, columns = sign.shape[-2:]
    wave = np.fft.rfft2(sign)
    kx = np.asarray(2 * np.pi * np.fft.rfftfreq(columns)[None, :])
    ky = np.asarray(2 * np.pi * np.abs(np.fft.fftfreq(rows))[:, None])

    def back(weights: Array) -> Array:
        return np.asarray(np.fft.irfft2(wave * weights, s=(rows, columns)))

    return kx, ky, back


def _weights(k: Array, length: float) -> Array:
    """Fourier transform of Gaussian weights."""
    return np.exp(-((k * length) ** 2) / 2)


def _odd_sides(sign: Array, axis: int) -> Array:
    """Number of odd segments of each stitch along an axis, 0 to 2."""
    odd = sign != np.roll(sign, -1, axis=axis)
    return np.asarray(odd + np.roll(odd, 1, axis=axis).astype(float))


def _lagged(sign: Array, up: int, right: int) -> Array:
    return np.roll(sign, (-up, -right), axis=(-2, -1))


def _product(sign: Array, up: int, right: int) -> Array:
    """s times s at a lag, the mean of both diagonals."""
    there = _lagged(sign, up, right)
    if up and right:
        there = (there + _lagged(sign, up, -right)) / 2
    return np.asarray(sign * there)


def _leaning(slope: Array) -> Array:
    """Sine of the angle: however steep, it stays below 1."""
    return np.asarray(slope / np.sqrt(1.0 + slope**2))
