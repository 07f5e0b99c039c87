"""A route for every operation."""

from __future__ import annotations

import re
from collections.abc import Callable
from inspect import Parameter, Signature
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from pydantic import BaseModel

from app.compute.answers import Answers
from app.http.packed import json_response
from app.http.problems import Problem
from app.operations.registry import Operation, operations

MISSING: dict[int | str, dict[str, Any]] = {
    404: {"model": Problem, "description": "There is none of that name."}
}


def _endpoint(operation: Operation[Any, Any]) -> Callable[..., Any]:
    """What FastAPI calls: with the request as a body, or put together from the address."""
    if operation.heavy:

        async def heavy(body: BaseModel, request: Request) -> Response:
            answers: Answers = request.app.state.answers
            answer = await answers.answer(request.is_disconnected, operation, body)
            return await json_response(answer.body, request.headers)

        return _typed(heavy, body=operation.request, request=Request)

    def light(request: Request, body: BaseModel | None = None, **fields: Any) -> Any:
        asked = operation.request(**fields) if body is None else body
        return operation.run(asked, request.app.state.answers.context())

    if operation.method == "POST":
        return _typed(light, body=operation.request, request=Request)
    places = {
        name: Annotated[field.rebuild_annotation(), Path(examples=field.examples)]
        for name, field in operation.request.model_fields.items()
    }
    return _typed(light, request=Request, **places)


def _typed(function: Callable[..., Any], **parameters: Any) -> Callable[..., Any]:
    """With the signature that FastAPI reads."""
    keyword = Parameter.KEYWORD_ONLY
    signature = [Parameter(n, keyword, annotation=of) for n, of in parameters.items()]
    function.__signature__ = Signature(signature)  # type: ignore[attr-defined]
    return function


def _router() -> APIRouter:
    router = APIRouter()
    for operation in operations().values():
        if operation.path is None:
            continue
        in_path = bool(re.search(r"\{\w+\}", operation.address))
        router.add_api_route(
            operation.address,
            _endpoint(operation),
            methods=[operation.method],
            name=operation.name,
            operation_id=operation.name,
            tags=[operation.tag],
            summary=operation.summary,
            description=operation.description,
            response_model=operation.result,
            responses=MISSING if in_path else None,
        )
    return router


router = _router()
