"""Jobs in a database, where several processes know, cancel and survive each other's."""

import gzip
import os
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from sqlalchemy import select, update

from app.service.compute.compute import Compute
from app.service.jobs import runner as runner_module
from app.service.jobs import store as store_module
from app.service.jobs.document import JobState
from app.service.jobs.store import JobStore
from app.service.limits.user_limits import OverLimitError, UserLimits
from app.service.problems import StoreError
from app.service.store.database import Database
from app.service.store.tables import jobs, results
from tests.app.service.jobs.helpers import counted, ended, runner_of, status_when, task, until


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner_module, "BEAT_S", 0.05)


async def test_another_process_sees_the_progress_and_cancels(
    database: Database, compute: Compute
) -> None:
    here, there = (runner_of(database, compute, name) for name in ("here", "there"))
    await here.resume()
    await there.resume()
    job = (await here.submit("ada", "work", task("wait"))).id
    await status_when(there, job, lambda status: status.progress == 0.25)
    assert (await there.cancel("ada", job)).state is JobState.CANCELLED
    await counted(here, "running", 0)
    assert (await here.status("ada", job)).state is JobState.CANCELLED
    await here.close()
    await there.close()


async def test_jobs_of_a_process_that_is_gone_are_taken_over(
    database: Database, compute: Compute
) -> None:
    gone, alive = JobStore(database, "gone"), JobStore(database, "alive")
    ran = gone.add("ada", "work", task("wait"), "k1", JobState.WAITING)
    assert gone.begin(ran.id)
    waited = gone.add("ada", "work", task("answer"), "k2", JobState.WAITING)
    database.write(lambda c: c.execute(update(jobs).values(seen_at=jobs.c.seen_at - 70)))
    theirs = alive.add("ada", "work", task("wait"), "k1", JobState.WAITING)
    assert alive.begin(theirs.id)
    runner = runner_of(database, compute, "here")
    await runner.resume()
    assert (await ended(runner, waited.id)).state is JobState.DONE
    assert (await runner.status("ada", ran.id)).state is JobState.INTERRUPTED
    assert (await runner.status("ada", theirs.id)).state is JobState.RUNNING
    assert gone.beat({ran.id: 0.5, waited.id: 0.5}) == {ran.id, waited.id}
    assert alive.beat({theirs.id: 0.5}) == set()
    await runner.close()


async def test_a_process_is_not_declared_dead_right_after_an_outage(
    database: Database, compute: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    runner = runner_of(database, compute, "here")
    calls: list[str] = []
    real = runner.store.beat

    def beat(shares: dict[str, float]) -> set[str]:
        calls.append("beat")
        if len(calls) == runner_module.BEATS_TO_LOOK_ROUND:
            raise StoreError("away")
        return real(shares)

    def look_round() -> list[tuple[str, str]]:
        calls.append("look round")
        return []

    monkeypatch.setattr(runner.store, "beat", beat)
    monkeypatch.setattr(runner.store, "adopt_orphans", look_round)
    await runner.resume()
    await until(lambda: "look round" in calls)
    await runner.close()
    assert calls.index("look round") == 2 * runner_module.BEATS_TO_LOOK_ROUND


def test_equal_jobs_of_two_processes_may_end_at_the_same_time(database: Database) -> None:
    stores = [JobStore(database, name) for name in ("here", "there")]
    with ThreadPoolExecutor(2) as threads:
        for key in map(str, range(8)):
            jobs = [
                store.add("ada", "work", task("answer"), key, JobState.WAITING).id
                for store in stores
            ]
            meet = threading.Barrier(2)

            def finish(store: JobStore, job: str, key: str, meet: threading.Barrier) -> bool:
                meet.wait()
                return store.finish(job, "work", key, b"the result")

            ended = threads.map(finish, stores, jobs, [key] * 2, [meet] * 2)
            assert list(ended) == [True, True]
            for job in jobs:
                assert stores[0].get("ada", job).state is JobState.DONE
                result = stores[0].result("ada", job)
                assert result is not None
                assert b"".join(result.packed()) == b"the result"


def test_a_result_is_read_in_parts(database: Database) -> None:
    store = JobStore(database, "main")
    content = os.urandom(300_000).hex().encode() + bytes(3_000_000)
    body = gzip.compress(content)
    job = store.add("ada", "work", "{}", "k", JobState.WAITING).id
    store.finish(job, "work", "k", body)
    result = store.result("ada", job)
    assert result is not None
    assert (result.size_bytes, result.unpacked_bytes) == (len(body), len(content))
    for parts, whole in ((result.packed(), body), (result.unpacked(), content)):
        listed = list(parts)
        assert b"".join(listed) == whole
        assert max(map(len, listed)) <= store_module.PART_BYTES
    parts = result.packed()
    next(parts)
    store.tidy(most_bytes=0)
    assert list(parts) == []  # the answer ends early; its length says so


def test_the_longest_unused_results_make_room(database: Database) -> None:
    store = JobStore(database, "main")
    for number in range(3):
        status = store.add("ada", "work", "{}", f"k{number}", JobState.WAITING)
        assert store.finish(status.id, "work", f"k{number}", os.urandom(1000))
        time.sleep(0.002)
    ago = update(results).values(used_at=results.c.used_at - 2 * store_module.NOTED_EACH_S)
    database.write(lambda c: c.execute(ago))
    used_at = select(results.c.used_at).where(results.c.key == "k0")
    noted = []
    for _ in range(2):
        assert store.knows("k0")
        with database.read() as connection:
            noted.append(connection.execute(used_at).scalar())
    assert noted[0] == noted[1]  # not at every use
    store.tidy(most_bytes=2100)
    assert [store.knows(f"k{n}") for n in range(3)] == [True, False, True]


def test_requests_of_jobs_have_a_size_together(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = JobStore(database, "here")
    monkeypatch.setattr(store_module, "USER_LIMITS", UserLimits(job_bytes=100))

    def add(owner: str) -> str:
        return store.add(owner, "relax", "x" * 40, "key", JobState.WAITING).id

    first, second = add("ada"), add("ada")
    with pytest.raises(OverLimitError) as refused:
        add("ada")
    assert refused.value.field == "job_bytes"
    assert add("bob")
    store.end(first, JobState.CANCELLED)
    third = add("ada")  # in place of the one that has ended
    assert store.kept_bytes("ada") == 80
    assert {job.id for job in store.page("ada", limit=9, cursor=None).jobs} == {second, third}
