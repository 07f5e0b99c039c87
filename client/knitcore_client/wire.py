"""What both clients share: requests as JSON, answers as models, and when to ask again."""

import base64
from pathlib import Path
from typing import Any

import httpx2 as httpx
from pydantic import BaseModel

from knitcore_client.models import Problem

ATTEMPTS = 4
MAX_WAIT_S = 60.0
"""Longest wait that is accepted before a request is repeated."""
PAUSE_S = 0.5
"""Before a job is followed again whose events ended early."""


class ProblemError(Exception):
    """The service refused or failed.

    Attributes
    ----------
    problem : the service's answer.
    """

    def __init__(self, problem: Problem) -> None:
        super().__init__(f"{problem.title}: {problem.detail} {problem.remedy or ''}".strip())
        self.problem = problem


def sent(value: Any) -> Any:
    """A request as JSON: paths become the files there, models their fields that were set."""
    if isinstance(value, Path):
        content = base64.b64encode(value.read_bytes()).decode()
        return {"name": value.name, "content": content}
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json", exclude_unset=True)
    if isinstance(value, dict):
        return {name: sent(part) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [sent(part) for part in value]
    return value


def wait_s(answer: httpx.Response, attempt: int) -> float:
    """How long the service asks to wait before a refused request is sent again.

    Raises
    ------
    ProblemError
        If it is not to be sent again.
    """
    wait = float(answer.headers.get("Retry-After", "inf"))
    if attempt == ATTEMPTS or wait > MAX_WAIT_S:
        raise ProblemError(_problem(answer))
    return wait


def _problem(answer: httpx.Response) -> Problem:
    try:
        return Problem.model_validate_json(answer.content)
    except ValueError:
        detail = f"The answer {answer.status_code} does not come from this service."
        return Problem(
            type="/problems/http", title="No answer", status=answer.status_code, detail=detail
        )
