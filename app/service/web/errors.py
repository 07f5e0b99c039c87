"""Every error as a response: problem details (RFC 9457), with fields to blame and remedies."""

import errno
import logging
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, get_args

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, TypeAdapter, ValidationError
from starlette.exceptions import HTTPException

from knitcore.base.errors import (
    CancelledError,
    ConvergenceError,
    InputError,
    KnitcoreError,
    UnravelledError,
)

from ...requests.base import InvalidRequestError, MissingError
from ...requests.faults import faults_of, problem_in_words, remedy_in_words
from ...requests.uploads import UploadedFile
from ..problems import (
    MAX_FAULTS,
    PROBLEM_TYPE,
    Fault,
    NoRoomError,
    NotFoundError,
    Problem,
    ServiceError,
    UnsolvedError,
)

MAX_BYTES = 10_000
"""Largest request that is checked here, on the event loop, but for its files. In a larger one, what
the library finds wrong is reported once the rest is valid."""


def also_wrong(error: RequestValidationError, request: Request) -> Iterator[InputError]:
    """Yield the library's errors in the fields whose types are right."""
    if int(request.headers.get("Content-Length", MAX_BYTES + 1)) > MAX_BYTES:
        return
    body, field = error.body, getattr(request.scope.get("route"), "body_field", None)
    model: Any = field.field_info.annotation if field is not None else None
    wrong = [place[1:] for place in (fault["loc"] for fault in error.errors()) if len(place) > 1]
    if isinstance(body, dict) and "kind" in body and isinstance(body.get("request"), dict):
        jobs = {get_args(job.model_fields["kind"].annotation)[0]: job for job in get_args(model)}
        job = jobs.get(str(body["kind"]))
        body, model = body["request"], job.model_fields["request"].annotation if job else None
        wrong = [place[2:] for place in wrong]
    if not (isinstance(body, dict) and isinstance(model, type) and issubclass(model, BaseModel)):
        return
    fields = {name: value for name, value in body.items() if name in model.model_fields}
    for place in wrong:
        fields.pop(place[0] if place else "", None)
    yield from faults_of(
        model, dict(_of_their_kinds(model, fields)), request.app.state.answers.context()
    )


def _of_their_kinds(model: type[BaseModel], fields: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    for name, value in fields.items():
        try:
            kind: Any = model.model_fields[name].rebuild_annotation()
            read = TypeAdapter(kind).validate_python(value)
        except ValidationError:
            continue
        if not isinstance(read, UploadedFile):  # a worker reads it
            yield name, read


log = logging.getLogger("knitcore.app")


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
        return UnsolvedError(str(error)).problem
    if isinstance(error, RequestValidationError | InvalidRequestError):
        return _invalid(error.errors())
    if isinstance(error, HTTPException):
        return _of_http(error)
    return ServiceError(
        "An unexpected error occurred in the service; its log has the details.",
        remedy="Nothing you painted is lost. Try again, or report it with the log.",
    ).problem


def _of_library(error: InputError) -> Fault:
    detail = f"{error.field}: {error.problem}"
    return Fault(detail=detail, field=error.field, remedy=error.remedy)


def _of_http(error: HTTPException) -> Problem:
    detail = str(error.detail)
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


def _invalid(errors: Sequence[Any]) -> Problem:
    """Everything that is wrong with a request; an impossible address counts as not found."""
    place = errors[0]["loc"]
    if place[:1] == ("path",):
        return NotFoundError(
            f"There is no such {place[-1]}.", field=str(place[-1]), remedy="Look it up in the list."
        ).problem
    faults: dict[str | None, Fault] = {}
    for fault in map(_fault, errors):  # of alternatives that all fail, the first is reported
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
        reported = {fault.field for fault in problem.errors}
        for other in also_wrong(error, request):
            fault = _of_library(other)
            if fault.field not in reported and len(problem.errors) < MAX_FAULTS:
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
