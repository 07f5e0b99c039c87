"""Arrays of numbers: their type, random ones, and stretches of equal values in them."""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


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
