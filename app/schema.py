"""The OpenAPI schema, with what FastAPI does not say of problems by itself."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from app.problems import PROBLEM_TYPE, Problem

FIRST_PROBLEM = 400
EXAMPLE = Problem(
    type="input",
    title="This input cannot be used",
    status=422,
    detail="chart: line 1, stitch 2 is 'Q', which is neither K nor P.",
    field="chart",
    remedy="Write every stitch as K or P.",
).model_dump()


def install_schema(app: FastAPI) -> None:
    """Say of every problem that it is one, and show what it looks like."""
    made = app.openapi

    def openapi() -> dict[str, Any]:
        if app.openapi_schema is None:
            schema = made()
            for path in schema["paths"].values():
                for operation in path.values():
                    _mark_problems(operation["responses"])
            schema["components"]["schemas"]["Problem"]["examples"] = [EXAMPLE]
            app.openapi_schema = schema
        return app.openapi_schema

    app.openapi = openapi  # type: ignore[method-assign]


def _mark_problems(responses: dict[str, Any]) -> None:
    for status, response in responses.items():
        if int(status) >= FIRST_PROBLEM:
            content = response.get("content", {})
            if "application/json" in content:
                content[PROBLEM_TYPE] = content.pop("application/json")
            content.pop("text/event-stream", None)
