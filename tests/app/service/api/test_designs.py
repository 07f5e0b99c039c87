"""Designs over REST."""

import json
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.service.designs import conditions
from tests.app.command_line import run

RIB = {"name": "Cuff", "material": "acrylic", "chart": "KPKP\nKPKP"}
DESIGNS = "/api/v1/designs"


@pytest.fixture
def made(client: TestClient) -> str:
    return str(client.post(DESIGNS, json=RIB).json()["id"])


def test_a_new_design_has_an_address_and_a_tag(client: TestClient) -> None:
    answer = client.post(DESIGNS, json=RIB)
    assert answer.status_code == 201
    assert answer.headers["etag"] == '"1"'
    read = client.get(answer.headers["location"])
    assert read.json() == answer.json()
    assert read.headers["etag"] == '"1"'
    for tags in ('"1"', '"7", W/"1"', "*"):
        same = client.get(answer.headers["location"], headers={"If-None-Match": tags})
        assert (same.status_code, same.content) == (304, b"")
    other = client.get(answer.headers["location"], headers={"If-None-Match": '"11"'})
    assert other.status_code == 200
    assert other.headers["cache-control"] == "private, no-cache"


def test_the_command_line_reads_the_same_document(
    client: TestClient, made: str, tmp_path: Path
) -> None:
    file = tmp_path / "cuff.json"
    file.write_text(json.dumps(client.get(f"{DESIGNS}/{made}").json()["document"]))
    assert run("predict", file, "--material", "acrylic")["columns"] == 4


@pytest.mark.parametrize("method", ["PUT", "PATCH"])
def test_of_two_changes_of_one_state_one_is_refused(
    client: TestClient, made: str, method: str
) -> None:
    body = RIB | {"name": "Mine"} if method == "PUT" else {"name": "Mine"}
    address = f"{DESIGNS}/{made}"
    first = client.request(method, address, json=body, headers={"If-Match": '"1"'})
    assert (first.status_code, first.headers["etag"]) == (200, '"2"')
    second = client.request(method, address, json=body, headers={"If-Match": '"1"'})
    assert (second.status_code, second.json()["type"]) == (412, "/problems/stale")
    blind = client.request(method, address, json=body)
    assert (blind.status_code, blind.json()["field"]) == (428, "If-Match")


def test_strokes_and_their_refusals(client: TestClient, made: str) -> None:
    address = f"{DESIGNS}/{made}/strokes"
    body: dict[str, Any] = {
        "rows": 2,
        "columns": 4,
        "runs": [{"row": 0, "column": 0, "stitches": "PP"}],
    }
    painted = client.post(address, json=body)
    assert (painted.json()["revision"], painted.headers["etag"]) == (2, '"2"')
    assert client.get(f"{DESIGNS}/{made}").json()["document"]["chart"] == "KPKP\nPPKP"
    assert client.post(address, json=body | {"rows": 3}).status_code == 409
    outside = body | {"runs": [{"row": 2, "column": 0, "stitches": "P"}]}
    assert client.post(address, json=outside).json()["field"] == "runs.0"
    assert client.post(f"{DESIGNS}/not-a-design/strokes", json=body).status_code == 404


def test_a_nul_in_a_search_is_refused(client: TestClient) -> None:
    answer = client.get(DESIGNS, params={"q": "\0"})
    assert (answer.status_code, answer.json()["field"]) == (400, "address")


def test_a_retry_with_a_key_makes_one_design(client: TestClient) -> None:
    key = {"Idempotency-Key": "a-key-of-this-test"}
    first = client.post(DESIGNS, json=RIB, headers=key)
    again = client.post(DESIGNS, json=RIB, headers=key)
    assert again.json() == first.json()
    assert (again.status_code, again.headers["location"]) == (201, first.headers["location"])
    other = client.post(DESIGNS, json=RIB | {"name": "Other"}, headers=key)
    assert (other.status_code, other.json()["field"]) == (422, "Idempotency-Key")


def test_the_latest_keys_of_a_user_are_known(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(conditions, "MAX_KEYS", 3)
    keys = [{"Idempotency-Key": f"key-number-{n}"} for n in range(5)]
    made = [client.post(DESIGNS, json=RIB, headers=key).json()["id"] for key in keys]
    known = [client.post(DESIGNS, json=RIB, headers=key).json()["id"] for key in keys[:1:-1]]
    assert known == made[:1:-1]
    assert client.post(DESIGNS, json=RIB, headers=keys[0]).json()["id"] not in made


def test_delete_list_and_recover(client: TestClient, made: str) -> None:
    client.post(DESIGNS, json=RIB)
    assert client.delete(f"{DESIGNS}/{made}").status_code == 204
    problem = client.get(f"{DESIGNS}/{made}")
    assert (problem.status_code, problem.json()["type"]) == (404, "/problems/not-found")
    aside = client.get(DESIGNS, params={"deleted": True}).json()["designs"]
    assert made in [d["id"] for d in aside]
    assert client.post(f"{DESIGNS}/{made}/recover").json()["name"] == "Cuff"
    listed = client.get(DESIGNS, params={"limit": 1}).json()
    assert [d["id"] for d in listed["designs"]] == [made]
    following = client.get(DESIGNS, params={"limit": 1, "cursor": listed["next_cursor"]})
    assert following.json()["designs"][0]["id"] != made


def test_versions_over_rest(client: TestClient, made: str) -> None:
    address = f"{DESIGNS}/{made}"
    kept = client.post(f"{address}/versions", json={"name": "As discussed"})
    assert (kept.status_code, kept.json()["number"]) == (201, 1)
    client.patch(address, json={"name": "Later"}, headers={"If-Match": '"1"'})
    assert client.post(f"{address}/versions/1/restore").status_code == 428
    restored = client.post(f"{address}/versions/1/restore", headers={"If-Match": '"2"'})
    assert restored.json()["name"] == "Cuff"
    names = [v["name"] for v in client.get(f"{address}/versions").json()["versions"]]
    assert names == ["As discussed", "Before “As discussed” was restored"]
    assert client.get(f"{address}/versions/2").json()["document"]["name"] == "Later"


def test_links_over_rest(client: TestClient, made: str) -> None:
    address = f"{DESIGNS}/{made}/shares"
    read = client.post(address, json={}).json()
    assert read["mode"] == "read"
    shown = client.get(f"/api/v1/shared/{read['token']}").json()
    assert shown["document"]["chart"] == RIB["chart"]
    refused = client.post(f"/api/v1/shared/{read['token']}/copy")
    assert (refused.status_code, refused.json()["type"]) == (403, "/problems/refused")
    copy = client.post(address, json={"mode": "copy"}).json()
    assert client.post(f"/api/v1/shared/{copy['token']}/copy").status_code == 201
    assert "token" not in client.get(address).text
    assert client.delete(f"{address}/{copy['id']}").status_code == 204
    assert client.get(f"/api/v1/shared/{copy['token']}").status_code == 404
