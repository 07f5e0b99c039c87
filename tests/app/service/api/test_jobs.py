"""A job accepts exactly what its operation accepts, and its result is sent to few at once."""

import gzip
import json
import os
import re
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from unittest.mock import AsyncMock, Mock

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.registry import operations
from app.service.jobs.document import JobState, JobStatus
from app.service.jobs.kinds import KINDS, JobOf, accepted
from app.service.jobs.store import PART_BYTES, StoredResult
from app.service.limits.user_limits import USER_LIMITS
from app.service.problems import StoreError
from app.service.web.bodies import SMALL_BYTES
from tests.app.clients import LONG, login, served, state_of
from tests.app.running import wait_until

CHART = {"chart": "KP/PK", "material": "acrylic"}
PULL = CHART | {"direction": "wale", "steps": 2}
LARGE = {"fabric": "garter", "columns": 150, "rows": 150}
CROSSED = {
    "outline": [[0, 0], [50, 100], [50, 0], [0, 100]],
    "edges": {"bottom": [1]},
    "conditions": [{"kind": "held", "edge": "bottom"}],
}
YARN = {"name": "mine", "bending_modulus_n_mm2": 0.03, "diameter_mm": 1.4}
REFUSED: dict[str, tuple[str, dict[str, Any], str]] = {
    "a NUL in a chart": ("relax", CHART | {"chart": "KP\u0000"}, "body"),
    "half a character in a chart": ("relax", CHART | {"chart": "KP\ud800"}, "body"),
    "an unknown yarn": ("stretch", PULL | {"material": "steel", "strain": 0.1}, "material"),
    "a yarn that is gone": ("bend", CHART | {"material": "own:x.000000"}, "material"),
    "two faults": ("relax", {"chart": "XY", "material": "steel"}, "chart"),
    "no load": ("stretch", PULL, "strain"),
    "two loads": ("stretch", PULL | {"strain": 0.1, "force_n": 1}, "force_n"),
    "too many steps": ("stretch", PULL | {"chart": LARGE, "strain": 0.1, "steps": 999}, "steps"),
    "a crossed outline": ("piece", CHART | {"piece": CROSSED}, "outline"),
    "a fine mesh": ("bias", CHART | {"strain": 0.2, "mesh_mm": 0.01}, "mesh_mm"),
    "two sorts of length": (
        "relax",
        CHART | {"loop_length_mm": 12, "loop_lengths_mm": [[12], [12]]},
        "loop_lengths_mm",
    ),
    "friction held flat": ("relax", CHART | {"friction": 0.2, "flat": True}, "flat"),
    "no maps": ("fill", {"material": "acrylic"}, "modulus_course_n_per_mm"),
}  # fmt: skip


@pytest.mark.parametrize("padding", [0, SMALL_BYTES], ids=["here", "in a worker"])
@pytest.mark.parametrize("case", REFUSED)
def test_a_job_is_refused_as_its_operation_is(client: TestClient, case: str, padding: int) -> None:
    kind, request, field = REFUSED[case]
    job = {"kind": kind, "request": request}
    answers = [
        client.post(
            f"/api/v1{address}",
            content=json.dumps(content) + padding * " ",
            headers={"Content-Type": "application/json"},
        )
        for address, content in ((operations()[kind].address, request), ("/jobs", job))
    ]
    assert [answer.status_code for answer in answers] == [422, 422]
    direct, queued = (answer.json() for answer in answers)
    assert field in direct["field"]
    assert queued["field"] == direct["field"]
    assert queued["remedy"] == direct["remedy"]
    place = re.compile(r" at line \d+ column \d+")  # of the other body
    assert place.sub("", queued["detail"]) == place.sub("", direct["detail"])


def test_every_example_is_accepted(context: Context) -> None:
    """Nothing that an operation takes is refused by the queue."""
    for kind, operation in KINDS.items():
        if operation.example:
            request = operation.request.model_validate(operation.example)
            job = JobOf.model_construct(kind=kind, request=request)
            assert accepted(job, context)[0] == kind


@pytest.fixture
def result(client: TestClient) -> str:
    """The address of a job's result."""
    job = {"kind": "stretch", "request": PULL | {"strain": 0.1}}
    address = client.post("/api/v1/jobs", json=job).json()["id"]
    result = f"/api/v1/jobs/{address}/result"
    wait_until(lambda: client.get(result).status_code == 200)
    return result


@pytest.mark.parametrize("coding", ["gzip", "identity"])
@pytest.mark.parametrize(("part", "status"), [(StoreError("away"), 503), (None, 404)])
def test_a_result_that_is_lost_before_its_first_part_is_a_problem(
    client: TestClient,
    result: str,
    monkeypatch: pytest.MonkeyPatch,
    coding: str,
    part: StoreError | None,
    status: int,
) -> None:
    monkeypatch.setattr(StoredResult, "unpacked_bytes", 100)
    monkeypatch.setattr(StoredResult, "_part", Mock(side_effect=part, return_value=None))
    answer = client.get(result, headers={"Accept-Encoding": coding})
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert ("Retry-After" in answer.headers) is (status == 503)
    assert state_of(client).concurrency.held("results", "local") == 0


def test_the_events_of_a_job_outlast_a_lost_database(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    job = client.post("/api/v1/jobs", json={"kind": "stretch", "request": LONG}).json()
    runner = state_of(client).jobs
    done = JobStatus.model_validate(job | {"state": "done"})
    states = [JobStatus.model_validate(job), StoreError("away"), done]
    monkeypatch.setattr(type(runner), "status", AsyncMock(side_effect=states))
    events = client.get(f"/api/v1/jobs/{job['id']}/events").text
    monkeypatch.undo()
    assert client.delete(f"/api/v1/jobs/{job['id']}").status_code == 200
    assert events.count("event: status") == 2
    assert '"state":"done"' in events


def test_results_are_sent_in_turn_and_leave_threads_to_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    part, held, go_on = StoredResult._part, list[int](), threading.Event()

    def slowly(self: StoredResult, start: int, size: int) -> bytes | None:
        if start:
            held.append(start)
            go_on.wait(150)
        return part(self, start, size)

    monkeypatch.setattr(StoredResult, "_part", slowly)
    many = USER_LIMITS.results
    with served(require_login=True, data_dir=tmp_path) as client, ThreadPoolExecutor(many) as pool:
        ada, bob = login(client, "ada"), login(client, "bob")
        store = state_of(client).jobs.store
        job = store.add("ada", "stretch", "{}", "key", JobState.WAITING).id
        store.finish(job, "stretch", "key", gzip.compress(os.urandom(2 * PART_BYTES)))
        address = f"/api/v1/jobs/{job}/result"
        answers = [pool.submit(client.get, address, headers=ada) for _ in range(many)]
        wait_until(lambda: state_of(client).concurrency.held("results", "ada") == many)
        wait_until(lambda: held)
        for path in ("jobs", "designs"):
            assert client.get(f"/api/v1/{path}", headers=bob).status_code == 200
        assert len(held) == 1
        go_on.set()
        assert {answer.result().status_code for answer in answers} == {200}


def test_a_user_reads_few_results_at_once(client: TestClient, result: str) -> None:
    uses = state_of(client).concurrency
    with uses.growing("results", "local") as count:
        count(USER_LIMITS.results)
        refused = client.get(result)
        assert (refused.status_code, refused.json()["field"]) == (429, "results")
    assert client.get(result).status_code == 200
    known = {"If-None-Match": client.get(result).headers["ETag"]}
    assert client.get(result, headers=known).status_code == 304
    assert uses.held("results", "local") == 0
