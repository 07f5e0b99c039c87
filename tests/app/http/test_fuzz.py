"""Every operation of the real service, one field at a time: whatever comes is answered in words.

Requests start from a valid one, of which a field is left out, or replaced by an extreme value of
its schema or by something of another kind. `make test-hard` sends 10,000 (KNITCORE_FUZZ_REQUESTS).
"""

from __future__ import annotations

import copy
import json
import os
import random
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx2 as httpx
import pytest

from app.models.uploads import EXAMPLES
from app.operations.registry import operations
from tests.app.service import Service

REQUESTS = int(os.environ.get("KNITCORE_FUZZ_REQUESTS", "300"))
AT_ONCE, NEW_IDS_EVERY = 6, 250
PATIENCE_S = 150.0
HOSTILE: list[Any] = [
    *(None, True, False, 0, -1, 1, 0.5, 1e-300, 1e308, -1e308, 10**30, 10**400),
    *(float("nan"), float("inf"), "", " ", "\0", "\ud800", "nope", "K\nKP", "1e999", "Ω" * 3_000),
    *("../../etc/passwd", "<script>alert(1)</script>", "=1+1", "\u202e\ufffe", "K" * 100_000),
    *([], {}, [[]], [None] * 500, {"a": {"a": {}}}, [1e308] * 3, ["x"]),
]
IDS = ["abcdefgh", "x" * 64, "%00", "..%2f..", "é" * 20, "0", "-1", "9" * 30, "own:nope.123456"]
HEADERS = {
    "If-Match": ['"1"', "*", "W/x", '"' * 90],
    "If-None-Match": ['"1"', "*", "x" * 150],
    "Idempotency-Key": ["one-and-the-same", "short", "y" * 300],
}
Schema = dict[str, Any]


class Fuzz:
    """Makes requests from the schema of the service."""

    def __init__(self, whole: Schema, bodies: dict[str, Any]) -> None:
        self._parts = whole["components"]["schemas"]
        self._bodies = bodies
        self._operations = [
            (method.upper(), path, operation)
            for path, methods in whole["paths"].items()
            for method, operation in methods.items()
        ]

    def request(self, rng: random.Random, number: int, ids: dict[str, str]) -> dict[str, Any]:
        """Keywords for ``httpx.Client.stream``; operations take turns."""
        method, path, operation = self._operations[number % len(self._operations)]
        query, headers, url = {}, {}, path
        for parameter in operation.get("parameters", []):
            name, place = parameter["name"], parameter["in"]
            if place == "path":
                known = rng.random() < 0.85 and name in ids
                url = url.replace(f"{{{name}}}", ids[name] if known else rng.choice(IDS))
            elif place == "query" and rng.random() < 0.5:
                query[name] = str(self._value(rng, parameter["schema"]))[:200].encode(
                    errors="replace"
                )
            elif place == "header" and rng.random() < 0.5:
                headers[name] = rng.choice(HEADERS.get(name.title(), ["x"]))
        asked: dict[str, Any] = {"method": method, "url": url, "params": query, "headers": headers}
        if "requestBody" in operation:
            content = operation["requestBody"]["content"]["application/json"]
            body = copy.deepcopy(self._bodies[f"{method} {path}"])
            for _ in range(rng.choice((1, 1, 2, 3))):
                body = self._changed(rng, body, content["schema"])
            asked["content"] = json.dumps(body).encode()
            headers["Content-Type"] = "application/json"
        return asked

    def _changed(self, rng: random.Random, value: Any, schema: Schema) -> Any:
        schema = self._one(rng, schema)
        fields = schema.get("properties", {})
        if isinstance(value, dict) and fields and rng.random() < 0.97:
            name = (
                rng.choice([*fields, "nope"])
                if rng.random() < 0.98
                else rng.choice([*value, "nope"])
            )
            if name in value and rng.random() < 0.9:
                inner = self._changed(rng, value[name], fields.get(name, {}))
            elif name in value:
                return {key: kept for key, kept in value.items() if key != name}
            else:
                inner = self._value(rng, fields.get(name, {}))
            return value | {name: inner}
        if isinstance(value, list) and value and rng.random() < 0.6:
            at = rng.randrange(len(value))
            if rng.random() < 0.2:
                return value * rng.choice((0, 2, 50))
            return [
                *value[:at],
                self._changed(rng, value[at], schema.get("items", {})),
                *value[at + 1 :],
            ]
        return self._value(rng, schema)

    def _value(self, rng: random.Random, schema: Schema, depth: int = 0) -> Any:
        """An extreme or usual value of a schema; or something else altogether."""
        if not schema or depth > 8 or (rng.random() < 0.3 and depth < 2):
            return rng.choice(HOSTILE)
        schema = self._one(rng, schema)
        options = [schema["const"]] if "const" in schema else schema.get("enum", [])
        kind = schema.get("type")
        if options:
            return rng.choice(options)
        if kind == "object":
            fields, needed = schema.get("properties", {}), schema.get("required", [])
            names = [name for name in fields if name in needed or rng.random() < 0.4]
            return {name: self._value(rng, fields[name], depth + 1) for name in names}
        if kind == "array":
            least = schema.get("minItems", 0)
            count = rng.randint(
                least, max(least, min(schema.get("maxItems", least + 3), least + 3))
            )
            items = schema.get("prefixItems") or [schema.get("items", {})] * count
            return [self._value(rng, item, depth + 1) for item in items]
        return _simple(rng, schema, kind)

    def _one(self, rng: random.Random, schema: Schema) -> Schema:
        while True:
            if "$ref" in schema:
                schema = self._parts[schema["$ref"].rpartition("/")[2]]
            elif options := schema.get("anyOf") or schema.get("oneOf"):
                schema = rng.choice(options)
            elif len(schema.get("allOf", [])) == 1:
                schema = schema["allOf"][0]
            else:
                return schema


def _simple(rng: random.Random, schema: Schema, kind: str | None) -> Any:
    if kind in ("integer", "number"):
        low = schema.get("minimum", schema.get("exclusiveMinimum", -1e6))
        high = schema.get("maximum", schema.get("exclusiveMaximum", 1e6))
        found = rng.choice((low, high, low + 1e-9, high - 1e-9, rng.uniform(low, high), 1))
        return int(found) if kind == "integer" else found
    if kind == "string":
        text = rng.choice(("K", "KP\nPK", "acrylic", "wale", "a", " ", "é\n", "#112233"))
        return text * rng.choice((1, 1, min(schema.get("maxLength", 1), 2_000_000)))
    return rng.choice((True, False)) if kind == "boolean" else rng.choice(HOSTILE)


def _bodies() -> dict[str, Any]:
    """A valid body of every operation that takes one."""
    bodies: dict[str, Any] = json.loads((EXAMPLES / "requests.json").read_text())
    made = [operation for operation in operations().values() if operation.example]
    return bodies | {f"POST /api/v1{o.address}": dict(o.example or {}) for o in made}


def _new_ids(client: httpx.Client, bodies: dict[str, Any]) -> dict[str, str]:
    """Things to ask about."""
    design = client.post("/api/v1/designs", json=bodies["POST /api/v1/designs"]).json()["id"]
    address = f"/api/v1/designs/{design}"
    client.post(f"{address}/versions", json={"name": "first"}).raise_for_status()
    share = client.post(f"{address}/shares", json={"mode": "copy"}).json()
    client.put(f"/api/v1/views/{design}", json=bodies["PUT /api/v1/views/{design}"])
    job = client.post("/api/v1/jobs", json=bodies["POST /api/v1/jobs"]).json()["id"]
    ids = {"design": design, "job": job, "number": "1", "share": share["id"]}
    return ids | {"token": share["token"], "identifier": "acrylic", "material": "acrylic"}


@pytest.fixture
def service(tmp_path: Path) -> Iterator[Service]:
    started = Service(
        tmp_path, job_timeout_s="1", background_timeout_s="1", workers="2", worker_priority="low"
    )
    started.start().close()
    yield started
    started.kill()


@pytest.mark.slow
@pytest.mark.timeout(7200)
def test_whatever_comes_is_answered_in_words(service: Service, tmp_path: Path) -> None:
    seen: Counter[int] = Counter()
    strange: list[str] = []

    def send(client: httpx.Client, asked: dict[str, Any], number: int) -> None:
        told = f"{number}: {asked['method']} {asked['url'][:80]} {asked.get('content')!r:.300}"
        try:
            with client.stream(**asked) as answer:
                status = answer.status_code
                seen[status] += 1
                if status < 400:
                    return
                content = answer.read()
        except httpx.HTTPError as error:
            strange.append(f"{told}: {error!r}")
            return
        problem = answer.headers["content-type"] == "application/problem+json"
        surprise = status >= 500 and status != 503
        if surprise or not problem or not json.loads(content)["detail"]:
            strange.append(f"{told}: {status} {content[:300]!r}")

    bodies = _bodies()
    with (
        httpx.Client(base_url=service.url, timeout=PATIENCE_S) as client,
        ThreadPoolExecutor(AT_ONCE) as threads,
    ):
        fuzz = Fuzz(client.get("/openapi.json").json(), bodies)
        for start in range(0, REQUESTS, NEW_IDS_EVERY):
            ids = _new_ids(client, bodies)
            numbers = range(start, min(start + NEW_IDS_EVERY, REQUESTS))
            asked = [fuzz.request(random.Random(number), number, ids) for number in numbers]  # noqa: S311
            list(threads.map(send, [client] * len(asked), asked, numbers))
        assert client.get("/readyz").status_code == 200
    print(f"\n{seen.total()} answers: {dict(sorted(seen.items()))}")  # noqa: T201
    assert not strange, f"{len(strange)} of {REQUESTS}:\n" + "\n\n".join(strange[:40])
    assert seen.total() == REQUESTS
    assert {200, 404, 422} <= set(seen)
    log = service.log.read_text()
    assert "Traceback" not in log, log[log.index("Traceback") :][:4_000]
