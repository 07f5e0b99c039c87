"""viser's own port, closed to everybody but the relay.

viser listens on a loopback port of its own and checks nothing there: any page in a browser on this
machine, and any other user of it, could connect and draw or run scripts in a view. A secret header
that only the relay knows keeps them out. viser has no setting for it, so the function with which
it starts its websocket server is wrapped; if that ever stops working, no view is opened.

Its messages also wait in a queue that can fall asleep for good while a scene is being written; see
:class:`NewsEvent`. It takes pictures that are packed already, and does not keep them unpacked too.
"""

import asyncio
import http
import secrets
from types import SimpleNamespace
from typing import Any

import rich
import viser
import viser._scene_api as viser_scene
import viser.infra._infra as viser_infra
import websockets.asyncio.server
from viser.infra._async_message_buffer import AsyncMessageBuffer

TESTED_VISER = "1.1"
"""The minor version that this module and ``frontend/viser/`` were tested with.

``pyproject.toml`` allows no other, since all of them rely on what viser does not promise.
"""

HEADER = "X-Knitcore-Relay"
RELAY_HEADERS = {HEADER: secrets.token_urlsafe(32)}
"""Secret that the relay sends along; new in every process."""

rich.get_console().quiet = True  # viser's notices; stdout is for the service's address

_guarded_calls = 0


def private_server() -> viser.ViserServer:
    """A viser server on a free loopback port that answers the relay only.

    Raises
    ------
    RuntimeError
        If this viser starts its server in another way, so that the port would be open.
    """
    before = _guarded_calls
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    if _guarded_calls == before:
        server.stop()
        raise RuntimeError(
            "viser's port could not be closed to others, so no view is opened; "
            f"use viser {TESTED_VISER}"
        )
    return server


def _refuse_strangers(connection: Any, request: Any) -> Any:
    offered = request.headers.get(HEADER, "")
    if secrets.compare_digest(offered.encode(), RELAY_HEADERS[HEADER].encode()):
        return None
    return connection.respond(http.HTTPStatus.FORBIDDEN, "This port is for the service itself.\n")


def _serve(*args: Any, process_request: Any = None, **options: Any) -> Any:
    """Start a websocket server as ``websockets`` does, but refuse strangers before all else."""
    global _guarded_calls  # noqa: PLW0603 - counts for private_server
    _guarded_calls += 1

    def checked(connection: Any, request: Any) -> Any:
        refusal = _refuse_strangers(connection, request)
        if refusal is not None or process_request is None:
            return refusal
        return process_request(connection, request)

    return websockets.asyncio.server.serve(*args, process_request=checked, **options)


class NewsEvent(asyncio.Event):
    """An event that other threads may set: it wakes who waits from the loop's own thread alone.

    viser's threads set the event of a queue directly, and then once more through the loop. Where
    the first falls between a waiter's look at the event and its going to sleep, asyncio's own takes
    the second for a repetition and wakes nobody, ever: the browser gets no more of the scene.
    """

    def set(self) -> None:
        """Note it, and in the loop wake all who wait, also those who came after it was noted."""
        try:
            asyncio.get_running_loop()
        except RuntimeError:
            self._value = True
            return
        self._value = False
        super().set()


class _Queue(AsyncMessageBuffer):
    """viser's queue of messages, whose event is a :class:`NewsEvent`."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.message_event = NewsEvent()


vars(viser_infra)["AsyncMessageBuffer"] = _Queue

_pack: Any = vars(viser_scene)["_encode_image_binary"]


def _packed(image: Any, *args: Any, **options: Any) -> Any:
    """A picture's format and content; bytes are a WebP."""
    return ("webp", image) if isinstance(image, bytes) else _pack(image, *args, **options)


vars(viser_scene)["_encode_image_binary"] = _packed

# Only viser's name for the package is replaced; everybody else's stays as it is.
_server = SimpleNamespace(**{**vars(websockets.asyncio.server), "serve": _serve})
vars(viser_infra)["websockets"] = SimpleNamespace(
    **{**vars(websockets), "asyncio": SimpleNamespace(server=_server)}
)
