"""Answers as they are sent: compressed by the worker, because they are mostly digits."""

from __future__ import annotations

import gzip

from fastapi.concurrency import run_in_threadpool
from fastapi.responses import Response
from starlette.datastructures import Headers


def takes_gzip(headers: Headers) -> bool:
    """Whether a client accepts gzip."""
    return "gzip" in headers.get("accept-encoding", "")


async def json_response(content: bytes, headers: Headers) -> Response:
    """Compressed JSON for a client with these headers; unpacked if it does not accept gzip."""
    answer = {"Vary": "Accept-Encoding"}
    if takes_gzip(headers):
        answer["Content-Encoding"] = "gzip"
    else:
        content = await run_in_threadpool(gzip.decompress, content)
    return Response(content, media_type="application/json", headers=answer)
