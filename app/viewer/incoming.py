"""Messages that a browser may send into a view: camera, clicks, and a picture it was asked for.

viser decodes every message in full, in the service's own process. So the relay passes on only what
the page needs, nothing large, and no picture: a picture is checked by its header and kept as it
came, and a single pixel is passed on in its place.
"""

import struct
from dataclasses import dataclass

import msgspec

MAX_BYTES = 64_000
"""Largest size of a message; clicks and cameras have less than 1,000 bytes."""
MAX_PICTURE_BYTES = 16_000_000
PER_S, BURST = 300.0, 1_200
"""Most messages of one browser, per second and at once. While the view is turned it sends one for
each frame."""
OPENINGS_PER_S, MOST_OPENINGS = 3.0, 60
"""Most connections that one user opens, per second and at once. A page that has lost its view tries
again once a second."""

PNG_HEAD = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"
ONE_PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c489"
    "0000000d49444154789c6360606060000000050001a5f645400000000049454e44ae426082"
)


class RefusedMessageError(Exception):
    """A message that no page sends; its connection is closed."""


@dataclass
class WantedPicture:
    """A picture requested from a browser; ``content`` is the PNG once it has arrived."""

    width: int
    height: int
    content: bytes | None = None

    def accept(self, content: bytes) -> None:
        """Take a PNG of the size that was asked for.

        Raises
        ------
        RefusedMessageError
        """
        head = len(PNG_HEAD)
        sizes = content[head : head + 8]
        if content[:head] != PNG_HEAD or len(sizes) < 8:
            raise RefusedMessageError("the picture is not a PNG")
        if struct.unpack(">II", sizes) != (self.width, self.height):
            raise RefusedMessageError("the picture has another size than was asked for")
        self.content = content


class _Camera(msgspec.Struct, tag_field="type", tag="ViewerCameraMessage"):
    """The place from which the browser looks."""


class _Pointer(msgspec.Struct, tag_field="type", tag="ScenePointerMessage"):
    """A click into the scene."""


class _Click(msgspec.Struct, tag_field="type", tag="SceneNodeClickMessage"):
    """A click on a thing in it."""


class _Picture(
    msgspec.Struct, tag_field="type", tag="GetRenderResponseMessage", forbid_unknown_fields=True
):
    """The requested picture."""

    payload: bytes
    render_uuid: str


# Fields that are not named here are skipped, not built.
_decoder = msgspec.msgpack.Decoder(_Camera | _Pointer | _Click | _Picture)


def passed_on(data: bytes | str, picture: WantedPicture | None) -> bytes | None:
    """Return the part of a browser's message that viser gets; None if nothing.

    Raises
    ------
    RefusedMessageError
        If it is larger than any that a page sends, or a picture other than that asked for.
    """
    if len(data) > (MAX_BYTES if picture is None else MAX_PICTURE_BYTES):
        raise RefusedMessageError("the message is too large")
    if isinstance(data, str):
        return None
    try:
        message = _decoder.decode(data)
    except msgspec.DecodeError:
        return None
    if not isinstance(message, _Picture):
        if len(data) > MAX_BYTES:
            raise RefusedMessageError("the message is too large")
        return data
    if picture is None:
        return None
    picture.accept(message.payload)
    return msgspec.msgpack.encode(_Picture(ONE_PIXEL, message.render_uuid))
