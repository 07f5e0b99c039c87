"""The schema shows an example of everything, and the examples are what they say."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
from fastapi.testclient import TestClient

from app.http.schema import operations
from app.main import create_app
from app.models.uploads import EXAMPLES
from scripts.api_examples import ask_everything, patient_client

SCHEMA = create_app().openapi()
NAMES = operations(create_app())
REQUESTS: dict[str, Any] = json.loads((EXAMPLES / "requests.json").read_text())
ANSWERS: dict[str, Any] = json.loads((EXAMPLES / "answers.json").read_text())["answers"]


def _operation(name: str) -> dict[str, Any]:
    method, path = name.split()
    found: dict[str, Any] = SCHEMA["paths"][path][method.lower()]
    return found


def _check(value: Any, schema: dict[str, Any]) -> None:
    whole = schema | {"components": SCHEMA["components"]}
    jsonschema_rs.validate(whole, value)


@pytest.mark.parametrize("name", NAMES)
def test_every_operation_has_its_example(name: str) -> None:
    """Operations have their requests, `app/examples/requests.json` those of other addresses;
    `make examples` asks for the answers.
    """
    operation = _operation(name)
    for parameter in operation.get("parameters", []):
        assert parameter["in"] != "path" or parameter["example"], parameter["name"]
    if "requestBody" in operation:
        content = operation["requestBody"]["content"]["application/json"]
        _check(content["example"], content["schema"])
    success = next(s for s in operation["responses"] if s.startswith("2"))
    contents = operation["responses"][success].get("content", {})
    if set(contents) == {"application/json"}:  # not a stream or a file
        content = contents["application/json"]
        _check(content["example"], content["schema"])


def test_no_example_is_of_something_else() -> None:
    assert set(REQUESTS) <= set(NAMES)
    assert set(ANSWERS) <= set(NAMES)


@pytest.mark.parametrize(
    "name", ["charts/parse", "predict", "curve", "find", "fill", "pressure", "import", "stretch"]
)
def test_the_service_takes_the_example(client: TestClient, name: str) -> None:
    operation = f"POST /api/v1/{name}"
    content = _operation(operation)["requestBody"]["content"]["application/json"]
    answer = client.post(f"/api/v1/{name}", json=content["example"])
    assert answer.status_code == 200, answer.text
    assert set(answer.json()) == set(ANSWERS[operation])


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_service_takes_every_example(tmp_path: Path) -> None:
    """`make examples` keeps what it answers."""
    with patient_client(tmp_path) as client:
        answers = ask_everything(client)["answers"]
    assert set(answers) == set(ANSWERS)
    for name, answer in answers.items():
        assert set(answer) == set(ANSWERS[name]), name
