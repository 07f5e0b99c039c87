"""The OpenAPI schema, with examples and problem responses, which FastAPI does not add itself."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fastapi import FastAPI

from app.http.problems import PROBLEM_TYPE, problem_of
from knitcore.errors import InputError

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
"""Requests, written by hand, and the service's answers to them (`make examples`)."""
FIRST_PROBLEM = 400
EXAMPLE = problem_of(
    InputError(
        "chart",
        "line 1, stitch 2 is 'Q', which is neither K nor P.",
        "Write every stitch as K or P.",
    )
).model_dump()


def install_schema(app: FastAPI) -> None:
    """Add an example to every operation, and mark problem responses as such."""
    made = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            schema = made()
            asked, found = _read("requests.json"), _read("answers.json")
            for name, operation in _operations(schema):
                _mark_problems(operation["responses"])
                _show(operation, asked.get(name), found["answers"].get(name))
                for parameter in operation.get("parameters", []):
                    if parameter["in"] == "path":
                        parameter["example"] = found["parameters"].get(parameter["name"])
            schema["components"]["schemas"]["Problem"]["examples"] = [EXAMPLE]
            app.openapi_schema = schema
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]


def operations(app: FastAPI) -> list[str]:
    """All operations, such as ``GET /healthz``."""
    return [name for name, _ in _operations(app.openapi())]


def _operations(schema: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for path, methods in schema["paths"].items():
        for method, operation in methods.items():
            yield f"{method.upper()} {path}", operation


def _read(name: str) -> dict[str, Any]:
    read: dict[str, Any] = json.loads((EXAMPLES / name).read_text(encoding="utf-8"))
    return read


def _show(operation: dict[str, Any], request: Any, answer: Any) -> None:
    if request is not None:
        operation["requestBody"]["content"]["application/json"]["example"] = request
    for status, response in operation["responses"].items():
        if int(status) < FIRST_PROBLEM and "application/json" in response.get("content", {}):
            response["content"]["application/json"]["example"] = answer


def _mark_problems(responses: dict[str, Any]) -> None:
    for status, response in responses.items():
        if int(status) >= FIRST_PROBLEM:
            content = response.get("content", {})
            if "application/json" in content:
                content[PROBLEM_TYPE] = content.pop("application/json")
            content.pop("text/event-stream", None)
