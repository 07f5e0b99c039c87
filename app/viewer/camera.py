"""Camera positions: the sides from which a fabric is seen."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from knitcore.base.arrays import Array

if TYPE_CHECKING:
    import viser

FIELD_OF_VIEW = 0.5
"""Vertical angle of view, radians: a long lens, so that loops at the edge look like those in the
middle."""
ASPECT = 1.25
"""Width over height of the view that a fabric fits in from where cameras stand. For a narrower one,
as on the whole screen of a phone, they stand farther away."""
MARGIN = 1.3
"""Room around the fabric, over its size."""
LIFT = 0.08
"""Shift of the fabric downwards, over half the view's height: the toolbar covers the top."""
FARTHEST = 900.0
"""Units that a camera can go back: browsers draw nothing that is 1000 units away."""
MOVED = 1e-3
"""Relative change of place from which a camera counts as moved by its user."""


class CameraSide(StrEnum):
    """Sides of a fabric."""

    FACE = "face"
    BACK = "back"
    EDGE = "edge"
    ANGLE = "angle"


_TOWARDS: dict[CameraSide, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    # position and up direction of the camera
    CameraSide.FACE: ((0.0, -0.06, 1.0), (0.0, 1.0, 0.0)),
    CameraSide.BACK: ((0.0, -0.06, -1.0), (0.0, 1.0, 0.0)),
    CameraSide.EDGE: ((0.0, -1.0, 0.16), (0.0, 0.0, 1.0)),
    CameraSide.ANGLE: ((0.3, -0.65, 0.9), (0.0, 1.0, 0.0)),
}


def stand(
    side: CameraSide, extent: Array, below: float = 0.0, aspect: float = ASPECT
) -> tuple[Array, Array, Array]:
    """Position, target and up direction of a camera that sees the whole fabric.

    Parameters
    ----------
    extent : width and height of the fabric, whose middle is the origin.
    below : how far below it there is something to be seen, too, in the same unit.
    aspect : width of the view over its height.

    Returns
    -------
    position (3,) and aim (3,) in the unit of the extent, and the direction that is up (3,).
    """
    direction, up = (np.array(vector) for vector in _TOWARDS[side])
    direction /= np.linalg.norm(direction)
    width, height = extent
    # The near side looks larger than the middle.
    nearer = (abs(direction[0]) * width + abs(direction[1]) * height) / 2
    if side is CameraSide.EDGE:
        height = 0.3 * width
    needed = MARGIN * max(height, width / min(aspect, ASPECT)) / 2
    if side is not CameraSide.EDGE:
        needed = max(needed, (height / 2 + below) / (1 - LIFT))
    aim = LIFT * needed * up
    return aim + direction * (needed / np.tan(FIELD_OF_VIEW / 2) + nearer), aim, up


def place_camera(
    server: viser.ViserServer,
    side: CameraSide,
    extent: Array,
    below: float,
    placed: dict[int, Array],
    *,
    everybody: bool,
) -> None:
    """Place the camera, that of later ones too, so that the whole fabric is seen.

    Parameters
    ----------
    server : whose cameras.
    side : from which the fabric is seen.
    extent, below : as for :func:`stand`.
    placed : where the camera of each client was placed last; brought up to date.
    everybody : also those who have turned or moved their camera since it was placed.
    """
    position, aim, up = stand(side, extent, below)
    start = server.initial_camera
    before = np.array(start.position)
    start.fov = FIELD_OF_VIEW
    start.up = up
    start.look_at = aim
    start.position = position
    for number, client in server.get_clients().items():
        last = placed.get(number, before)
        if not everybody and not np.allclose(client.camera.position, last, rtol=MOVED):
            continue
        position, aim, _ = stand(side, extent, below, client.camera.aspect)
        placed[number] = position
        with client.atomic():
            client.camera.fov = FIELD_OF_VIEW
            client.camera.up_direction = up
            client.camera.position = position
            client.camera.look_at = aim
