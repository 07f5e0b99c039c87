"""Stitches that clicks in a 3D view mean."""

from __future__ import annotations

from ..drawing.fabric import Ground

Cell = tuple[int, int]


def clicked_stitch(
    ground: Ground,
    origin: tuple[float, float, float],
    direction: tuple[float, float, float],
) -> Cell | None:
    """The stitch where a ray meets the fabric's middle plane; None outside the fabric.

    Tubes are thin and often missed, the plane never is.
    """
    if abs(direction[2]) < 1e-6:
        return None
    along = -origin[2] / direction[2]
    if along < 0:
        return None
    return ground.stitch_at(origin[0] + along * direction[0], origin[1] + along * direction[1])
