"""Jobs in the background: over REST, over restarts, and when something dies."""

import json
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.service.compute import compute as compute_module
from app.service.compute.compute import Compute
from app.service.compute.processes import processes
from app.service.jobs import runner as runner_module
from app.service.jobs.document import JobState
from app.service.jobs.kinds import job_key
from app.service.jobs.runner import JobRunner
from app.service.jobs.store import JobStore
from app.service.limits.user_limits import OverLimitError, UserLimits
from app.service.problems import NotFoundError, StoreError
from app.service.store.database import Database
from knitcore.base.extensions import Group
from knitcore.yarn.library import fingerprint
from tests.app.clients import LONG, served, state_of
from tests.app.running import Service, wait_until
from tests.app.service.jobs.helpers import counted, ended, runner_of, running, status_when, task
from tests.extension_package import install

JOBS = "/api/v1/jobs"
GARTER = {"fabric": "garter", "columns": 9, "rows": 6}
STRETCH = {"chart": GARTER, "material": "acrylic", "direction": "wale", "strain": 0.3, "steps": 3}


@pytest.fixture
def runner(database: Database, compute: Compute) -> JobRunner:
    return runner_of(database, compute)


def followed(client: TestClient, address: str) -> Any:
    """The last state of a job that its events tell."""
    with client.stream("GET", f"{address}/events") as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        *_, last = (line for line in stream.iter_lines() if line.startswith("data: "))
    return json.loads(last.removeprefix("data: "))


def test_a_stretch_test_in_the_background(client: TestClient) -> None:
    made = client.post(JOBS, json={"kind": "stretch", "request": STRETCH})
    assert made.status_code == 202
    address = made.headers["location"]
    last = followed(client, address)
    assert (last["state"], last["progress"]) == ("done", 1)
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

    state_of(client).recent.drop(result["id"])  # as after a restart
    assert client.put("/api/v1/views/of-a-job-1", json=view).status_code == 422
    third = client.post(f"{address}/again").headers["location"]
    assert followed(client, third)["state"] == "done"
    assert client.put("/api/v1/views/of-a-job-1", json=view).status_code == 200


def test_a_job_that_cannot_work_says_why(client: TestClient) -> None:
    body = {"kind": "stretch", "request": STRETCH | {"strain": 4.9}}
    address = client.post(JOBS, json=body).headers["location"]
    last = followed(client, address)
    assert (last["state"], last["problem"]["field"]) == ("failed", "strain")
    assert client.get(address).json() == last
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


async def test_a_user_with_too_many_waiting_jobs_is_refused_at_once(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_module, "USER_LIMITS", UserLimits(jobs=1))
    with closing(Compute(processes(1), timeout_s=60)) as pool:
        runner = runner_of(database, pool)
        first = await runner.submit("ada", "work", task("wait"))
        await running(runner, first.id)
        await runner.submit("ada", "work", task("wait", "second"))
        await counted(runner, "waiting", 1)
        with pytest.raises(OverLimitError, match="1 of 1 jobs"):
            await runner.submit("ada", "work", task("wait", "third"))
        assert len(runner.store.page("ada", limit=9, cursor=None).jobs) == 2
        await runner.close()


async def test_jobs_are_private_and_results_are_shared_by_content(runner: JobRunner) -> None:
    first = await runner.submit("ada", "work", task("answer"))
    assert (await ended(runner, first.id)).state is JobState.DONE
    with pytest.raises(NotFoundError):
        await runner.status("eve", first.id)
    with pytest.raises(NotFoundError):
        await runner.cancel("eve", first.id)
    second = await runner.submit("bob", "work", task("answer"))
    assert second.state is JobState.DONE
    result = runner.store.result("bob", second.id)
    assert result is not None
    assert b"".join(result.unpacked()) == b'{"value":42}'


async def test_a_result_of_other_code_is_computed_again(
    runner: JobRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = await runner.submit("ada", "work", task("answer"))
    assert (await ended(runner, first.id)).state is JobState.DONE
    monkeypatch.setattr(fingerprint, "code_version", lambda *_: "the next one")
    again = await runner.again("ada", first.id)
    assert again.state is JobState.WAITING
    assert (await ended(runner, again.id)).state is JobState.DONE


def test_a_result_of_other_yarns_is_computed_again(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    before = job_key("work", "{}")
    install(monkeypatch, tmp_path, "yarns", "1.0", {Group.MATERIALS: {"yarns": "yarns:all"}})
    assert job_key("work", "{}") != before


async def test_progress_and_cancel(runner: JobRunner) -> None:
    job = (await runner.submit("ada", "work", task("wait"))).id
    await status_when(runner, job, lambda status: status.progress == 0.25)
    assert (await runner.cancel("ada", job)).state is JobState.CANCELLED
    await counted(runner, "running", 0)
    status = await runner.status("ada", job)
    assert (status.state, status.progress) == (JobState.CANCELLED, 0.25)
    assert (await runner.cancel("ada", job)).state is JobState.CANCELLED
    assert runner.store.result("ada", job) is None


@pytest.mark.parametrize(
    ("what", "type_", "says"),
    [("die", "busy", "died"), ("fail", "internal", "unexpected error"), ("wait", "busy", "0.3 s")],
)
async def test_an_unexpected_error_fails_only_its_own_job(
    database: Database, compute: Compute, runner: JobRunner, what: str, type_: str, says: str
) -> None:
    hasty = runner_of(database, compute, timeout_s=0.3 if what == "wait" else 60.0)
    bad = await hasty.submit("ada", "work", task(what))
    good = await runner.submit("ada", "work", task("answer", what))
    failed = await ended(hasty, bad.id)
    assert failed.state is JobState.FAILED
    assert failed.problem is not None
    assert failed.problem.type == f"/problems/{type_}"
    assert says in failed.problem.detail
    assert (await ended(runner, good.id)).state is JobState.DONE


async def test_waiting_jobs_continue_and_running_ones_are_interrupted(
    database: Database, runner: JobRunner
) -> None:
    """A service that was killed: its successor finds the rows as they were."""
    store = JobStore(database, "main")
    ran = store.add("ada", "work", task("wait"), "k1", JobState.WAITING)
    waited = store.add("ada", "work", task("answer"), "k2", JobState.WAITING)
    others = JobStore(database, "another process")
    theirs = others.add("ada", "work", task("wait"), "k1", JobState.WAITING)
    assert store.begin(ran.id)
    assert others.begin(theirs.id)
    await runner.resume()
    interrupted = await runner.status("ada", ran.id)
    assert interrupted.state is JobState.INTERRUPTED
    assert interrupted.problem is not None
    assert interrupted.problem.remedy == "Run it again."
    assert (await ended(runner, waited.id)).state is JobState.DONE
    assert (await runner.status("ada", theirs.id)).state is JobState.RUNNING


async def test_a_service_that_stops_puts_its_jobs_back_in_line(
    database: Database, compute: Compute, runner: JobRunner, tmp_path: Path
) -> None:
    mark = tmp_path / "mark"
    job = (await runner.submit("ada", "work", task("wait", mark))).id
    await running(runner, job)
    await runner.close()
    assert (await runner.status("ada", job)).state is JobState.WAITING
    mark.touch()
    runner = runner_of(database, compute)
    await runner.resume()
    assert (await ended(runner, job)).state is JobState.DONE


async def test_a_result_outlives_a_database_outage(
    runner: JobRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runner_module, "STORE_RETRY_S", (0.01, 0.01, 0.01))
    real, failures = runner.store.finish, []

    def away(*args: Any) -> bool:
        if len(failures) < 3:
            failures.append(1)
            raise StoreError("away")
        return real(*args)

    monkeypatch.setattr(runner.store, "finish", away)
    job = await runner.submit("ada", "work", task("answer"))
    assert (await ended(runner, job.id)).state is JobState.DONE
    assert len(failures) == 3


@pytest.mark.slow
def test_the_real_service_killed_in_mid_job(tmp_path: Path) -> None:
    service = Service(tmp_path)
    with service.running() as client:
        job = client.post(JOBS, json={"kind": "stretch", "request": LONG}).json()["id"]
        wait_until(lambda: client.get(f"{JOBS}/{job}").json()["state"] != "waiting")
    with service.running() as client:
        assert client.get(f"{JOBS}/{job}").json()["state"] == "interrupted"
        assert client.get(f"{JOBS}/{job}/result").status_code == 409
        again = client.post(f"{JOBS}/{job}/again").json()
        assert again["state"] == "waiting"
        assert client.delete(f"{JOBS}/{again['id']}").json()["state"] == "cancelled"


def test_settings_reach_the_jobs(tmp_path: Path) -> None:
    with served(data_dir=tmp_path, background_timeout_s=7, process_name="two") as client:
        runner = state_of(client).jobs
        assert (runner.timeout_s, runner.store.process) == (7, "two")
