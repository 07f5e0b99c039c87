"""A stretch test: data of a result for the 3D view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction


@dataclass(frozen=True, eq=False)
class StretchView:
    """A test for the 3D view.

    Attributes
    ----------
    direction : of the pull.
    positions_mm : (steps, rows, columns, 2) stitch centres.
    strain : (steps, rows, columns, 2) course-wise and wale-wise.
    utilisation : (steps, rows, columns).
    """

    direction: Direction
    positions_mm: NDArray[np.float32]
    strain: Array
    utilisation: Array

    @property
    def size_bytes(self) -> int:
        """Memory that it takes, bytes."""
        return sum(array.nbytes for array in (self.positions_mm, self.strain, self.utilisation))
