"""The OpenAPI schema, with what FastAPI does not add: examples, headers, tags, ways to sign in."""

import json
import threading
from collections.abc import Iterator
from functools import cache
from typing import Any

from fastapi import FastAPI, Request, Response

from knitcore.base.errors import InputError

from ...requests.uploads import EXAMPLES
from ..problems import PROBLEM_TYPE
from .errors import problem_of
from .packed import tagged

FIRST_PROBLEM = 400
EXAMPLE = problem_of(
    InputError(
        "chart",
        "line 1, stitch 2 is 'Q', which is neither K nor P.",
        "Write every stitch as K or P.",
    )
).model_dump()
TAGS = {
    "charts": "Read charts, and patterns to start from.",
    "mechanics": "What a chart does: moduli, curves, pressure, curl.",
    "stretch": "A stretch test of a piece, stitch by stitch.",
    "pieces": "Cut pieces of any outline, pulled, sheared and sewn.",
    "yarn level": "Repeats as curves of yarn in space.",
    "materials": "The library of yarns, and estimates for others.",
    "design": "Inverse design: repeats and charts for target properties.",
    "garments": "Sleeves, gloves and braces.",
    "measure": "Laws and yarns from tests.",
    "displacement fields": "Measured fields against computed ones.",
    "files": "Charts and designs in other formats.",
    "designs": "Designs stored by the service, their versions and links.",
    "jobs": "Long computations in the background.",
    "views": "The 3D view.",
    "session": "The user, and the browsers that are signed in.",
    "service": "The service itself.",
}
CONVENTIONS = """\
**Charts** are lines of K and P, the top row first, as seen from the face: `KP` over `PK`.
**Repeats** are the same in one line, `KP/PK`. Requests take either. Outlines and other cells are
lines of `x` and `.`, the top row first.

**Rows** count from the bottom wherever they have a number or stand in a list: `row` 0, or the
first row of a list, is the bottom row, and column 0 the left one. In files and texts for people
they count from 1.

**Intervals** are 90 % intervals, `[low, high]`. Each end has the unit and the shape of its value,
after which its field is named: `force_n: [1, 2]` and `force_interval_n: [[0.8, 1.7], [1.2, 2.3]]`.
A strain of 0.5 is 50 %."""
HEADERS = {
    "ETag": "The state of the answer, for `If-None-Match` and `If-Match`.",
    "Location": "Address of the new object.",
    "Retry-After": "Seconds to wait before the request is sent again.",
    "RateLimit-Limit": "Requests that may be sent at once; with logins only.",
    "RateLimit-Remaining": "Requests that may be sent now; with logins only.",
    "WWW-Authenticate": "How to sign in: `Bearer`.",
}
WAYS_TO_SIGN_IN = {
    "token": {
        "type": "http",
        "scheme": "bearer",
        "description": "A token, if the service requires one.",
    },
    "session": {
        "type": "apiKey",
        "in": "cookie",
        "name": "knitcore_session",
        "description": "Of a browser that was opened with `/?token=…`.",
    },
}
PARAMETERS = {
    "design": "LV39s7v8rGNtEW5HW9Xl9Q",
    "identifier": "acrylic",
    "job": "dwEAZDjPZb1SKhS9vjtaxQ",
    "material": "acrylic",
    "number": 1,
    "session": "3b1AieUVX6zNqeUh",
    "share": "3b1AieUVX6zNqeUh",
    "token": "LV39s7v8rGNtEW5HW9Xl9Q",
    "way": "flat",
}
"""Examples of what stands in addresses."""
HAVE_STATES = frozenset({"Design", "Painted"})
ARE_MADE = frozenset({"Design", "JobStatus"})
OPEN = frozenset({"GET /healthz", "GET /readyz"})


def install_schema(app: FastAPI) -> None:
    """Complete the schema, and serve it."""
    made, lock = app.openapi, threading.Lock()

    def openapi() -> dict[str, Any]:
        with (
            lock
        ):  # it takes a second; whoever asks in the meantime waits instead of making another
            return app.openapi_schema or complete()

    def complete() -> dict[str, Any]:
        schema = made()
        bodies = json.loads((EXAMPLES / "requests.json").read_text("utf-8"))
        for name, operation in documented_operations(schema):
            _mark_problems(operation["responses"])
            for status, response in operation["responses"].items():
                _add_headers(int(status), response)
            if name in OPEN:
                operation["security"] = []
            if name in bodies:
                operation["requestBody"]["content"]["application/json"]["example"] = bodies[name]
            for parameter in operation.get("parameters", []):
                if parameter["in"] == "path":
                    parameter["example"] = PARAMETERS.get(parameter["name"])
        schema["components"]["schemas"]["Problem"]["examples"] = [EXAMPLE]
        schema["info"]["description"] = CONVENTIONS
        schema["tags"] = [{"name": n, "description": text} for n, text in TAGS.items()]
        schema["components"]["headers"] = {
            name: {"description": text, "schema": {"type": "string"}}
            for name, text in HEADERS.items()
        }
        schema["components"]["securitySchemes"] = WAYS_TO_SIGN_IN
        schema["security"] = [{}, *({name: []} for name in WAYS_TO_SIGN_IN)]
        app.openapi_schema = schema
        return schema

    app.openapi = openapi  # type: ignore[method-assign]

    @cache
    def content() -> bytes:
        return json.dumps(openapi(), ensure_ascii=False).encode()

    @app.get("/openapi.json", include_in_schema=False)
    def get_schema(request: Request) -> Response:
        return tagged(content(), request.headers)


def documented_operations(schema: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """All operations of a schema with their names, such as ``GET /healthz``."""
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            yield f"{method.upper()} {path}", operation


def _add_headers(status: int, response: dict[str, Any]) -> None:
    """Say which headers come with an answer."""
    content = response.get("content", {}).get("application/json", {})
    model = content.get("schema", {}).get("$ref", "").rpartition("/")[2]
    names = ["RateLimit-Limit", "RateLimit-Remaining"] if status < FIRST_PROBLEM else []
    names += ["ETag"] if model in HAVE_STATES and status < FIRST_PROBLEM else []
    names += ["Location"] if model in ARE_MADE and status in (201, 202) else []
    names += ["Retry-After"] if status in (429, 503) else []
    names += ["WWW-Authenticate"] if status == 401 else []
    if names:
        headers = response.setdefault("headers", {})
        headers.update({name: {"$ref": f"#/components/headers/{name}"} for name in names})


def _mark_problems(responses: dict[str, Any]) -> None:
    for status, response in responses.items():
        if int(status) >= FIRST_PROBLEM:
            content = response.get("content", {})
            if "application/json" in content:
                content[PROBLEM_TYPE] = content.pop("application/json")
            content.pop("text/event-stream", None)
