"""Messages that browsers send into views, and those that they might."""

import io
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import msgspec
import pytest
import zstandard
from fastapi.testclient import TestClient
from PIL import Image
from starlette.websockets import WebSocketDisconnect

from app.viewer.incoming import (
    MAX_BYTES,
    MAX_PICTURE_BYTES,
    MOST_OPENINGS,
    ONE_PIXEL,
    RefusedMessageError,
    WantedPicture,
    passed_on,
)
from tests.app.clients import drain, state_of, watching
from tests.app.rest import draw
from tests.app.running import wait_until

CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": [1.0, 0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 9.0],
    "image_height": 100,
    "image_width": 100,
    "fov": 0.9,
    "near": 0.1,
    "far": 100.0,
    "look_at": [0.0, 0.0, 0.0],
    "up_direction": [0.0, 1.0, 0.0],
}


def _packed(**message: Any) -> bytes:
    return msgspec.msgpack.encode(message)


def _png(width: int, height: int) -> bytes:
    content = io.BytesIO()
    Image.new("RGBA", (width, height), "#d8c6ab").save(content, "PNG")
    return content.getvalue()


def _render(content: bytes) -> bytes:
    return _packed(type="GetRenderResponseMessage", payload=content, render_uuid="u")


def test_cameras_and_clicks_go_on_as_they_are() -> None:
    for kind in ("ViewerCameraMessage", "ScenePointerMessage", "SceneNodeClickMessage"):
        message = _packed(**CAMERA | {"type": kind})
        assert passed_on(message, None) == message


def test_requests_for_a_public_tunnel_are_dropped() -> None:
    for kind in ("ShareUrlRequest", "ShareUrlDisconnect"):
        assert passed_on(_packed(type=kind), None) is None


@pytest.mark.parametrize(
    "message",
    [
        "text",
        b"",
        b"\xc1",
        _packed(type=["x"]),
        _packed(type="FileTransferStartUpload"),
        _packed(type="NoSuchMessage"),
        _packed(other=1),
        msgspec.msgpack.encode([1, 2]),
        _render(_png(2, 2)),  # nobody asked for it
    ],
)
def test_other_messages_are_dropped(message: bytes | str) -> None:
    assert passed_on(message, None) is None


def test_a_huge_message_is_refused_and_never_built() -> None:
    """Two to the 24 nils in an array: 1.2 GB once they are Python objects."""
    count = MAX_PICTURE_BYTES - 100
    nils = b"\xdd" + count.to_bytes(4, "big") + b"\xc0" * count
    head = b"\x82\xa4type\xb8GetRenderResponseMessage\xa7payload"
    tracemalloc.start()
    try:
        with pytest.raises(RefusedMessageError, match="too large"):
            passed_on(nils, None)
        for message in (nils, head + nils):
            assert passed_on(message, WantedPicture(100, 100)) is None
        assert tracemalloc.get_traced_memory()[1] < 2 * MAX_PICTURE_BYTES + 1_000_000
    finally:
        tracemalloc.stop()
    padded = _packed(**CAMERA | {"more": "x" * MAX_BYTES})
    with pytest.raises(RefusedMessageError, match="too large"):
        passed_on(padded, WantedPicture(100, 100))


def test_a_picture_is_kept_and_one_pixel_passed_on() -> None:
    picture = WantedPicture(30, 20)
    sent = msgspec.msgpack.decode(passed_on(_render(_png(30, 20)), picture) or b"")
    assert (sent["render_uuid"], sent["payload"]) == ("u", ONE_PIXEL)
    assert Image.open(io.BytesIO(ONE_PIXEL)).convert("RGBA").size == (1, 1)
    assert picture.content == _png(30, 20)


@pytest.mark.parametrize(
    "content", [_png(13_000, 10), _png(20, 30), b"", b"GIF89a", _png(3, 2)[:20]]
)
def test_a_picture_of_another_size_is_refused_by_its_header(content: bytes) -> None:
    picture = WantedPicture(30, 20)
    with pytest.raises(RefusedMessageError, match="picture"):
        passed_on(_render(content), picture)
    assert picture.content is None


def _shown(client: TestClient, design: str) -> Any:
    draw(client, design)
    return watching(client, f"/view/{design}")


def _asked_for(socket: Any) -> str:
    """The id of the picture that the service asks a browser for."""
    while True:
        frame = socket.receive_bytes()
        size = int.from_bytes(frame[8:16], "little")
        content = zstandard.decompress(frame[16 : 16 + size])
        for message in msgspec.msgpack.decode(content)["messages"]:
            if message["type"] == "GetRenderRequestMessage":
                return str(message["render_uuid"])


@pytest.mark.parametrize(("size", "status"), [((40, 30), 200), ((30, 40), 409)])
def test_a_picture_is_requested_from_a_browser(
    client: TestClient, size: tuple[int, int], status: int
) -> None:
    design = f"a-picture-{status}"
    with _shown(client, design) as socket, ThreadPoolExecutor(1) as thread:
        socket.send_bytes(_packed(**CAMERA))
        view = state_of(client).views.get(f"local/{design}")
        wait_until(view.server.get_clients)
        address = f"/api/v1/views/{design}/picture?width=40&height=30"
        answer = thread.submit(client.get, address)
        uuid = _asked_for(socket)
        assert client.get(address).json()["detail"].startswith("Another picture")
        sent = {"payload": _png(*size), "render_uuid": uuid}
        socket.send_bytes(_packed(type="GetRenderResponseMessage", **sent))
        assert answer.result(60).status_code == status
        if status == 200:
            assert answer.result().content == _png(*size)


def test_a_browser_that_floods_a_view_is_disconnected(client: TestClient) -> None:
    with _shown(client, "a-loud-view") as socket:
        socket.send_bytes(b"\0" * (MAX_BYTES + 1))
        assert drain(socket) == 1008
    with _shown(client, "a-loud-view") as socket:
        socket.send_text("no message at all")
        assert socket.receive_bytes()  # others are not disturbed


def test_a_browser_that_opens_views_too_often_waits(client: TestClient) -> None:
    state_of(client).view_openings.spend("local", MOST_OPENINGS)
    draw(client, "a-view-too-many")
    with pytest.raises(WebSocketDisconnect) as refused, watching(client, "/view/a-view-too-many"):
        pass
    assert refused.value.code == 1013
