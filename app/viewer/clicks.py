"""Clicks on stitches in the 3D views, on their way to the pages that show them."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Iterator

from app.viewer.fabric import Ground

Cell = tuple[int, int]


class Clicks:
    """Reports clicks on stitches to the listeners of a design.

    Clicks come from viser's threads; listeners wait on the event loop.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._listeners: dict[str, set[tuple[asyncio.AbstractEventLoop, asyncio.Queue[Cell]]]] = {}

    @contextlib.contextmanager
    def listen(self, design: str) -> Iterator[asyncio.Queue[Cell]]:
        """A queue of (row, column), for as long as the block runs."""
        listener = (asyncio.get_running_loop(), asyncio.Queue[Cell](maxsize=0))
        with self._lock:
            self._listeners.setdefault(design, set()).add(listener)
        try:
            yield listener[1]
        finally:
            with self._lock:
                listeners = self._listeners[design]
                listeners.discard(listener)
                if not listeners:
                    del self._listeners[design]

    def tell(self, design: str, cell: Cell) -> None:
        """Pass a click on."""
        with self._lock:
            listeners = list(self._listeners.get(design, ()))
        for loop, queue in listeners:
            loop.call_soon_threadsafe(queue.put_nowait, cell)

    def __len__(self) -> int:
        return len(self._listeners)


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
