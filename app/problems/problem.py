"""What clients read of an error: what is wrong, the fields to blame and remedies."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, Field

from app.problems.kinds import type_uri

PROBLEM_TYPE = "application/problem+json"
MAX_FAULTS = 100


class Fault(BaseModel):
    """One thing that is wrong with a request."""

    detail: str = Field(description="What is wrong, in words.")
    field: str | None = Field(None, description="The input that is to blame.")
    remedy: str | None = Field(None, description="What would be accepted.")


class Problem(BaseModel):
    """What every error response looks like."""

    type: Annotated[str, BeforeValidator(type_uri)] = Field(
        description="The kind of problem: the address of a page about it.",
        examples=["/problems/input"],
    )
    title: str
    status: int
    detail: str = Field(description="What is wrong, in words.")
    field: str | None = Field(None, description="The input that is to blame.")
    remedy: str | None = Field(None, description="What would be accepted.")
    most: float | None = Field(
        None, description="The largest number that the field would accept, where that is known."
    )
    errors: list[Fault] = Field(
        [],
        description=f"Of inputs that cannot be used: all that is wrong, at most {MAX_FAULTS}; "
        "`field`, `detail` and `remedy` are those of the first.",
    )


PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    status: {"model": Problem, "description": text}
    for status, text in {
        400: "The request cannot be read.",
        401: "The service requires a token, and there is none or an unknown one.",
        403: "The request comes from a page of another site.",
        405: "The address does not support this method.",
        413: "The request is too large.",
        422: "An input cannot be used; the problem names the field and the remedy.",
        429: "Too many requests; Retry-After says when to try again.",
        503: "The service is busy or the computation took too long.",
        507: "The disk of the service is full; nothing was changed.",
    }.items()
}
