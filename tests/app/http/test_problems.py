"""Refusals in words: what is to blame, and what would be accepted."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi.testclient import TestClient

API = "/api/v1"
STRETCH = {"chart": "KP\nPK", "material": "acrylic", "direction": "wale", "strain": 0.2}


@pytest.mark.parametrize(
    ("path", "body", "field", "remedy"),
    [
        ("/stretch", STRETCH | {"steps": 0}, "steps", "Use 1 or more."),
        ("/stretch", STRETCH | {"strain": 6}, "strain", "Use 5.0 or less."),
        ("/stretch", STRETCH | {"strain": 0}, "strain", "Use more than 0.0."),
        ("/stretch", STRETCH | {"steps": "many"}, "steps", "Use a whole number."),
        ("/stretch", STRETCH | {"direction": "up"}, "direction", "Use 'course' or 'wale'."),
        ("/stretch", STRETCH | {"colour": 1}, "colour", "Leave colour out"),
        ("/stretch", {**STRETCH, "material": None}, "material", "valid string"),
        ("/designs", {"name": ""}, "name", "Use 1 or more characters."),
        ("/designs", {"chart": "K"}, "name", "Give name"),
        ("/jobs", {"kind": "dance", "request": {}}, "kind", "Use one of 'atlas', 'bend'"),
        ("/jobs", {"request": {}}, "kind", "kind"),
        ("/jobs", {"kind": "curve", "request": {"chart": "K"}}, "request.material", "Give"),
    ],
)
def test_a_refusal_names_field_and_remedy(
    client: TestClient, path: str, body: dict[str, Any], field: str, remedy: str
) -> None:
    answer = client.post(f"{API}{path}", json=body)
    assert answer.status_code == 422
    assert answer.json()["field"] == field
    assert remedy in answer.json()["remedy"]


def test_a_form_is_told_to_be_json(client: TestClient) -> None:
    answer = client.post(f"{API}/predict", data={"chart": "K"})
    assert answer.status_code == 422
    assert "application/json" in answer.json()["remedy"]


@pytest.mark.parametrize(
    "path",
    [
        "/designs/no.such",
        "/designs/abc/versions/0",
        "/designs/abc/versions/two",
        f"/jobs/{'j' * 65}",
        "/shared/a.b",
        "/views/a.b/picture",
        "/materials/steel",
    ],
)
def test_what_cannot_be_is_not_found(client: TestClient, path: str) -> None:
    answer = client.get(f"{API}{path}")
    assert (answer.status_code, answer.json()["type"]) == (404, "not found")
    assert answer.json()["remedy"]


def test_heads_are_told_without_their_content(client: TestClient) -> None:
    for path in ("/", "/healthz", f"{API}/designs", "/static/app.css"):
        head, whole = client.head(path), client.get(path)
        assert head.status_code == whole.status_code
        assert head.headers["content-type"] == whole.headers["content-type"]
    assert client.head(f"{API}/stretch").status_code == 405
