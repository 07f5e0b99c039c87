"""The schema shows an example of everything, and the examples are what they say."""

import json
import time
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
from fastapi.testclient import TestClient

from app.requests.uploads import EXAMPLES
from app.service.identity import LOCAL_USER
from app.service.jobs.store import OPEN
from app.service.main import create_app
from app.service.settings import Settings
from app.service.web.schema import documented_operations
from app.service.web.sessions import Sessions

REQUESTS: dict[str, Any] = json.loads((EXAMPLES / "requests.json").read_text())
FIRST = [
    "POST /api/v1/designs",
    "POST /api/v1/designs/{design}/strokes",
    "POST /api/v1/designs/{design}/versions",
    "POST /api/v1/designs/{design}/shares",
    "POST /api/v1/jobs",
    "PUT /api/v1/views/{design}",
]
LAST = [
    "POST /api/v1/materials",
    "DELETE /api/v1/materials/{identifier}",
    "DELETE /api/v1/jobs/{job}",
    "DELETE /api/v1/designs/{design}/shares/{share}",
    "DELETE /api/v1/designs/{design}",
    "POST /api/v1/designs/{design}/recover",
    "DELETE /api/v1/sessions/{session}",
    "DELETE /api/v1/session",
]
ENDLESS = ("/events", "/picture")
"""Streams, and operations that need a browser watching."""


def check(example: Any, content: dict[str, Any], schema: dict[str, Any], name: str) -> None:
    """An example is what its part of the schema describes."""
    whole = content["schema"] | {"components": schema["components"]}
    faults = [error.message for error in jsonschema_rs.iter_errors(whole, example)]
    assert not faults, (name, faults)


def answer_in(operation: dict[str, Any]) -> dict[str, Any]:
    """The JSON of an operation's success; empty where it is a stream, a file or nothing."""
    success = next(s for s in operation["responses"] if s.startswith("2"))
    contents = operation["responses"][success].get("content", {})
    return contents["application/json"] if set(contents) == {"application/json"} else {}


def test_every_request_has_its_example(schema: dict[str, Any]) -> None:
    """Operations have their requests, `app/examples/requests.json` those of other addresses."""
    for name, operation in documented_operations(schema):
        for parameter in operation.get("parameters", []):
            assert parameter["in"] != "path" or parameter["example"], (name, parameter["name"])
        if "requestBody" in operation:
            content = operation["requestBody"]["content"]["application/json"]
            check(content["example"], content, schema, name)


def test_no_example_is_of_something_else(schema: dict[str, Any]) -> None:
    names = {name for name, _ in documented_operations(schema)}
    assert set(REQUESTS) <= names


@pytest.mark.parametrize(
    "name", ["charts/parse", "predict", "curve", "find", "fill", "pressure", "import", "stretch"]
)
def test_the_service_takes_the_example(
    client: TestClient, schema: dict[str, Any], name: str
) -> None:
    path = f"/api/v1/{name}"
    operation = schema["paths"][path]["post"]
    content = operation["requestBody"]["content"]["application/json"]
    answer = client.post(path, json=content["example"])
    assert answer.status_code == 200, answer.text
    check(answer.json(), answer_in(operation), schema, name)


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_service_takes_every_example(tmp_path: Path, schema: dict[str, Any]) -> None:
    """Each gets an answer of the documented shape."""
    patient = Settings(workers=1, worker_priority="low", job_timeout_s=600, data_dir=tmp_path)
    with TestClient(create_app(patient), base_url="http://127.0.0.1") as client:
        answers = every_answer(client)
    operations = dict(documented_operations(schema))
    assert set(answers) == {name for name, of in operations.items() if answer_in(of)}
    for name, answer in answers.items():
        check(answer, answer_in(operations[name]), schema, name)


def every_answer(client: TestClient) -> dict[str, Any]:
    """The answer of every operation that answers with JSON."""
    place: dict[str, Any] = {
        "material": "acrylic",
        "identifier": "acrylic",
        "number": 1,
        "way": "flat",
    }
    sessions = Sessions(client.app.state.database)  # type: ignore[attr-defined]
    place["session"] = sessions.begin("a token's id", LOCAL_USER)
    own: dict[str, Any] = {}
    answers = {}
    documented = dict(documented_operations(client.get("/openapi.json").json()))
    between = [name for name in documented if name not in (*FIRST, *LAST)]
    for name in (*FIRST, *between, *LAST):  # each finds the resources it needs
        method, path = name.split()
        if path.endswith(ENDLESS):
            continue
        sent = documented[name].get("requestBody", {}).get("content", {})
        body = sent.get("application/json", {}).get("example")
        if path.startswith("/api/v1/jobs/") and method == "GET":
            while client.get(f"/api/v1/jobs/{place['job']}").json()["state"] in OPEN:
                time.sleep(0.1)
        headers = {}
        if "design" in place and method in ("PUT", "PATCH", "POST"):
            tag = client.get(f"/api/v1/designs/{place['design']}").headers.get("etag")
            headers = {"If-Match": tag} if tag else {}
        answer = client.request(method, path.format(**(place | own)), json=body, headers=headers)
        answer.raise_for_status()
        kind = answer.headers.get("content-type", "")
        content: Any = None
        if answer.content and kind.startswith("application/json"):
            content = answer.json()
        if name == "POST /api/v1/designs":
            place["design"] = content["id"]
        elif name == "POST /api/v1/jobs":
            place["job"] = content["id"]
        elif name == "POST /api/v1/materials":
            own = {"identifier": content["id"]}
        elif name == "POST /api/v1/designs/{design}/shares":
            place |= {"share": content["id"], "token": content["token"]}
        if content is not None:
            answers[name] = content
    return answers
