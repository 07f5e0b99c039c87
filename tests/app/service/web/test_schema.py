"""The schema as generators of clients need it, and the headers that it promises."""

from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.service.jobs.kinds import KINDS
from app.service.web.schema import TAGS, documented_operations

FIXED = ("/openapi.json", "/docs", "/api/v1/patterns", "/api/v1/materials/acrylic")


def test_every_operation_has_an_id_of_its_own_and_a_described_tag(schema: dict[str, Any]) -> None:
    ids = [operation["operationId"] for _, operation in documented_operations(schema)]
    assert len(ids) == len(set(ids))
    assert all(name.isidentifier() for name in ids)
    assert {
        tag for _, operation in documented_operations(schema) for tag in operation["tags"]
    } == set(TAGS)


def test_ways_to_sign_in_are_declared(schema: dict[str, Any]) -> None:
    ways = schema["components"]["securitySchemes"]
    assert ways["token"]["scheme"] == "bearer"
    assert [*ways] == [name for way in schema["security"] for name in way]
    assert schema["paths"]["/healthz"]["get"]["security"] == []


def test_headers_are_described(schema: dict[str, Any]) -> None:
    made = schema["paths"]["/api/v1/designs"]["post"]["responses"]
    assert {"ETag", "Location", "RateLimit-Remaining"} <= set(made["201"]["headers"])
    assert "Retry-After" in made["429"]["headers"]
    assert "WWW-Authenticate" in made["401"]["headers"]
    for _, operation in documented_operations(schema):
        for response in operation["responses"].values():
            for header in response.get("headers", {}).values():
                assert header["$ref"].rpartition("/")[2] in schema["components"]["headers"]


def test_results_of_jobs_are_distinguished_by_their_kind(schema: dict[str, Any]) -> None:
    answer = schema["paths"]["/api/v1/jobs/{job}/result"]["get"]["responses"]["200"]
    result = answer["content"]["application/json"]["schema"]
    assert result["discriminator"]["propertyName"] == "kind"
    assert set(result["discriminator"]["mapping"]) == set(KINDS)


@pytest.mark.parametrize("path", FIXED)
def test_fixed_answers_are_packed_and_sent_once(client: TestClient, path: str) -> None:
    whole = client.get(path)
    assert whole.headers["Content-Encoding"] == "gzip"
    plain = client.get(path, headers={"Accept-Encoding": "identity"})
    assert "Content-Encoding" not in plain.headers
    assert (plain.content, plain.headers["ETag"]) == (whole.content, whole.headers["ETag"])
    known = client.get(path, headers={"If-None-Match": whole.headers["ETag"]})
    assert (known.status_code, known.content) == (304, b"")
    assert client.get(path, headers={"If-None-Match": '"another"'}).status_code == 200


def test_long_answers_are_packed(client: TestClient) -> None:
    answer = client.post("/api/v1/charts/parse", json={"text": "KP" * 450 + "\n" + "PK" * 450})
    assert answer.headers["Content-Encoding"] == "gzip"
