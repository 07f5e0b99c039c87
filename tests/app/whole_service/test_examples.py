"""The schema shows an example of everything, and the examples are what they say."""

import json
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
from fastapi.testclient import TestClient

from app.requests.uploads import EXAMPLES
from app.service.web.schema import documented_operations
from scripts.api_examples import ask_everything, patient_client

REQUESTS: dict[str, Any] = json.loads((EXAMPLES / "requests.json").read_text())


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
    """Each gets an answer of the documented shape; `make examples` keeps it for the reference."""
    with patient_client(tmp_path) as client:
        answers = ask_everything(client)
    operations = dict(documented_operations(schema))
    assert set(answers) == {name for name, of in operations.items() if answer_in(of)}
    for name, answer in answers.items():
        check(answer, answer_in(operations[name]), schema, name)


def test_answers_are_shown_where_they_have_been_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "answers.json").write_text('{"GET /healthz": {"status": "shown"}}')
    monkeypatch.setattr("app.service.web.schema.EXAMPLES", tmp_path)
    with patient_client(tmp_path) as client:
        answers = client.get("/openapi.json").json()["paths"]["/healthz"]["get"]["responses"]
    assert answers["200"]["content"]["application/json"]["example"] == {"status": "shown"}
