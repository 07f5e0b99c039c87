"""Arrays of numbers: their type, and stretches of equal values in them."""

from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


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
