"""Camera positions: the sides from which a fabric is seen."""

from __future__ import annotations

from collections import deque
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
"""Relative change of place from which a camera counts as moved."""
MOST_PLACES = 300
"""Latest places of cameras that are remembered."""


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


class Cameras:
    """The cameras of everybody who looks at a server's scene.

    Browsers report where their cameras stand, but a while later: from before a camera was placed,
    or from where cameras began when the browser loaded the scene. So a user has moved a camera
    only if it stands at none of the places that cameras were given.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._given = deque([np.array(server.initial_camera.position)], MOST_PLACES)
        self._seen: tuple[CameraSide, Array, float] | None = None

    def aim(self, side: CameraSide, extent: Array, below: float, *, everybody: bool) -> None:
        """Let all cameras, and those of browsers to come, see a whole fabric.

        Parameters
        ----------
        side, extent, below : as for :func:`stand`.
        everybody : also those that their users have moved.
        """
        self._seen = side, extent, below
        position, aim, up = stand(side, extent, below)
        start = self._server.initial_camera
        start.fov = FIELD_OF_VIEW
        start.up = up
        start.look_at = aim
        start.position = position
        self._given.append(position)
        for client in self._server.get_clients().values():
            self.place(client, moved=everybody)

    def place(self, client: viser.ClientHandle, *, moved: bool = False) -> None:
        """Let a camera see the whole fabric where it does not, or no longer, stand so that it does.

        Parameters
        ----------
        moved : also one that its user has moved.
        """
        camera = client.camera
        if self._seen is None or not (moved or _is_at(camera.position, *self._given)):
            return
        position, aim, up = stand(*self._seen, camera.aspect)
        if _is_at(camera.position, position):
            return
        self._given.append(position)
        with client.atomic():
            camera.fov = FIELD_OF_VIEW
            camera.up_direction = up
            camera.position = position
            camera.look_at = aim


def _is_at(position: Array, *places: Array) -> bool:
    away = np.linalg.norm(np.array(places) - position, axis=1)
    return bool(away.min() <= MOVED * np.linalg.norm(position))
