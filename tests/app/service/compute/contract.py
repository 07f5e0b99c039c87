"""The contract of every kind of worker; tests of each kind derive from it."""

from pathlib import Path

import pytest

from app.service.compute import compute as compute_module
from app.service.compute.compute import Compute
from app.service.compute.workers import AbandonedError, TimeLimitError
from knitcore import InputError
from tests.app import jobs
from tests.app.jobs import never


class WorkerContract:
    """The fixture ``compute`` has workers of the kind."""

    async def test_results_errors_and_progress_come_back(
        self, compute: Compute, tmp_path: Path
    ) -> None:
        assert await compute.run(never, jobs.add, 2, 3) == 5
        with pytest.raises(InputError, match="Use less"):
            await compute.run(never, jobs.refuse)
        shares: list[float] = []

        async def note(share: float) -> None:
            shares.append(share)
            (tmp_path / str(round(share * 4))).touch()

        assert await compute.run(never, jobs.climb, str(tmp_path), 4, on_share=note) == 4
        assert shares == [0.0, 0.25, 0.5, 0.75, 1.0]

    async def test_an_abandoned_job_and_one_beyond_its_time_are_stopped(
        self, compute: Compute, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(compute_module, "GRACE_S", 120.0)
        mark = tmp_path / "mark"
        begun: list[float] = []

        async def note(share: float) -> None:
            begun.append(share)

        async def once_begun() -> bool:
            return bool(begun)

        with pytest.raises(AbandonedError):
            await compute.run(once_begun, jobs.until_cancelled, str(mark), on_share=note)
        assert mark.read_text() == "stopped"
        mark.unlink()
        with pytest.raises(TimeLimitError, match=r"longer than 0\.2 s"):
            await compute.run(never, jobs.until_cancelled, str(mark), timeout_s=0.2)
        assert mark.read_text() == "stopped"
        assert await compute.run(never, jobs.add, 1, 1) == 2

    async def test_a_reader_without_end_is_ended(self, compute: Compute) -> None:
        with pytest.raises(InputError, match="to read"):
            await compute.run(never, jobs.read_endlessly)
        assert await compute.run(never, jobs.add, 1, 2) == 3

    async def test_a_job_that_does_not_stop_loses_only_its_process(
        self, compute: Compute, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(compute_module, "GRACE_S", 0.2)
        with pytest.raises(TimeLimitError):
            await compute.run(never, jobs.stubborn, 600.0, timeout_s=0.2)
        for _ in compute.workers:
            assert await compute.run(never, jobs.add, 4, 4) == 8
