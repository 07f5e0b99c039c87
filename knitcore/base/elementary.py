"""Elementary functions, compiled, whose last digit is the same on every processor.

Those of the system's mathematical library differ in it between processors with and without fused
products. These are sums and products alone, with relative errors of some 1e-15.
"""

import math

import numpy as np

from knitcore.base.compiled import compiled

_MANTISSA, _ONE = 0x000FFFFFFFFFFFFF, 0x3FF0000000000000
_ROOT_2 = 1.4142135623730951
_LN_2 = 0.6931471805599453
_HIGHEST = 1 / 3628800 + 0.12 / 479001600, 1 / 39916800 + 0.12 / 6227020800
"""Last coefficients of cosh and sinh, which take in the next ones at x² = 0.12, the largest."""
_TAN_22_5 = 0.41421356237309503


@compiled
def _parts(value: float) -> tuple[int, float]:
    """Exponent of two, and the logarithm of what it leaves of a normal number > 0.

    What is left, m, lies between the roots of 1/2 and 2: log m = 2 artanh((m - 1) / (m + 1)).
    """
    bits = np.float64(value).view(np.int64)
    whole = (bits >> 52) - 1023
    part = np.int64((bits & _MANTISSA) | _ONE).view(np.float64)
    if part > _ROOT_2:
        part *= 0.5
        whole += 1
    s = (part - 1.0) / (part + 1.0)
    square = s * s
    q = square * square  # two sums side by side take half as long
    from_fifth = 1 / 5 + q * (1 / 9 + q * (1 / 13 + q * (1 / 17 + q * (1 / 21))))
    from_third = 1 / 3 + q * (1 / 7 + q * (1 / 11 + q * (1 / 15 + q * (1 / 19))))
    return int(whole), 2.0 * (s + s * (square * from_third + q * from_fifth))


@compiled
def log(value: float) -> float:
    """Natural logarithm of a normal number > 0."""
    whole, rest = _parts(value)
    return float(whole * _LN_2 + rest)


@compiled
def power(base: float, exponent: float) -> float:
    """``base ** exponent`` for a normal base > 0 and a normal result."""
    whole, rest = _parts(base)
    y = exponent * (whole + rest * (1.0 / _LN_2))
    twos = np.floor(y + 0.5)
    x = (y - twos) * _LN_2
    q = x * x
    even = 1 + q * (1 / 2 + q * (1 / 24 + q * (1 / 720 + q * (1 / 40320 + q * _HIGHEST[0]))))
    odd = 1 + q * (1 / 6 + q * (1 / 120 + q * (1 / 5040 + q * (1 / 362880 + q * _HIGHEST[1]))))
    return float((even + x * odd) * np.int64((np.int64(twos) + 1023) << 52).view(np.float64))


@compiled
def arctan2(y: float, x: float) -> float:
    """Angle of the point (x, y) from the x axis, rad."""
    if x == 0.0 and y == 0.0:
        return 0.0
    steep = abs(y) > abs(x)
    t = abs(x) / abs(y) if steep else abs(y) / abs(x)
    turned = t > _TAN_22_5
    if turned:
        t = (t - 1.0) / (t + 1.0)
    square = t * t
    series = 1.0 / 43.0
    for odd in range(41, 0, -2):
        series = 1.0 / odd - series * square
    angle = t * series + (0.25 * math.pi if turned else 0.0)
    if steep:
        angle = 0.5 * math.pi - angle
    if x < 0.0:
        angle = math.pi - angle
    return float(-angle if y < 0.0 else angle)
