"""Errors as problem details (RFC 9457), with fields to blame and remedies."""

from __future__ import annotations

import errno
import logging
import math
from collections.abc import Mapping, Sequence
from itertools import islice
from typing import Annotated, Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, BeforeValidator, Field
from starlette.exceptions import HTTPException

from app.http.faults import also_wrong
from app.http.kinds import type_uri
from app.models.base import InvalidRequestError, MissingError
from app.models.refusals import problem_in_words, remedy_in_words
from knitcore.errors import (
    CancelledError,
    ConvergenceError,
    InputError,
    KnitcoreError,
    UnravelledError,
)

log = logging.getLogger("knitcore.app")


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
        429: "You are asking too often; Retry-After says when to come back.",
        503: "The service is busy or the computation took too long.",
        507: "The disk of the service is full; nothing was changed.",
    }.items()
}


class ServiceError(Exception):
    """An error that the service answers with; subclasses name its kind.

    Parameters
    ----------
    detail : what is wrong, in words.
    field : the input to blame.
    remedy : what would be accepted.
    """

    status = 500
    type = "internal"
    title = "Something went wrong in the service"
    default_remedy: str | None = None
    headers: Mapping[str, str] = {}

    def __init__(self, detail: str, *, field: str | None = None, remedy: str | None = None) -> None:
        super().__init__(detail)
        self.detail = detail
        self.field = field
        self.remedy = remedy or self.default_remedy

    @property
    def problem(self) -> Problem:
        """The error as clients see it."""
        return Problem(
            type=self.type,
            title=self.title,
            status=self.status,
            detail=self.detail,
            field=self.field,
            remedy=self.remedy,
        )


class UnavailableError(ServiceError):
    """The service cannot do this now; the text says what to do."""

    status, type, title = 503, "busy", "Not now"
    default_remedy = "Try again in a moment, or ask for less."
    headers: Mapping[str, str] = {"Retry-After": "2"}


class StoppingError(UnavailableError):
    """The service is being stopped."""

    default_remedy = "Try again when it is back."


class NoRoomError(UnavailableError):
    """The disk is full."""

    status, type, title = 507, "full", "No room left"
    headers: Mapping[str, str] = {}
    default_remedy = (
        "Make room on the disk of the service, then try again; nothing that was acknowledged is "
        "lost."
    )


class NotFoundError(ServiceError):
    """It does not exist, or belongs to another user."""

    status, type, title = 404, "not-found", "Not found here"


class RefusedError(ServiceError):
    """The request is not allowed."""

    status, type, title = 403, "refused", "Refused"


class TooManyError(ServiceError):
    """Requests come too often."""

    status, type, title = 429, "too-many", "Too many requests"

    def __init__(self, detail: str, wait_s: float) -> None:
        wait = math.ceil(wait_s)
        super().__init__(detail, remedy=f"Try again in {wait} s.")
        self.headers = {"Retry-After": str(wait)}


def answer_to(error: Exception) -> JSONResponse:
    """Any error as a response."""
    return _response(problem_of(error), getattr(error, "headers", None))


def _response(problem: Problem, headers: Mapping[str, str] | None = None) -> JSONResponse:
    return JSONResponse(problem.model_dump(), problem.status, headers, PROBLEM_TYPE)


def problem_of(error: Exception) -> Problem:
    """Any error as a problem; details of unforeseen ones go to the log only."""
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        error = NoRoomError("The disk of the service is full.")
    if isinstance(error, MissingError):
        missing = f"{error.field}: {error.problem}"
        error = NotFoundError(missing, field=error.field, remedy=error.remedy)
    if isinstance(error, ServiceError):
        return error.problem
    if isinstance(error, InputError):
        return _unusable([*map(_of_library, (error, *error.others))], error.most)
    if isinstance(error, ConvergenceError | UnravelledError | CancelledError):
        return Problem(
            type="unsolved",
            title="No result was reached",
            status=422,
            detail=str(error),
            remedy="Ask for less: a smaller strain, a smaller chart or more steps.",
        )
    if isinstance(error, RequestValidationError | InvalidRequestError):
        return _invalid(error.errors())
    if isinstance(error, HTTPException):
        return _of_http(error)
    return Problem(
        type="internal",
        title="Something went wrong in the service",
        status=500,
        detail="The service met an error that it did not expect; its log has the details.",
        remedy="Nothing you painted is lost. Try again, or report it with the log.",
    )


def _of_library(error: InputError) -> Fault:
    detail = f"{error.field}: {error.problem}"
    return Fault(detail=detail, field=error.field, remedy=error.remedy)


def _of_http(error: HTTPException) -> Problem:
    detail = str(error.detail)
    if error.status_code == 413:
        return Problem(
            type="refused",
            title="The request is too large",
            status=413,
            detail=detail,
            field="body",
            remedy="Send less at once.",
        )
    remedy = "Compare address and method with /docs." if error.status_code < 500 else None
    return Problem(
        type="http", title=detail, status=error.status_code, detail=detail, remedy=remedy
    )


def _unusable(faults: list[Fault], most: float | None = None) -> Problem:
    first = faults[0]
    return Problem(
        type="input",
        title="This input cannot be used",
        status=422,
        detail=first.detail,
        field=first.field,
        remedy=first.remedy,
        most=most,
        errors=faults[:MAX_FAULTS],
    )


def _invalid(found: Sequence[Any]) -> Problem:
    """Everything that is wrong with a request; an impossible address counts as not found."""
    place = found[0]["loc"]
    if place[:1] == ("path",):
        return NotFoundError(
            f"There is no such {place[-1]}.", field=str(place[-1]), remedy="Look it up in the list."
        ).problem
    faults: dict[str | None, Fault] = {}
    for fault in map(_fault, found):  # of alternatives that all fail, the first is reported
        faults.setdefault(fault.field, fault)
    return _unusable(list(islice(faults.values(), MAX_FAULTS)))


def _fault(error: dict[str, Any]) -> Fault:
    """One of pydantic's errors, in our words."""
    if error["type"] == "json_invalid":
        return Fault(
            detail=f"body: The request is not valid JSON: {error['ctx']['error']}",
            field="body",
            remedy="Send one JSON object as /docs describes it.",
        )
    place = error["loc"]
    if len(place) > 2 and place[2] == "request":  # of a job: leave its kind out of the place
        place = (place[0], *place[2:])
    # Pydantic names the alternatives of a union as parts of the place; no caller wrote those.
    parts = [str(part) for part in place if part not in _NOT_FIELDS]
    if error["type"].startswith("union_tag"):
        parts.append(error["ctx"]["discriminator"].strip("'"))
    field = ".".join(parts) or "body"
    return Fault(
        detail=f"{field}: {problem_in_words(error)}.",
        field=field,
        remedy=remedy_in_words(error, field),
    )


_NOT_FIELDS = frozenset({"body", "path", "query", "header", "float", "K/P text", "pure fabric"})


def install_problem_handlers(app: FastAPI) -> None:
    """Turn every error into a problem response."""

    @app.exception_handler(RequestValidationError)
    async def _(request: Request, error: RequestValidationError) -> JSONResponse:
        problem = problem_of(error)
        told = {fault.field for fault in problem.errors}
        for other in also_wrong(error, request):
            fault = _of_library(other)
            if fault.field not in told and len(problem.errors) < MAX_FAULTS:
                problem.errors.append(fault)
        return _response(problem)

    @app.exception_handler(KnitcoreError)
    @app.exception_handler(ServiceError)
    @app.exception_handler(InvalidRequestError)
    @app.exception_handler(HTTPException)
    async def _(_: Request, error: Exception) -> JSONResponse:
        return answer_to(error)

    @app.exception_handler(Exception)
    async def _(_: Request, error: Exception) -> JSONResponse:
        return unexpected(error)


def unexpected(error: Exception) -> JSONResponse:
    """An error in the service; its log line has the id of the request."""
    log.error("unexpected error", exc_info=error)
    return answer_to(error)
