"""Arrays of numbers: their type, sums, rounded and random ones, and stretches of equal values."""

from collections.abc import Iterable
from functools import reduce
from itertools import pairwise
from operator import add
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]
Codes = NDArray[np.uint8]
Addend = TypeVar("Addend", float, Array)


def sum_in_order(values: Iterable[Addend]) -> Addend:
    """Sum from the first to the last; Python's own rounds otherwise from 3.12 on.

    Examples
    --------
    >>> sum_in_order([0.1] * 10) == 0.1 + 0.1 + 0.1 + 0.1 + 0.1 + 0.1 + 0.1 + 0.1 + 0.1 + 0.1
    True
    """
    return reduce(add, values)


def rounded(values: ArrayLike) -> Array:
    """Round numbers to 36 binary digits, which are about eleven decimal ones.

    What begins a search is given without its last digits, since these differ between processors.

    Examples
    --------
    >>> float(rounded(0.1 + 1e-15)) == float(rounded(0.1))
    True
    """
    part, exponent = np.frexp(np.asarray(values, dtype=float))
    return np.asarray(np.ldexp(np.rint(np.ldexp(part, 36)), exponent - 36))


def scattered(shape: tuple[int, ...], size: float, seed: int) -> Array:
    """Random numbers of a root mean square ``size``, spread evenly about zero.

    They come from a counter (Philox) and exact arithmetic, so that they are the same everywhere.
    """
    even = np.random.Generator(np.random.Philox(key=seed)).random(shape)
    return np.asarray(size * np.sqrt(3.0) * (2.0 * even - 1.0))


def runs(values: ArrayLike) -> list[tuple[int, int, int]]:
    """Stretches of equal whole numbers: first place, the place after the last, and the number.

    Examples
    --------
    >>> runs([0, 0, 2])
    [(0, 2, 0), (2, 3, 2)]
    """
    line = np.asarray(values)
    edges = [0, *(np.flatnonzero(np.diff(line)) + 1).tolist(), len(line)]
    return [(start, stop, int(line[start])) for start, stop in pairwise(edges)]
