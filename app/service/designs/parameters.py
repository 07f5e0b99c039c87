"""Parameters of requests about designs: the user, pages of a list, idempotency keys."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import Depends, Header, Path, Query, Request
from pydantic import BaseModel

from ..identity import asking, current_user
from ..problems import Problem
from .conditions import Retry

Responses = dict[int | str, dict[str, Any]]
MISSING: Responses = {
    404: {"model": Problem, "description": "It does not exist, or it is not yours."}
}

Owner = Annotated[str, Depends(asking)]
DesignId = Annotated[
    str,
    Path(
        pattern=r"^[A-Za-z0-9_-]{1,64}$",
        description="The design's identifier: up to 64 letters, digits, - or _.",
    ),
]
Limit = Annotated[int, Query(ge=1, le=200)]
Cursor = Annotated[str | None, Query(max_length=100)]
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


def private_name(design: str) -> str:
    """The name of a design's view, unique among users, so that views are private."""
    return f"{current_user.get()}/{design}"
