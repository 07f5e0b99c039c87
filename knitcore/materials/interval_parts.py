"""Parts that an interval is made of: what is not known, and how much of the variance it makes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from knitcore.base.arrays import Array
from knitcore.base.choice import Choice


class Part(Choice):
    """A thing that is not known about a predicted number."""

    SIZE = "size at rest"
    SURROUNDINGS = "surroundings of a stitch"
    LAW = "stretch tests of the pure fabrics"
    YARN = "stretch of other yarns"
    YARN_PER_STITCH = "yarn per stitch"
    OTHER_STITCHES = "other stitches"


Variances = Mapping[Part, Array]
"""Variances of the logarithm of a number by part; arrays of one shape."""


def added(variances: Iterable[Variances]) -> dict[Part, Array]:
    """Sums by part of independent variances.

    Examples
    --------
    >>> half = {Part.LAW: np.array(0.5)}
    >>> {str(part): float(of) for part, of in added([half, half]).items()}
    {'stretch tests of the pure fabrics': 1.0}
    """
    total: dict[Part, Array] = {}
    for each in variances:
        for part, of in each.items():
            total[part] = total[part] + of if part in total else np.asarray(of, dtype=float)
    return total


def deviation(variances: Variances) -> Array:
    """Standard deviation of all parts together."""
    return np.sqrt(sum(variances.values(), np.zeros(())))


def shared_out(variance: Array, among: Variances) -> dict[Part, Array]:
    """Share a variance out among parts, in proportion to theirs.

    Examples
    --------
    >>> parts = {Part.SIZE: np.array(3.0), Part.LAW: np.array(1.0)}
    >>> [float(of) for of in shared_out(np.array(1.0), parts).values()]
    [0.75, 0.25]
    """
    total = sum(among.values(), np.zeros(()))
    scale = np.divide(variance, total, out=np.zeros(np.shape(variance)), where=total > 0)
    return {part: np.asarray(scale * of) for part, of in among.items()}
