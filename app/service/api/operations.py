"""A route for every operation."""

import re
from collections.abc import Callable, Mapping
from functools import partial
from inspect import Parameter, Signature
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import BaseModel

from ...operations.perform import carried_out
from ...operations.registry import Operation, operations
from ...requests.charts import size_of
from ..compute.answers import Answers
from ..identity import current_user
from ..limits.fair_queue import FairLock
from ..problems import Problem
from ..web.bodies import OrUndecoded, Undecoded, WorkerRoute
from ..web.events import abandoned
from ..web.packed import ASKED_WITH_TAG, TAGGED, json_response, plain, tagged

MAX_LIGHT = 2_500
"""Largest number of stitches of a request that the service answers itself. A larger one goes to a
worker, with its limits on memory and time: a mixed chart of 10,000 stitches takes 0.3 s."""
MISSING: dict[int | str, dict[str, Any]] = {
    404: {"model": Problem, "description": "Not found: nothing has that name."}
}


def _endpoint(operation: Operation[Any, Any]) -> Callable[..., Any]:
    """The function for FastAPI, with the request as a body or as parameters of the address."""

    def made(body: BaseModel, request: Request) -> bytes:
        context = request.app.state.answers.context()
        result: BaseModel = carried_out(operation.run, body, context).result
        return result.model_dump_json().encode()

    def light(body: BaseModel, request: Request) -> Response:
        return plain(made(body, request), request.headers)

    async def post(body: BaseModel | Undecoded, request: Request) -> Any:
        answers: Answers = request.app.state.answers
        posted = body.content if isinstance(body, Undecoded) else body
        heavy = operation.heavy or operation.job
        if isinstance(posted, BaseModel) and not heavy and size_of(posted) <= MAX_LIGHT:
            lock: FairLock = request.app.state.light_work
            async with lock.turn(current_user.get()):
                return await run_in_threadpool(light, posted, request)

        answer = await answers.answer(partial(abandoned, request), operation, posted)
        return await json_response(answer.body, request.headers)

    def get(request: Request, **fields: Any) -> Response:
        return tagged(made(operation.request(**fields), request), request.headers)

    if operation.method == "POST":
        return _typed(post, body=Annotated[operation.request, OrUndecoded], request=Request)
    places = {
        name: Annotated[field.rebuild_annotation(), Path(examples=field.examples)]
        for name, field in operation.request.model_fields.items()
    }
    return _typed(get, request=Request, **places)


def _shown(example: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """A request as the schema describes it."""
    content = {"application/json": {"example": example}}
    return None if example is None else {"requestBody": {"content": content}}


def _typed(function: Callable[..., Any], **parameters: Any) -> Callable[..., Any]:
    """The function with the signature that FastAPI reads."""
    keyword = Parameter.KEYWORD_ONLY
    signature = [Parameter(n, keyword, annotation=of) for n, of in parameters.items()]
    function.__signature__ = Signature(signature)  # type: ignore[attr-defined]
    return function


def _router() -> APIRouter:
    router = APIRouter(route_class=WorkerRoute)
    for operation in operations().values():
        if operation.path is None:
            continue
        in_path = bool(re.search(r"\{\w+\}", operation.address))
        is_tagged = operation.method == "GET"
        router.add_api_route(
            operation.address,
            _endpoint(operation),
            methods=[operation.method],
            name=operation.name,
            tags=[operation.tag],
            summary=operation.summary,
            description=operation.description,
            response_model=operation.result,
            responses=(MISSING if in_path else {}) | (TAGGED if is_tagged else {}),
            openapi_extra=ASKED_WITH_TAG if is_tagged else _shown(operation.example),
        )
    return router


router = _router()
