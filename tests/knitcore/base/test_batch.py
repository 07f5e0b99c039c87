"""Batches: the same results here and on a cluster, and nothing done twice."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from knitcore import CancelledError, InputError
from knitcore.base.batch import BatchProgress, run_batch
from tests.knitcore.refusals import refuses

if TYPE_CHECKING:
    from distributed import LocalCluster

TASKS = {f"number-{n}": n for n in range(6)}


def square(number: int) -> dict[str, int]:
    return {"square": number * number, "process": os.getpid()}


def refuse_three(number: int) -> dict[str, float]:
    if number == 3:
        raise InputError("number", "it is 3.", "Give another.")
    return {"value": float("nan") if number == 4 else 1.0}


def die_once(marker: str) -> dict[str, bool]:
    """The first process that comes here is killed; the next one finds the mark it left."""
    if marker and not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"alive": True}


def always_die(_: int) -> dict[str, bool]:
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


@pytest.mark.parametrize("workers", [1, 2])
def test_every_task_has_its_result_in_order(workers: int) -> None:
    seen: list[BatchProgress] = []
    batch = run_batch(square, TASKS, workers=workers, progress=seen.append)
    assert list(batch.results) == list(TASKS)
    assert [document["square"] for document in batch.results.values()] == [0, 1, 4, 9, 16, 25]
    assert (os.getpid() in {d["process"] for d in batch.results.values()}) == (workers == 1)
    assert [p.done for p in seen] == [0, 1, 2, 3, 4, 5, 6]


def test_a_failure_costs_one_task_and_gives_its_reason() -> None:
    batch = run_batch(refuse_three, TASKS, workers=1)
    assert set(batch.failures) == {"number-3", "number-4"}
    assert "Give another" in batch.failures["number-3"]
    assert len(batch.results) == 4


def test_a_stopped_batch_resumes(tmp_path: Path) -> None:
    done = 0

    def count(progress: BatchProgress) -> None:
        nonlocal done
        done = progress.done

    with pytest.raises(CancelledError, match="3 of 6"):
        run_batch(
            square, TASKS, workers=1, keep=tmp_path, progress=count, cancelled=lambda: done == 3
        )
    assert len(list(tmp_path.iterdir())) == 3
    (tmp_path / "number-0.json").write_text(json.dumps({"square": "kept"}))
    (tmp_path / "number-1.json").write_text('{"square"')  # as a full disk would leave it
    batch = run_batch(square, TASKS, workers=1, keep=tmp_path)
    assert [d["square"] for d in batch.results.values()] == ["kept", 1, 4, 9, 16, 25]
    assert not list(tmp_path.glob("*.part"))


def test_a_process_that_dies_costs_a_second_try(tmp_path: Path) -> None:
    tasks = {"a": "", "b": str(tmp_path / "mark"), "c": ""}
    assert set(run_batch(die_once, tasks, workers=2).results) == {"a", "b", "c"}


def test_a_task_that_kills_every_process_is_given_up() -> None:
    batch = run_batch(always_die, {"a": 1, "b": 2}, workers=2)
    assert set(batch.failures) == {"a", "b"}
    assert "lost 3 times" in batch.failures["a"]


@pytest.mark.parametrize(
    ("changed", "field"),
    [
        ({"tasks": {"../a": 1}}, "tasks"),
        ({"workers": 0}, "workers"),
        ({"scheduler": "somewhere"}, "scheduler"),
        ({"scheduler": "tcp://127.0.0.1:9"}, "scheduler"),
    ],
)
def test_impossible_batches_are_refused_before_any_work(
    changed: dict[str, object], field: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("knitcore.base.batch.CONNECT_S", 1)
    arguments: dict[str, object] = {"tasks": TASKS} | changed
    with refuses(field):
        run_batch(square, **arguments)  # type: ignore[arg-type]


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator["LocalCluster"]:
    """Two workers, each a process of its own."""
    from distributed import LocalCluster  # takes a second

    with LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        dashboard_address="127.0.0.1:0",
        local_directory=str(tmp_path),
    ) as cluster:
        yield cluster


def slow_square(number: int) -> dict[str, int]:
    time.sleep(0.5)
    return square(number)


@pytest.mark.slow
def test_a_cluster_gives_the_same_though_a_worker_is_killed(cluster: "LocalCluster") -> None:
    def kill_one(progress: BatchProgress) -> None:
        if progress.done == 1:
            os.kill(cluster.workers[0].pid, signal.SIGKILL)

    address = cluster.scheduler_address
    batch = run_batch(slow_square, TASKS, scheduler=address, progress=kill_one)
    assert [document["square"] for document in batch.results.values()] == [0, 1, 4, 9, 16, 25]
    assert not batch.failures


def outlive(folder: str) -> dict[str, int]:
    (Path(folder) / str(os.getpid())).touch()
    time.sleep(120)
    return {}


def test_workers_of_a_killed_batch_end(tmp_path: Path) -> None:
    program = (
        "from knitcore.base.batch import run_batch\n"
        "from tests.knitcore.base.test_batch import outlive\n"
        f"tasks = dict.fromkeys('ab', {str(tmp_path)!r})\n"
        "if __name__ == '__main__': run_batch(outlive, tasks, workers=2)"
    )
    main = tmp_path / "main.py"
    main.write_text(program)
    root = Path(__file__).parents[3]
    batch = subprocess.Popen(
        [sys.executable, str(main)], env=os.environ | {"PYTHONPATH": str(root)}
    )
    while len(workers := [int(f.name) for f in tmp_path.iterdir() if f.name.isdigit()]) < 2:
        assert batch.poll() is None
        time.sleep(0.05)
    batch.kill()
    batch.wait()
    while any(Path(f"/proc/{worker}").exists() for worker in workers):
        time.sleep(0.05)  # pytest's own limit of time ends a test that waits for ever
