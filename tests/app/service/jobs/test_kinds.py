"""Every kind of job answers, and a worker killed in the middle of one costs that job only."""

import asyncio
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from app.service.compute import answers as answers_module
from app.service.compute.compute import Compute
from app.service.jobs.document import JobState
from app.service.jobs.kinds import KINDS
from app.service.jobs.runner import JobRunner
from app.service.store.database import Database
from tests.app.jobs import killed_in_the_middle
from tests.app.service.jobs.helpers import ended, runner_of

SLOW = frozenset({"relax", "sweep", "whole", "characterise"})
"""Their own tests wait for what they answer."""
SMALLER: dict[str, dict[str, Any]] = {
    "stretch": {"steps": 2},
    "piece": {"steps": 1},
    "bias": {"mesh_mm": 20, "steps": 1},
    "biaxial": {"mesh_mm": 50, "steps": 1},
    "trellis": {"mesh_mm": 50, "steps": 1},
}
"""Changes of their examples, so that there is less to compute."""


def request_of(kind: str) -> str:
    """The example of a kind."""
    operation = KINDS[kind]
    example = {**(operation.example or {}), **SMALLER.get(kind, {})}
    return operation.request.model_validate(example).model_dump_json()


@pytest.fixture
def runner(sqlite_database: Database, tmp_path: Path, compute: Compute) -> JobRunner:
    """On one database: the kinds differ in what they compute, not in how they are kept."""
    return runner_of(sqlite_database, compute, folder=tmp_path)


def test_every_kind_has_an_example() -> None:
    without = [kind for kind, operation in KINDS.items() if not operation.example]
    assert without == ["work"]  # which tests add


@pytest.mark.slow
async def test_a_killed_worker_loses_only_its_own_job(
    runner: JobRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(answers_module, "perform", partial(killed_in_the_middle, "bend"))
        job = await runner.submit("ada", "bend", request_of("bend"))
        other = await runner.submit("ada", "curve", request_of("curve"))
        failed = await ended(runner, job.id)
    assert failed.state is JobState.FAILED
    assert failed.problem is not None
    assert "died" in failed.problem.detail
    assert (await ended(runner, other.id)).state is JobState.DONE
    again = await runner.again("ada", job.id)
    assert (await ended(runner, again.id)).state is JobState.DONE


@pytest.mark.slow
@pytest.mark.parametrize("kind", sorted(KINDS.keys() - SLOW))
async def test_every_kind_has_its_answer(runner: JobRunner, kind: str) -> None:
    job = await runner.submit("ada", kind, request_of(kind))
    assert (await ended(runner, job.id)).state is JobState.DONE
    answer = await asyncio.to_thread(runner.store.result, "ada", job.id)
    assert answer is not None
    KINDS[kind].result.model_validate_json(b"".join(answer.unpacked()))
