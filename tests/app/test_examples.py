"""The schema shows an example of everything, and the examples are what they say."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
from fastapi.testclient import TestClient

from app.models.uploads import EXAMPLES
from app.operations.registry import operations
from app.service.web.schema import documented_operations
from scripts.any_machine import OTHERS, SIZES, difference
from scripts.api_examples import ask_everything, patient_client

REQUESTS: dict[str, Any] = json.loads((EXAMPLES / "requests.json").read_text())
ANSWERS: dict[str, Any] = json.loads((EXAMPLES / "answers.json").read_text())["answers"]


def test_every_operation_has_its_example(schema: dict[str, Any]) -> None:
    """Operations have their requests, `app/examples/requests.json` those of other addresses;
    `make examples` asks for the answers.
    """

    def check(content: dict[str, Any], name: str) -> None:
        whole = content["schema"] | {"components": schema["components"]}
        faults = [error.message for error in jsonschema_rs.iter_errors(whole, content["example"])]
        assert not faults, (name, faults)

    for name, operation in documented_operations(schema):
        for parameter in operation.get("parameters", []):
            assert parameter["in"] != "path" or parameter["example"], (name, parameter["name"])
        if "requestBody" in operation:
            check(operation["requestBody"]["content"]["application/json"], name)
        success = next(s for s in operation["responses"] if s.startswith("2"))
        contents = operation["responses"][success].get("content", {})
        if set(contents) == {"application/json"}:  # not a stream or a file
            check(contents["application/json"], name)


def test_no_example_is_of_something_else(schema: dict[str, Any]) -> None:
    names = {name for name, _ in documented_operations(schema)}
    assert set(REQUESTS) <= names
    assert set(ANSWERS) <= names


@pytest.mark.parametrize(
    "name", ["charts/parse", "predict", "curve", "find", "fill", "pressure", "import", "stretch"]
)
def test_the_service_takes_the_example(
    client: TestClient, schema: dict[str, Any], name: str
) -> None:
    path = f"/api/v1/{name}"
    content = schema["paths"][path]["post"]["requestBody"]["content"]["application/json"]
    answer = client.post(f"/api/v1/{name}", json=content["example"])
    assert answer.status_code == 200, answer.text
    assert set(answer.json()) == set(ANSWERS[f"POST {path}"])


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_the_service_takes_every_example(tmp_path: Path) -> None:
    """`make examples` keeps what it answers, on any machine."""
    with patient_client(tmp_path) as client:
        answers = ask_everything(client)["answers"]
    assert set(answers) == set(ANSWERS)
    computed = {f"{of.method} /api/v1{of.address}" for of in operations().values()}
    for name, answer in answers.items():
        assert set(answer) == set(ANSWERS[name]), name
        if name in computed:
            sizes, others, where = difference(ANSWERS[name], answer)
            assert sizes <= SIZES, (name, where)
            assert others <= OTHERS, (name, where)
