"""Requests that no schema describes: none is a surprise to the service, and it stays up.

Those that the schema describes, right and wrong, are sent by ``test_documented.py``.
"""

import json
import re
from itertools import cycle
from pathlib import Path
from typing import Any
from urllib.parse import quote

from fastapi.testclient import TestClient

from app.service.store.database import Database
from tests.app.clients import served

JSON = {"Content-Type": "application/json"}
PATHS = [
    "/api/v1/charts/parse",
    "/api/v1/predict",
    "/api/v1/designs",
    "/api/v1/designs/%00",
    "/api/v1/designs/abcdefgh/strokes",
    "/api/v1/designs?limit=-1",
    "/api/v1/designs?cursor=%ff",
    "/api/v1/jobs",
    "/api/v1/jobs/abcdefgh/events",
    "/api/v1/shared/../../etc/passwd",
    "/api/v1/views/abcdefgh",
    "/static/../app/service/main.py",
    "/static/%2e%2e/%2e%2e/etc/passwd",
    "/view/%2e%2e/",
    "/" + "a" * 5000,
]
BODIES = [
    b"",
    b"{",
    b"null",
    b"[]",
    b'"K"',
    b"NaN",
    b'{"text": "K"',
    b'{"text": "\\ud800"}',
    b'{"name": "\\ud800", "material": "acrylic", "chart": "K"}',
    b'{"chart": ["K"], "material": {}}',
    b'{"chart": "' + b"K" * 2000 + b'", "material": "acrylic"}',
    b"[" * 20_000,
    b'{"a":' * 5_000,
    b"\xff\xfe\x00",
    json.dumps({"rows": 10**30, "columns": -1, "runs": [{}] * 100}).encode(),
    json.dumps({"kind": "stretch", "request": None}).encode(),
    b'{"name": "x", "material": "acrylic", "chart": "K", "note": 1e999}',
]
HEADERS = [
    {"Content-Type": "text/html"},
    {"Content-Type": "multipart/form-data; boundary="},
    {"If-Match": '"' * 50},
    {"Idempotency-Key": "x" * 500},
    {"Content-Length": "-5"},
    {"Cookie": "a=b; ;;=; knitcore_session=%%%"},
    {"X-Request-ID": "a\tb"},
    {"Accept-Encoding": "gzip;q=nonsense"},
]
METHODS = ["GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "HEAD", "BREW"]


def test_nothing_surprises_the_service(client: TestClient, schema: dict[str, Any]) -> None:
    """Every body at every address, then every method and header."""
    known = [re.sub(r"\{\w+\}", "abcdefgh", path) for path in schema["paths"]]
    paths = [path for path in PATHS + known if not path.endswith("/events")]
    bodies = cycle(BODIES)
    requests = [("POST", path, next(bodies), JSON) for path in paths for _ in range(5)]
    requests += [(method, path, next(bodies), JSON) for method in METHODS for path in PATHS]
    requests += [("POST", path, b"{}", more) for path in PATHS for more in HEADERS]
    seen = set()
    for method, path, content, headers in requests:
        answer = client.request(method, path, content=content, headers=headers)
        seen.add(answer.status_code)
        assert answer.status_code < 500, f"{method} {path[:60]} {headers}"
        if answer.status_code >= 400 and method != "HEAD":
            assert answer.headers["content-type"] == "application/problem+json", path[:60]
            problem = answer.json()
            assert problem["status"] == answer.status_code
            assert problem["detail"]
    assert seen >= {200, 404, 405, 413, 422}
    assert client.get("/readyz").status_code == 200


TEXTS = ["\0", "a\0b", "\ud800", "\udfff\ud800", "\uffff", "'\"; --", "%"]


def test_no_character_is_a_surprise_to_either_database(database: Database, tmp_path: Path) -> None:
    """PostgreSQL takes no NUL and no half of a character; whoever sends one is told so."""
    with served(database=database, data_dir=tmp_path) as client:
        for text in TEXTS:
            check_every_place(client, text)


def check_every_place(client: TestClient, text: str) -> None:
    """Send a text wherever one is taken."""
    design: dict[str, Any] = {"name": "x", "material": "acrylic", "chart": "KP"}
    region = {"name": text, "cells": [{"row": 0, "column": 0}]}
    yarn = client.get("/api/v1/materials/acrylic/document").json()
    made = client.post("/api/v1/designs", json=design).json()["id"]
    bodies = [
        *(("/designs", design | {field: text}) for field in design),
        ("/designs", design | {"note": text}),
        ("/designs", design | {"regions": [region]}),
        ("/designs", design | {text: text}),
        (f"/designs/{made}/versions", {"name": text}),
        *(("/materials", yarn | {field: text}) for field in ("name", "note", "identifier")),
        ("/materials", yarn | {"yarn": yarn["yarn"] | {"fibre": text, "product": text}}),
        ("/jobs", {"kind": "curve", "request": {"chart": text, "material": "acrylic"}}),
        ("/jobs", {"kind": "curve", "request": {"chart": "KP", "material": text}}),
        ("/predict", {"chart": "KP", "material": f"own:{text}"}),
    ]
    answers = [
        client.post(f"/api/v1{path}", content=json.dumps(body), headers=JSON)
        for path, body in bodies
    ]
    sent = quote(text, errors="surrogatepass")
    paths = "designs?q=", "designs?cursor=", "materials/", "materials/own:", "jobs/", "shared/"
    answers += [client.get(f"/api/v1/{path}{sent}") for path in paths]
    answers.append(client.delete(f"/api/v1/materials/own:{sent}"))
    answers.append(client.get("/api/v1/designs", headers={"Cookie": f"knitcore_session={sent}"}))
    assert max(answer.status_code for answer in answers) < 500
    if "\0" in text:
        assert {answer.status_code for answer in answers[: len(bodies)]} == {422}
        assert {answer.status_code for answer in answers[len(bodies) : -1]} == {400}
