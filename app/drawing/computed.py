"""Views of computed results in 3D: a piece in space, or a stretch test."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction
from knitcore.draw.body import Body, Floats, upright


@dataclass(frozen=True, eq=False)
class PosedView:
    """A piece as it lies, hangs or is worn.

    Attributes
    ----------
    corners_mm : (rows + 1, columns + 1, 3) corners of the stitches.
    body : what it rests on, if that is to be seen.
    mmhg : (rows, columns) pressure on the limb; NaN where there is none, infinite where the fabric
        can stretch no further. None if it is not worn.
    """

    corners_mm: Floats
    body: Body | None = None
    mmhg: Floats | None = None

    def upright(self) -> PosedView:
        """Turn the shape so that z, which is up in a test of cloth, is up in the view."""
        body = self.body and self.body.upright()
        return replace(self, corners_mm=upright(self.corners_mm), body=body)

    @property
    def size_bytes(self) -> int:
        """Memory that it takes, bytes."""
        more = 0 if self.body is None else self.body.size_bytes
        return self.corners_mm.nbytes + more + (0 if self.mmhg is None else self.mmhg.nbytes)


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
