"""Further faults of a request that already fails validation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args

from fastapi import Request
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, TypeAdapter, ValidationError

from app.models.checks import faults_of
from knitcore.errors import InputError

MAX_BYTES = 10_000
"""Largest request that is checked here, on the event loop. In a larger one, what the library finds
wrong is reported once the rest is valid."""


def also_wrong(error: RequestValidationError, request: Request) -> Iterator[InputError]:
    """What the library finds wrong in the fields whose types are right."""
    if int(request.headers.get("Content-Length", MAX_BYTES + 1)) > MAX_BYTES:
        return
    body, model = error.body, _model(request)
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


def _model(request: Request) -> Any:
    body = getattr(request.scope.get("route"), "body_field", None)
    return body.field_info.annotation if body is not None else None


def _of_their_kinds(model: type[BaseModel], fields: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    for name, value in fields.items():
        try:
            kind: Any = model.model_fields[name].rebuild_annotation()
            yield name, TypeAdapter(kind).validate_python(value)
        except ValidationError:
            continue
