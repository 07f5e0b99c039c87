"""Jobs in the background: over REST, over restarts, and when something dies."""

from __future__ import annotations

import asyncio
import gzip
import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.service.compute import compute as compute_module
from app.service.compute.compute import Compute
from app.service.compute.processes import processes
from app.service.jobs import runner as runner_module
from app.service.jobs.document import JobState, JobStatus
from app.service.jobs.kinds import KINDS, job_key
from app.service.jobs.runner import JobRunner
from app.service.jobs.store import JobStore
from app.service.limits.user_limits import OverLimitError, UserLimits
from app.service.main import create_app
from app.service.problems import NotFoundError, StoreError
from app.service.settings import Settings
from app.service.store.database import Database
from app.service.store.schema import migrate
from knitcore.base.extensions import Group
from knitcore.yarn.library import fingerprint
from tests.app.jobs import WORK, Task, answers
from tests.app.running import Service
from tests.extension_package import install

JOBS = "/api/v1/jobs"
PATIENCE_S = 120.0
"""For a worker that starts, or answers, on a machine that is busy."""
GARTER = {"fabric": "garter", "columns": 9, "rows": 6}
STRETCH = {"chart": GARTER, "material": "acrylic", "direction": "wale", "strain": 0.3, "steps": 3}


@pytest.fixture(autouse=True)
def _kind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS, "work", WORK)


@pytest.fixture
def database(tmp_path: Path) -> Iterator[Database]:
    database = Database(f"sqlite:///{tmp_path / 'knit.sqlite3'}")
    migrate(database)
    yield database
    database.close()


@pytest.fixture(scope="module")
def compute() -> Iterator[Compute]:
    pool = Compute(processes(2), timeout_s=60)
    yield pool
    pool.close()


def _runner(database: Database, compute: Compute, timeout_s: float = 60.0) -> JobRunner:
    return JobRunner(JobStore(database, "main"), answers(compute, Path()), timeout_s)


async def _ended(runner: JobRunner, job: str, owner: str = "ada") -> JobStatus:
    async with asyncio.timeout(PATIENCE_S):
        while not (status := await runner.status(owner, job)).state.is_final:
            await asyncio.sleep(0.02)
    return status


async def _running(runner: JobRunner, job: str) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while (await runner.status("ada", job)).state is not JobState.RUNNING:
            await asyncio.sleep(0.02)


def _wish(what: str, mark: Path | str = "/nonexistent") -> str:
    return Task(what=what, mark=str(mark)).model_dump_json()


def test_a_stretch_test_in_the_background(client: TestClient) -> None:
    made = client.post(JOBS, json={"kind": "stretch", "request": STRETCH})
    assert made.status_code == 202
    address = made.headers["location"]
    with client.stream("GET", f"{address}/events") as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        events = [json.loads(e[6:]) for e in stream.iter_lines() if e.startswith("data: ")]
    assert events[-1]["state"] == "done"
    assert events[-1]["progress"] == 1
    result = client.get(f"{address}/result").json()
    direct = client.post("/api/v1/stretch", json=STRETCH).json()
    assert result == direct
    view = {"chart": GARTER, "material": "acrylic", "stretch": {"id": result["id"], "step": 2}}
    assert client.put("/api/v1/views/of-a-job-1", json=view).status_code == 200

    again = client.post(f"{address}/again").json()
    assert (again["state"], again["id"] != made.json()["id"]) == ("done", True)
    listed = client.get(JOBS, params={"limit": 1}).json()
    assert [j["id"] for j in listed["jobs"]] == [again["id"]]
    following = client.get(JOBS, params={"limit": 1, "cursor": listed["next_cursor"]}).json()
    assert [j["id"] for j in following["jobs"]] == [made.json()["id"]]

    client.app.state.recent.drop(result["id"])  # type: ignore[attr-defined]  # as after a restart
    assert client.put("/api/v1/views/of-a-job-1", json=view).status_code == 422
    third = client.post(f"{address}/again").headers["location"]
    with client.stream("GET", f"{third}/events") as stream:
        assert any('"done"' in line for line in stream.iter_lines())
    assert client.put("/api/v1/views/of-a-job-1", json=view).status_code == 200


def test_a_job_that_cannot_work_says_why(client: TestClient) -> None:
    body = {"kind": "stretch", "request": STRETCH | {"material": "steel"}}
    address = client.post(JOBS, json=body).headers["location"]
    with client.stream("GET", f"{address}/events") as stream:
        for _ in stream.iter_lines():
            pass
    told = client.get(address).json()
    assert (told["state"], told["problem"]["field"]) == ("failed", "material")
    assert client.get(f"{address}/result").status_code == 409
    assert client.get(f"{JOBS}/no-such-job").json()["field"] == "job"
    assert client.post(JOBS, json={"kind": "dance", "request": {}}).status_code == 422


def test_a_job_that_is_sent_twice_runs_once(client: TestClient) -> None:
    body = {"kind": "stretch", "request": STRETCH | {"strain": 0.12}}
    headers = {"Idempotency-Key": "the-same-job"}
    first, second = (client.post(JOBS, json=body, headers=headers) for _ in range(2))
    assert first.status_code == second.status_code == 202
    assert first.json()["id"] == second.json()["id"]
    body["request"] = STRETCH | {"strain": 0.13}
    other = client.post(JOBS, json=body, headers=headers)
    assert (other.status_code, other.json()["field"]) == (422, "Idempotency-Key")


def test_a_user_with_too_many_waiting_jobs_is_refused_at_once(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def scenario() -> None:
        monkeypatch.setattr(compute_module, "USER_LIMITS", UserLimits(jobs=1))
        pool = Compute(processes(1), timeout_s=60)
        runner = _runner(database, pool)
        first = await runner.submit("ada", "work", _wish("wait"))
        await _running(runner, first.id)
        await runner.submit("ada", "work", _wish("wait", "second"))
        async with asyncio.timeout(PATIENCE_S):
            while runner.counts()["waiting"] != 1:
                await asyncio.sleep(0.02)
        with pytest.raises(OverLimitError, match="1 of 1 jobs"):
            await runner.submit("ada", "work", _wish("wait", "third"))
        assert len(runner.store.page("ada", limit=9, cursor=None).jobs) == 2
        await runner.close()
        pool.close()

    asyncio.run(scenario())


def test_jobs_are_private_and_results_are_shared_by_content(
    database: Database, compute: Compute
) -> None:
    async def scenario() -> None:
        runner = _runner(database, compute)
        first = await runner.submit("ada", "work", _wish("answer"))
        assert (await _ended(runner, first.id)).state is JobState.DONE
        with pytest.raises(NotFoundError):
            await runner.status("eve", first.id)
        with pytest.raises(NotFoundError):
            await runner.cancel("eve", first.id)
        second = await runner.submit("bob", "work", _wish("answer"))
        assert second.state is JobState.DONE
        result = runner.store.result("bob", second.id)
        assert result is not None
        assert gzip.decompress(result) == b'{"value":42}'

    asyncio.run(scenario())


def test_a_result_of_other_code_is_computed_again(
    database: Database, compute: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def scenario() -> None:
        runner = _runner(database, compute)
        first = await runner.submit("ada", "work", _wish("answer"))
        assert (await _ended(runner, first.id)).state is JobState.DONE
        monkeypatch.setattr(fingerprint, "code_version", lambda *_: "the next one")
        again = await runner.again("ada", first.id)
        assert again.state is JobState.WAITING
        assert (await _ended(runner, again.id)).state is JobState.DONE

    asyncio.run(scenario())


def test_a_result_of_other_yarns_is_computed_again(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    before = job_key("work", "{}")
    install(monkeypatch, tmp_path, "yarns", "1.0", {Group.MATERIALS: {"yarns": "yarns:all"}})
    assert job_key("work", "{}") != before


def test_progress_and_cancel(database: Database, compute: Compute) -> None:
    async def scenario() -> None:
        runner = _runner(database, compute)
        job = (await runner.submit("ada", "work", _wish("wait"))).id
        await _running(runner, job)
        async with asyncio.timeout(PATIENCE_S):
            while (await runner.status("ada", job)).progress != 0.25:
                await asyncio.sleep(0.02)
        assert (await runner.cancel("ada", job)).state is JobState.CANCELLED
        async with asyncio.timeout(PATIENCE_S):
            while runner.counts()["running"]:
                await asyncio.sleep(0.02)
        status = await runner.status("ada", job)
        assert (status.state, status.progress) == (JobState.CANCELLED, 0.25)
        assert (await runner.cancel("ada", job)).state is JobState.CANCELLED
        assert runner.store.result("ada", job) is None

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("what", "type_", "says"),
    [("die", "busy", "died"), ("fail", "internal", "unexpected error"), ("wait", "busy", "0.3 s")],
)
def test_an_unexpected_error_fails_only_its_own_job(
    database: Database, compute: Compute, what: str, type_: str, says: str
) -> None:
    async def scenario() -> None:
        hasty = _runner(database, compute, timeout_s=0.3 if what == "wait" else 60.0)
        runner = _runner(database, compute)
        bad = await hasty.submit("ada", "work", _wish(what))
        good = await runner.submit("ada", "work", _wish("answer", what))
        failed = await _ended(hasty, bad.id)
        assert failed.state is JobState.FAILED
        assert failed.problem is not None
        assert failed.problem.type == f"/problems/{type_}"
        assert says in failed.problem.detail
        assert (await _ended(runner, good.id)).state is JobState.DONE

    asyncio.run(scenario())


def test_waiting_jobs_continue_and_running_ones_are_interrupted(
    database: Database, compute: Compute
) -> None:
    """A service that was killed: its successor finds the rows as they were."""

    async def scenario() -> None:
        store = JobStore(database, "main")
        ran = store.add("ada", "work", _wish("wait"), "k1", JobState.WAITING)
        waited = store.add("ada", "work", _wish("answer"), "k2", JobState.WAITING)
        others = JobStore(database, "another process")
        theirs = others.add("ada", "work", _wish("wait"), "k1", JobState.WAITING)
        assert store.begin(ran.id)
        assert others.begin(theirs.id)
        runner = _runner(database, compute)
        await runner.resume()
        interrupted = await runner.status("ada", ran.id)
        assert interrupted.state is JobState.INTERRUPTED
        assert interrupted.problem is not None
        assert interrupted.problem.remedy == "Run it again."
        assert (await _ended(runner, waited.id)).state is JobState.DONE
        assert (await runner.status("ada", theirs.id)).state is JobState.RUNNING

    asyncio.run(scenario())


def test_a_service_that_stops_puts_its_jobs_back_in_line(
    database: Database, compute: Compute, tmp_path: Path
) -> None:
    mark = tmp_path / "mark"

    async def stopped() -> str:
        runner = _runner(database, compute)
        job = (await runner.submit("ada", "work", _wish("wait", mark))).id
        await _running(runner, job)
        await runner.close()
        assert (await runner.status("ada", job)).state is JobState.WAITING
        return job

    async def started_again(job: str) -> None:
        mark.touch()
        runner = _runner(database, compute)
        await runner.resume()
        assert (await _ended(runner, job)).state is JobState.DONE

    asyncio.run(started_again(asyncio.run(stopped())))


def test_a_result_outlives_a_database_outage(
    database: Database, compute: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runner_module, "STORE_RETRY_S", (0.01, 0.01, 0.01))

    async def scenario() -> None:
        runner = _runner(database, compute)
        real, failures = runner.store.finish, []

        def away(*args: Any) -> bool:
            if len(failures) < 3:
                failures.append(1)
                raise StoreError("away")
            return real(*args)

        monkeypatch.setattr(runner.store, "finish", away)
        job = await runner.submit("ada", "work", _wish("answer"))
        assert (await _ended(runner, job.id)).state is JobState.DONE
        assert len(failures) == 3

    asyncio.run(scenario())


def test_the_longest_unused_results_make_room(database: Database) -> None:
    store = JobStore(database, "main")
    for number in range(3):
        status = store.add("ada", "work", "{}", f"k{number}", JobState.WAITING)
        assert store.finish(status.id, "work", f"k{number}", os.urandom(1000))
        time.sleep(0.002)
    assert store.knows("k0")
    store.tidy(most_bytes=2100)
    assert [store.knows(f"k{n}") for n in range(3)] == [True, False, True]


@pytest.mark.slow
def test_the_real_service_killed_in_mid_job(tmp_path: Path) -> None:
    service = Service(tmp_path)
    client = service.start()
    chart = {"fabric": "garter", "columns": 150, "rows": 150}
    long = {"kind": "stretch", "request": STRETCH | {"chart": chart, "steps": 60}}
    try:
        job = client.post(JOBS, json=long).json()["id"]
        deadline = time.monotonic() + PATIENCE_S
        while client.get(f"{JOBS}/{job}").json()["state"] == "waiting":
            assert time.monotonic() < deadline
            time.sleep(0.05)
        service.kill()
        client.close()
        client = service.start()
        told = client.get(f"{JOBS}/{job}").json()
        assert told["state"] == "interrupted"
        assert client.get(f"{JOBS}/{job}/result").status_code == 409
        again = client.post(f"{JOBS}/{job}/again").json()
        assert again["state"] == "waiting"
        assert client.delete(f"{JOBS}/{again['id']}").json()["state"] == "cancelled"
    finally:
        client.close()
        service.kill()


def test_settings_reach_the_jobs(tmp_path: Path) -> None:
    settings = Settings(workers=1, data_dir=tmp_path, background_timeout_s=7, process_name="two")
    app = create_app(settings)
    with TestClient(app, base_url="http://127.0.0.1"):
        assert app.state.jobs.timeout_s == 7
        assert app.state.jobs.store.process == "two"
