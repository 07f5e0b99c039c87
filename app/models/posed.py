"""A piece as it lies, hangs or is worn: data of a result for the 3D view."""

from __future__ import annotations

from dataclasses import dataclass, replace

from knitcore.draw.body import Body, Floats, upright


@dataclass(frozen=True, eq=False)
class PosedView:
    """A piece in space.

    Attributes
    ----------
    corners_mm : (rows + 1, columns + 1, 3) corners of the stitches.
    body : what it rests on, if that is to be seen.
    mmhg : (rows, columns) pressure on the limb; NaN where there is none. None if it is not worn.
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
