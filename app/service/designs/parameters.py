"""Parameters of requests about designs: the user, pages of a list, idempotency keys."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import Depends, Header, Query, Request
from pydantic import BaseModel

from ..identity import asking
from ..problems import Problem
from .idempotency import Retry

Responses = dict[int | str, dict[str, Any]]
MISSING: Responses = {
    404: {"model": Problem, "description": "It does not exist, or it is not yours."}
}

Owner = Annotated[str, Depends(asking)]
Limit = Annotated[int, Query(ge=1, le=200)]
Cursor = Annotated[str | None, Query(max_length=100, pattern=r"^[^\x00]*$")]
Key = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        min_length=8,
        max_length=200,
        pattern=r"^[\x21-\x7e]+$",
        description="Requests with the same key and body take effect once.",
    ),
]


async def _retries(request: Request, owner: Owner, key: Key = None) -> Callable[..., Retry | None]:
    def retry(*body: BaseModel | str) -> Retry | None:
        if key is None:
            return None
        content = [part if isinstance(part, str) else part.model_dump_json() for part in body]
        return Retry.of(owner, key, request.method, request.url.path, *content)

    return retry


RetryOf = Annotated[Callable[..., Retry | None], Depends(_retries)]
"""Makes the idempotency key of a request, if it has one, from the parts of its body."""
