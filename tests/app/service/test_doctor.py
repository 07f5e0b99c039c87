"""Broken set-ups: each is told in words, by the doctor and at the start."""

import contextlib
import json
import os
import shutil
import sqlite3
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

import pytest
from click.testing import CliRunner, Result

from app.cli import serve as serve_module
from app.cli.main import main
from app.service import doctor
from app.service.compute import cluster as cluster_module
from app.service.compute.cluster import Cluster, ClusterError
from app.service.settings import Settings
from app.service.store import schema
from app.service.store.database import Database
from app.service.store.schema import migrate, revision
from app.service.web import observing
from knitcore.base.errors import InputError
from tests.app.clients import served, state_of
from tests.app.clusters import scheduler
from tests.app.databases import opened, sqlite


def _database(folder: Path) -> Path:
    """A database of some pages, as a service leaves it."""
    file = folder / "knitcore.sqlite3"
    with opened(folder) as database, database.reserved("main"):
        pass
    with sqlite(file) as connection:
        connection.execute("PRAGMA journal_mode=DELETE")
        connection.executemany(
            "INSERT INTO designs (id, owner, name, material, chart, rows, columns, revision,"
            " created_at, changed_at) VALUES (?, 'local', 'a', 'acrylic', ?, 1, 1, 1, 0, 0)",
            [(f"design-{n}", "K" * 3_000) for n in range(60)],
        )
    return file


def _damage(file: Path) -> None:
    content = file.read_bytes()
    middle = len(content) // 2
    file.write_bytes(content[:middle] + b"\xa5" * 60_000 + content[middle + 60_000 :])


def _empty(file: Path) -> None:
    for place in file.parent.iterdir():
        place.unlink()
    file.touch()


def _open_to_all(file: Path) -> None:
    file.chmod(0o644)
    file.parent.chmod(0o755)


def _executing(statement: str) -> Callable[[Path], None]:
    """A spoiler that executes SQL."""

    def spoil(file: Path) -> None:
        with sqlite(file) as connection:
            connection.execute(statement)

    return spoil


def _failing(folder: Path) -> tuple[int, dict[str, dict[str, str]]]:
    """Exit code of the doctor, and the checks that fail."""
    result = _doctor(folder, "--json")
    checks = json.loads(result.stdout)["checks"]
    assert all(set(check) == {"name", "ok", "problem", "remedy", "note"} for check in checks)
    return result.exit_code, {check["name"]: check for check in checks if not check["ok"]}


def test_a_sound_set_up_passes(tmp_path: Path) -> None:
    assert _failing(tmp_path / "new") == (0, {})
    assert not (tmp_path / "new").exists()
    _database(tmp_path)
    assert _failing(tmp_path) == (0, {})
    assert "ok    database" in _doctor(tmp_path).output


def _doctor(folder: Path, *options: str) -> Result:
    environment = {"KNITCORE_DATA_DIR": str(folder)}
    return CliRunner().invoke(main, ["doctor", *options], env=environment)


@dataclass(frozen=True)
class Broken:
    """A set-up with one fault.

    Attributes
    ----------
    check : that fails.
    words : in what is said about it.
    environment : settings, beside a sound database in a folder of its own.
    spoil : makes the fault in the database's file.
    limits : limits of :mod:`app.service.doctor` that are out of reach.
    starts : whether the service starts and only warns.
    ready : whether it is ready nevertheless.
    """

    check: str
    words: str
    environment: Mapping[str, str] = field(default_factory=dict)
    spoil: Callable[[Path], None] | None = None
    limits: tuple[str, ...] = ()
    starts: bool = False
    ready: bool = False


def _setting(name: str, value: str, words: str) -> Broken:
    return Broken("settings", words, {f"KNITCORE_{name}": value})


BROKEN = {
    "a misspelt setting": _setting("PRT", "2", "KNITCORE_PORT"),
    "a misspelt login": _setting("REQUIRE_LOGGIN", "true", "KNITCORE_REQUIRE_LOGIN"),
    "a port that is no number": _setting("PORT", "many", "port"),
    "a list that is not JSON": _setting("ALLOWED_HOSTS", "knit.example.org", "JSON"),
    "a database that has no URL": _setting(
        "DATABASE_URL", "postgresql+psycopg://u:p@ss:word@host:port/x", "%40"
    ),
    "a home of nobody": _setting("DATA_DIR", "~nobody-at-all/x", "not known here"),
    "a network without a login": _setting("HOST", "0.0.0.0", "KNITCORE_TOKEN"),
    "a folder that cannot be": Broken(
        "data folder", "cannot be written", {"KNITCORE_DATA_DIR": "/dev/null/nowhere"}
    ),
    "a damaged database": Broken("database", "damaged", spoil=_damage),
    "a lost database": Broken("database", "is gone", spoil=Path.unlink),
    "a file of nothing": Broken("database", "is empty.", spoil=_empty),
    "an emptied database": Broken("database", "is empty", spoil=lambda file: os.truncate(file, 0)),
    "a database without a table": Broken(
        "database", "lacks sessions", spoil=_executing("DROP TABLE sessions")
    ),
    "a newer database": Broken(
        "database",
        "9999, which this program does not know",
        spoil=_executing("UPDATE alembic_version SET version_num='9999'"),
    ),
    "files open to all": Broken(
        "file modes", "other users", spoil=_open_to_all, starts=True, ready=True
    ),
    "little room": Broken("free space", "MB left", limits=("MIN_FREE_BYTES",), starts=True),
    "no cluster": Broken(
        "cluster", "reached", {"KNITCORE_SCHEDULER": "tcp://127.0.0.1:9"}, starts=True
    ),
}


@pytest.fixture(params=BROKEN)
def broken(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Broken:
    """Each of them, in the environment."""
    set_up = BROKEN[request.param]
    file = _database(tmp_path)
    if set_up.spoil is not None:
        set_up.spoil(file)
    for name in set_up.limits:
        monkeypatch.setattr(doctor, name, 1 << 62)
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda _: SimpleNamespace(free=1 << 40))
    monkeypatch.setattr(cluster_module, "CONNECT_S", 0.2)
    for name, value in ({"KNITCORE_DATA_DIR": str(tmp_path)} | dict(set_up.environment)).items():
        monkeypatch.setenv(name, value)
    return set_up


def _serve(monkeypatch: pytest.MonkeyPatch) -> Result:
    """Start the service as far as it serves."""
    monkeypatch.setattr(serve_module, "serve_on", lambda *_: None)
    monkeypatch.setattr(serve_module.os, "umask", lambda _: 0)
    monkeypatch.setattr(observing, "configure_logging", lambda _: None)
    port = [] if "KNITCORE_PORT" in os.environ else ["--port", "0"]
    return CliRunner().invoke(main, ["serve", *port])


def test_doctor_start_and_readiness_say_the_same_in_one_line(
    broken: Broken,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    code, failed = _failing(Path(os.environ["KNITCORE_DATA_DIR"]))
    assert (code, list(failed)) == (1, [broken.check])
    problem, remedy = failed[broken.check]["problem"], failed[broken.check]["remedy"]
    assert broken.words in f"{problem} {remedy}"
    assert remedy
    assert "\n" not in problem + remedy

    started = _serve(monkeypatch)
    if broken.starts:
        assert (started.exit_code, "http://" in started.stdout) == (0, True)
        assert caplog.messages[-1] == f"{broken.check}: {problem} {remedy}"
    else:
        assert (started.exit_code != 0, started.stdout) == (True, "")
        (line,) = started.stderr.strip().splitlines()
        assert line.startswith("Error: ")
        assert problem.removesuffix(".") in line
        if broken.spoil is Path.unlink:  # nothing is put in its place
            assert not (tmp_path / "knitcore.sqlite3").exists()
        return
    with served() as client:
        answer = client.get("/readyz")
        assert client.get("/healthz").status_code == 200
    if broken.ready:
        assert (answer.status_code, answer.json()["checks"][broken.check]) == (200, False)
    else:
        shown = answer.json()
        assert (answer.status_code, shown["title"]) == (503, "Not ready")
        assert (shown["detail"], shown["remedy"]) == (problem, remedy)


def test_a_second_service_on_the_same_data_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with opened(tmp_path) as database:
        with database.reserved("main", "http://127.0.0.1:8737/"):
            monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path))
            done = _serve(monkeypatch)
            assert done.exit_code == 2
            assert "another service (process" in done.stderr
            assert "Open http://127.0.0.1:8737/ in a browser" in done.stderr
            assert "KNITCORE_DATA_DIR" in done.stderr
            with pytest.raises(InputError, match="another service"), database.reserved("other"):
                pass
        with database.reserved("main"):  # free again
            pass


def test_doctor_names_the_service_that_runs(tmp_path: Path) -> None:
    with opened(tmp_path) as database:
        with database.reserved("main", "http://127.0.0.1:8737/"):
            result = _doctor(tmp_path)
            named = f"Process {os.getpid()} runs on it, at http://127.0.0.1:8737/."
            assert (result.exit_code, named in result.output) == (0, True)
        assert "runs on it" not in _doctor(tmp_path).output


@pytest.mark.postgres
def test_two_services_of_one_name_are_refused_on_postgresql(postgres_database: Database) -> None:
    reserved = postgres_database.reserved
    second = pytest.raises(InputError, match="KNITCORE_PROCESS_NAME")
    with reserved("main"), reserved("other"), second, reserved("main"):
        pass


def test_damage_found_at_run_time_is_reported(tmp_path: Path) -> None:
    with served(data_dir=tmp_path) as client:
        assert client.get("/readyz").status_code == 200
        database = state_of(client).database
        assert client.get("/api/v1/designs").status_code == 200
        file = tmp_path / "knitcore.sqlite3"
        with contextlib.closing(sqlite3.connect(file, timeout=30)) as own:  # log into the file
            assert own.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0] == 0
        database.engine.dispose()  # and nothing in memory
        with file.open("r+b") as stream:
            stream.seek(4096)
            stream.write(b"\xa5" * (file.stat().st_size - 4096))
        answer = client.get("/api/v1/designs")
        assert answer.status_code == 503
        assert "damaged" in answer.json()["detail"]
        assert "backup" in answer.json()["remedy"]
        assert client.get("/readyz").status_code == 503


def test_a_copy_is_kept_before_a_migration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The next migration is one that only this test has."""
    with opened(tmp_path) as database:
        before = revision(database)
        migrations = shutil.copytree(schema.MIGRATIONS, tmp_path / "migrations")
        (migrations / "versions" / "next.py").write_text(
            f"revision, down_revision = 'next', {before!r}\n\ndef upgrade():\n    pass\n"
        )
        monkeypatch.setattr(schema, "MIGRATIONS", migrations)
        (tmp_path / "knitcore.sqlite3.before-next.partial").touch()  # an attempt that failed
        migrate(database)
        assert revision(database) == "next"
    (copy,) = tmp_path.glob("*.before-*")
    assert copy.name.endswith(".before-next")
    assert copy.stat().st_mode & 0o077 == 0
    with opened(f"sqlite:///{copy}", migrated=False) as old:
        assert revision(old) == before
        old.check_pages()


def test_a_cluster_without_workers_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster_module, "WORKERS_S", 0.2)
    monkeypatch.setattr(cluster_module, "CONNECT_S", 60.0)
    with scheduler(tmp_path) as address:
        cluster = Cluster(address)
        with pytest.raises(ClusterError, match="accepts computations"):
            cluster.begin("a-job", print)
        cluster.close()
        settings = {"data_dir": tmp_path / "data", "scheduler": address}
        failed = doctor.examine(Settings(**settings)).failed
        assert [check.name for check in failed] == ["cluster"]
        with served(**settings) as client:
            assert client.get("/readyz").status_code == 503
            wish = {"chart": "KP", "material": "acrylic"}
            refused = client.post("/api/v1/relax", json=wish)
            assert refused.status_code == 503
            assert "accepts computations" in refused.json()["detail"]


def test_the_doctor_answers_whatever_happens(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(doctor, "_check_modes", lambda _: {}["not there"])
    result = _doctor(tmp_path)
    assert result.exit_code == 1
    assert "FAIL  file modes: KeyError: 'not there'. Report this as a bug." in result.output
