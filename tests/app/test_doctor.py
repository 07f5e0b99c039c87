"""Broken set-ups: each is told in words, by the doctor and at the start."""

from __future__ import annotations

import asyncio
import json
import os
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app import doctor
from app.cli.main import main
from app.compute import cluster as cluster_module
from app.compute import compute as compute_module
from app.compute.cluster import Cluster, ClusterError
from app.compute.compute import Compute
from app.compute.places import NotBegunError
from app.main import create_app
from app.settings import Settings
from app.store.database import DamagedError, Database
from app.store.lock import held
from app.store.schema import migrate, revision
from knitcore.errors import InputError


def _database(folder: Path) -> Path:
    """A database of some pages, as a service leaves it."""
    file = folder / "knitcore.sqlite3"
    database = Database(f"sqlite:///{file}")
    migrate(database)
    with held(database, "main"):
        pass
    database.close()
    with sqlite3.connect(file) as connection:
        connection.execute("PRAGMA journal_mode=DELETE")
        connection.executemany(
            "INSERT INTO designs (id, owner, name, material, chart, rows, columns, revision,"
            " created_at, changed_at) VALUES (?, 'local', 'a', 'acrylic', ?, 1, 1, 1, 0, 0)",
            [(f"design-{n}", "K" * 3_000) for n in range(60)],
        )
    connection.close()
    return file


def _damage(file: Path) -> None:
    content = bytearray(file.read_bytes())
    middle = len(content) // 2
    content[middle : middle + 60_000] = b"\xa5" * 60_000
    file.write_bytes(content)


def _lose(file: Path) -> None:
    file.unlink()


def _open_to_all(file: Path) -> None:
    file.chmod(0o644)
    file.parent.chmod(0o755)


def _make_newer(file: Path) -> None:
    with sqlite3.connect(file) as connection:
        connection.execute("UPDATE alembic_version SET version_num='9999'")
    connection.close()


def _told(folder: Path, **environment: str) -> tuple[int, dict[str, dict[str, str]]]:
    given = {"KNITCORE_DATA_DIR": str(folder)} | environment
    result = CliRunner().invoke(main, ["doctor", "--json"], env=given)
    checks = json.loads(result.stdout)["checks"]
    assert all(set(check) == {"name", "ok", "problem", "remedy"} for check in checks)
    return result.exit_code, {check["name"]: check for check in checks if not check["ok"]}


def test_a_sound_set_up_passes(tmp_path: Path) -> None:
    assert _told(tmp_path / "new") == (0, {})
    assert not (tmp_path / "new").exists()
    _database(tmp_path)
    assert _told(tmp_path) == (0, {})
    text = CliRunner().invoke(main, ["doctor"], env={"KNITCORE_DATA_DIR": str(tmp_path)})
    assert "ok    database" in text.output


@pytest.mark.parametrize(
    ("break_it", "name", "words"),
    [
        (_damage, "database", "damaged"),
        (_lose, "database", "is gone"),
        (_make_newer, "database", "9999"),
        (_open_to_all, "file modes", "other users"),
    ],
)
def test_a_broken_database_is_found(
    tmp_path: Path, break_it: Callable[[Path], None], name: str, words: str
) -> None:
    file = _database(tmp_path)
    break_it(file)
    code, failed = _told(tmp_path)
    assert (code, list(failed)) == (1, [name])
    assert words in failed[name]["problem"]
    assert failed[name]["remedy"]
    assert file.exists() == (break_it is not _lose)


@pytest.mark.parametrize(
    ("environment", "name", "words"),
    [
        ({"KNITCORE_REQUIRE_LOGGIN": "true"}, "settings", "KNITCORE_REQUIRE_LOGIN"),
        ({"KNITCORE_PRT": "2"}, "settings", "KNITCORE_PORT"),
        ({"KNITCORE_PORT": "many"}, "settings", "port"),
        ({"KNITCORE_HOST": "0.0.0.0"}, "settings", "KNITCORE_TOKEN"),
        ({"KNITCORE_SCHEDULER": "tcp://127.0.0.1:9"}, "cluster", "cannot be reached"),
        ({"KNITCORE_DATA_DIR": "/dev/null/nowhere"}, "data folder", "cannot be written"),
    ],
)
def test_broken_settings_are_found(
    tmp_path: Path,
    environment: dict[str, str],
    name: str,
    words: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(cluster_module, "CONNECT_S", 0.2)
    code, failed = _told(tmp_path, **environment)
    assert code == 1
    assert words in f"{failed[name]['problem']} {failed[name]['remedy']}"


def test_little_room_and_few_handles_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doctor, "LEAST_FREE_BYTES", 1 << 62)
    monkeypatch.setattr(doctor, "LEAST_HANDLES", 1 << 62)
    monkeypatch.setattr(doctor.resource, "getrlimit", lambda _: (64, 64))
    code, failed = _told(tmp_path)
    assert (code, set(failed)) == (1, {"free space", "file handles"})


@pytest.mark.parametrize("break_it", [_damage, _lose, _make_newer])
def test_a_start_that_fails_is_one_line(tmp_path: Path, break_it: Callable[[Path], None]) -> None:
    break_it(_database(tmp_path))
    done = _start(tmp_path)
    assert done.returncode in (1, 2)
    assert done.stdout == ""  # no address of a service that is not there
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("Error: ")
    assert "Traceback" not in done.stderr


def _start(folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "app.cli.main", "serve", "--port", "0"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env=os.environ | {"KNITCORE_DATA_DIR": str(folder)},
    )


def test_a_second_service_on_the_same_data_is_refused(tmp_path: Path) -> None:
    file = _database(tmp_path)
    database = Database(f"sqlite:///{file}")
    with held(database, "main", "http://127.0.0.1:8737/"):
        done = _start(tmp_path)
        assert done.returncode == 2
        assert "another service (process" in done.stderr
        assert "Open http://127.0.0.1:8737/ in a browser" in done.stderr
        assert "KNITCORE_DATA_DIR" in done.stderr
        with pytest.raises(InputError, match="another service"), held(database, "other"):
            pass
    with held(database, "main"):  # free again
        pass
    database.close()


@pytest.mark.postgres
def test_two_services_of_one_name_are_refused_on_postgresql(postgres_url: str) -> None:
    database = Database(postgres_url)
    second = pytest.raises(InputError, match="KNITCORE_PROCESS_NAME")
    with held(database, "main"), held(database, "other"), second, held(database, "main"):
        pass
    database.close()


def test_damage_found_at_run_time_is_reported(tmp_path: Path) -> None:
    app = create_app(Settings(workers=1, data_dir=tmp_path))
    with TestClient(app, base_url="http://127.0.0.1", raise_server_exceptions=False) as client:
        assert client.get("/readyz").status_code == 200
        database = app.state.database
        assert client.get("/api/v1/designs").status_code == 200
        database.engine.dispose()  # writes the log into the file
        file = tmp_path / "knitcore.sqlite3"
        with file.open("r+b") as stream:
            stream.seek(4096)
            stream.write(b"\xa5" * (file.stat().st_size - 4096))
        answer = client.get("/api/v1/designs")
        assert answer.status_code == 503
        assert "damaged" in answer.json()["detail"]
        assert "backup" in answer.json()["remedy"]
        assert client.get("/readyz").status_code == 503


def test_a_copy_is_kept_before_a_migration(tmp_path: Path) -> None:
    file = tmp_path / "knitcore.sqlite3"
    database = Database(f"sqlite:///{file}")
    migrate(database, "0003")
    migrate(database)
    head = revision(database)
    database.close()
    (copy,) = tmp_path.glob("*.before-*")
    assert copy.name.endswith(f".before-{head}")
    assert copy.stat().st_mode & 0o077 == 0
    old = Database(f"sqlite:///{copy}")
    assert revision(old) == "0003"
    old.check_pages()
    old.close()


def test_damage_is_found_page_by_page(tmp_path: Path) -> None:
    file = _database(tmp_path)
    _damage(file)
    database = Database(f"sqlite:///{file}")
    with pytest.raises(DamagedError):
        database.check_pages()
    database.close()


class _Nobody:
    """A place that takes jobs and never begins."""

    share = None
    cpu_s = None

    async def submit(self, job: object) -> asyncio.Future[int]:
        self.future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        return self.future

    def cancel(self) -> None:
        self.future.cancel()

    def replace(self) -> None:
        self.future.cancel()

    def close(self) -> None:
        pass


def test_waiting_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """For a worker that never begins, and for a place that is never free."""
    monkeypatch.setattr(compute_module, "START_S", 0.3)
    monkeypatch.setattr(compute_module, "POLL_S", 0.02)

    async def never() -> bool:
        return False

    async def scenario() -> list[BaseException | int]:
        compute = Compute([_Nobody()], timeout_s=0.1)  # type: ignore[list-item]
        asked = [compute.run(never, print, owner=owner) for owner in ("ada", "bob")]
        return await asyncio.gather(*asked, return_exceptions=True)  # type: ignore[arg-type]

    first, second = asyncio.run(scenario())
    assert isinstance(first, NotBegunError)
    assert "No worker began" in str(first)
    assert isinstance(second, NotBegunError)
    assert "No worker was free" in str(second)


def test_a_cluster_without_workers_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster_module, "WORKERS_S", 0.2)
    file = tmp_path / "scheduler.json"
    words = ["scheduler", "--host=127.0.0.1", "--port=0", "--no-dashboard"]
    words += ["--dashboard-address=127.0.0.1:0", f"--scheduler-file={file}"]
    with (tmp_path / "log").open("w") as log:
        scheduler = subprocess.Popen([sys.executable, "-m", "dask", *words], stderr=log)
    try:
        while not file.exists() or not file.read_text():
            assert scheduler.poll() is None, (tmp_path / "log").read_text()
        address = json.loads(file.read_text())["address"]
        cluster = Cluster(address)
        with pytest.raises(ClusterError, match="takes computations"):
            cluster.begin("a-job", print)
        cluster.close()
        settings = Settings(data_dir=tmp_path / "data", scheduler=address)
        failed = doctor.examine(settings).failed
        assert [check.name for check in failed] == ["cluster"]
        with TestClient(create_app(settings), base_url="http://127.0.0.1") as client:
            assert client.get("/readyz").status_code == 503
            wish = {"chart": "KP", "material": "acrylic"}
            refused = client.post("/api/v1/relax", json=wish)
            assert refused.status_code == 503
            assert "takes computations" in refused.json()["detail"]
    finally:
        scheduler.terminate()
        scheduler.wait(20)
