"""Responses, compressed by the workers."""

import asyncio
import gzip
import hashlib
from typing import Any

from fastapi.responses import Response
from starlette.datastructures import Headers

from ...operations.perform import LEVEL

WORTH_BYTES = 1_000
"""Shorter responses are sent uncompressed."""
TAGGED: dict[int | str, dict[str, Any]] = {
    200: {"headers": {"ETag": {"$ref": "#/components/headers/ETag"}}},
    304: {"description": "Not modified since the state in If-None-Match."},
}
"""Responses of the schema for answers with an ETag."""
ASKED_WITH_TAG = {
    "parameters": [
        {
            "name": "If-None-Match",
            "in": "header",
            "required": False,
            "description": "The ETag of the answer that you have.",
            "schema": {"type": "string", "maxLength": 200},
        }
    ]
}
"""Parameters of the schema for requests of such answers."""


def takes_gzip(headers: Headers) -> bool:
    """Return whether a client accepts gzip, which a weight of 0 refuses."""
    weights = {}
    for part in headers.get("accept-encoding", "").lower().split(","):
        coding, _, weight = part.partition(";")
        weights[coding.strip()] = weight.strip().removeprefix("q=")
    weight = weights.get("gzip", weights.get("*", "0"))
    return bool(weight.strip("0.")) or not weight


def tagged(content: bytes, headers: Headers, media_type: str = "application/json") -> Response:
    """An answer with an ETag, or 304 for a client that has it; compressed if that is worth it."""
    tag = etag_of(content)
    if is_known(tag, headers):
        return Response(status_code=304, headers={"ETag": tag, "Vary": "Accept-Encoding"})
    response = plain(content, headers, media_type)
    response.headers["ETag"] = tag
    return response


def plain(content: bytes, headers: Headers, media_type: str = "application/json") -> Response:
    """An answer, compressed if that is worth it and the client accepts gzip."""
    answer = {"Vary": "Accept-Encoding"}
    if len(content) >= WORTH_BYTES and takes_gzip(headers):
        answer["Content-Encoding"] = "gzip"
        content = gzip.compress(content, LEVEL)
    return Response(content, media_type=media_type, headers=answer)


def etag_of(content: bytes) -> str:
    """ETag of a content; it is weak, because packed and unpacked answers share it."""
    return f'W/"{hashlib.sha256(content).hexdigest()[:32]}"'


def is_known(tag: str, headers: Headers) -> bool:
    """Return whether a client says that it has the answer with this tag."""
    return tag.removeprefix("W/") in headers.get("if-none-match", "")


async def json_response(content: bytes, headers: Headers) -> Response:
    """Compressed JSON for a client with these headers; unpacked if it does not accept gzip."""
    answer = {"Vary": "Accept-Encoding"}
    if takes_gzip(headers):
        answer["Content-Encoding"] = "gzip"
    else:
        content = await asyncio.to_thread(gzip.decompress, content)
    return Response(content, media_type="application/json", headers=answer)
