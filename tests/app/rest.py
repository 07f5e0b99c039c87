"""Operations over REST in tests."""

import base64
import io
from pathlib import Path
from typing import Any

import trimesh
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


def draw(
    client: TestClient, design: str, chart: object = "KP", material: str = "acrylic", **more: object
) -> Any:
    """The answer when the view of a design is drawn."""
    body = {"chart": chart, "material": material, **more}
    answer = client.put(f"/api/v1/views/{design}", json=body)
    assert answer.status_code == 200, answer.text
    return answer.json()


def solid(client: TestClient, view: dict[str, Any]) -> Any:
    """The yarn of a view as a mesh, in metres."""
    answer = client.post("/api/v1/views/solid", json=view)
    assert answer.status_code == 200, answer.text
    return trimesh.load_mesh(io.BytesIO(answer.content), file_type="glb")


def upload(path: Path) -> dict[str, str]:
    """A file as a request holds it."""
    return {"name": path.name, "content": base64.b64encode(path.read_bytes()).decode()}
