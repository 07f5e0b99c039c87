"""Operations over REST in tests."""

import base64
from pathlib import Path
from typing import Any

from fastapi.testclient import TestClient


def post(client: TestClient, address: str, body: object) -> Any:
    """The result of an operation."""
    answer = client.post(f"/api/v1/{address}", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def refusal(client: TestClient, address: str, body: object) -> Any:
    """The problem for which the service refuses a request."""
    answer = client.post(f"/api/v1/{address}", json=body)
    assert answer.status_code == 422, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.json()


def upload(path: Path) -> dict[str, str]:
    """A file as a request holds it."""
    return {"name": path.name, "content": base64.b64encode(path.read_bytes()).decode()}
