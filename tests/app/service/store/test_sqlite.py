"""The locks and files of an SQLite database stay those of the process that has it open."""

import os
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from click.testing import CliRunner
from sqlalchemy import text

from app.cli.main import main
from app.service.doctor import examine
from app.service.problems import DispossessedError, StoreError
from app.service.settings import Settings
from app.service.store.backup import back_up
from app.service.store.database import Database
from app.service.store.schema import migrate
from app.service.store.sqlite import CONNECTIONS, STOP_FIRST, Holder, SqliteFile, holder_of
from knitcore.base.errors import InputError
from tests.app.clients import served
from tests.app.databases import is_whole, opened, sqlite
from tests.app.running import python

LOCK_ALONE = """
import fcntl, sys
with open(sys.argv[1], "r+b") as file:  # the bytes that every open connection holds (os_unix.c)
    fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, 510, 0x40000002)
"""


def _is_locked(file: Path) -> bool:
    """Return whether no other process can have the file alone, as for removing its log."""
    tried = python("-c", LOCK_ALONE, file, check=False)
    assert tried.returncode == 0 or "BlockingIOError" in tried.stderr
    return tried.returncode != 0


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "knitcore.sqlite3"


@pytest.fixture
def database(file: Path) -> Iterator[Database]:
    """A database of a service that runs in this process."""
    with opened(file.parent) as database, database.reserved("main", "http://127.0.0.1:8737/"):
        yield database


def _beside(file: Path, end: str) -> Path:
    return file.with_name(f"{file.name}{end}")


def _write(database: Database, name: str = "a") -> None:
    put = text("INSERT INTO service_keys VALUES (:name, '')")
    database.write(lambda c: c.execute(put, {"name": name}))


def test_nothing_that_a_service_does_drops_its_locks(
    database: Database, file: Path, tmp_path: Path
) -> None:
    settings = Settings(data_dir=tmp_path, workers=1)

    def another() -> None:
        with opened(tmp_path, migrated=False) as second:
            second.check()

    steps: dict[str, Callable[[], object]] = {
        "a read": database.check,
        "a write": lambda: _write(database),
        "its pages": database.check_pages,
        "a copy": lambda: database.backend.keep_copy("copy"),
        "a backup": lambda: back_up(database, tmp_path / "backup.gz"),
        "a migration": lambda: migrate(database),
        "the start, and readiness": lambda: examine(settings, database),
        "the doctor": lambda: examine(settings),
        "its holder": lambda: holder_of(file),
        "another database": another,
        "fresh connections": database.engine.dispose,
    }
    for name, step in steps.items():
        step()
        assert _is_locked(file), name
    with served(database=database, data_dir=tmp_path) as client:
        assert client.get("/readyz").status_code == 200
        assert _is_locked(file)
    assert _is_locked(file), "the application closed a database that was given to it"


def test_a_closed_database_is_locked_no_more(file: Path) -> None:
    with opened(file.parent) as database:
        pass
    assert not _is_locked(file)
    assert not _beside(file, "-wal").exists()
    database.close()  # again


@pytest.mark.parametrize("end", ["-wal", "-shm", ".lock"])
@pytest.mark.parametrize("replaced", [False, True])
def test_a_service_without_its_files_stops_writing(
    database: Database, file: Path, end: str, replaced: bool
) -> None:
    _write(database)
    with served(database=database, data_dir=file.parent) as client:
        assert client.get("/readyz").status_code == 200
        kept = _beside(file, end).rename(file.parent / "kept")
        if replaced:
            _beside(file, end).touch()
        with pytest.raises(DispossessedError, match=f"{end} beside the designs"):
            _write(database, "b")
        design = {"name": "x", "material": "acrylic", "chart": "KP"}
        for answer in (client.get("/readyz"), client.post("/api/v1/designs", json=design)):
            assert answer.status_code == 503
            assert answer.json()["remedy"] == STOP_FIRST
            assert end in answer.json()["detail"]
        kept.rename(_beside(file, end))
        assert client.get("/readyz").status_code == 200
    _write(database, "b")


@pytest.mark.parametrize("end", ["-wal", "-shm"])
def test_a_stop_saves_what_was_acknowledged_before_its_files_vanished(file: Path, end: str) -> None:
    with opened(file.parent) as database, database.reserved("main"):
        _write(database)
        _beside(file, end).unlink()
        with pytest.raises(StoreError):
            _write(database, "b")
    assert is_whole(file)
    with sqlite(file) as connection:
        assert connection.execute("SELECT name FROM service_keys").fetchall() == [("a",)]


def test_commands_are_refused_while_a_service_lacks_its_files(
    database: Database, file: Path
) -> None:
    environment = {"KNITCORE_DATA_DIR": str(file.parent)}
    with database.read():
        _beside(file, "-wal").rename(file.parent / "kept")
    ours = f"process {os.getpid()}"
    for command, code, *says in (
        (["token", "list"], 2, ours, STOP_FIRST),
        (["backup", str(file.parent / "b.gz")], 2, ours, STOP_FIRST),
        (
            ["doctor"],
            1,
            "FAIL  database: data_dir: knitcore.sqlite3-wal was removed",
            f"ok    service: {ours.capitalize()} runs on it",
        ),
    ):
        result = CliRunner().invoke(main, command, env=environment)
        assert result.exit_code == code
        assert all(words in result.output for words in says), result.output
    (file.parent / "kept").rename(_beside(file, "-wal"))


def test_the_doctor_misses_the_lock_of_an_open_database(database: Database, file: Path) -> None:
    assert SqliteFile(file).check_unopened()
    kept = _beside(file, ".lock").rename(file.parent / "kept")
    doctor = CliRunner().invoke(main, ["doctor"], env={"KNITCORE_DATA_DIR": str(file.parent)})
    assert doctor.exit_code == 1
    assert "knitcore.sqlite3.lock is not there" in doctor.output
    kept.rename(_beside(file, ".lock"))


def test_files_are_made_for_this_user_only(database: Database, file: Path) -> None:
    made = [file, *(_beside(file, end) for end in ("-wal", "-shm", ".lock"))]
    assert [place.stat().st_mode & 0o777 for place in made] == [0o600] * 4


def test_a_file_that_cannot_be_opened_is_refused_in_words(tmp_path: Path) -> None:
    for place, why in ((tmp_path, "it is no file"), (tmp_path / "no" / "file", "No such file")):
        with pytest.raises(InputError, match=rf"cannot be opened \({why}"):
            Database(f"sqlite:///{place}")


def test_as_many_connections_stay_open_as_threads_read(sqlite_database: Database) -> None:
    def used() -> set[int]:
        with ExitStack() as readers:
            connections = [
                readers.enter_context(sqlite_database.read()) for _ in range(CONNECTIONS)
            ]
            return {id(c.connection.driver_connection) for c in connections}

    assert used() == used()
    assert sqlite_database.engine.pool.checkedin() == CONNECTIONS  # type: ignore[attr-defined]


def test_the_file_of_a_lock_names_its_holder() -> None:
    holder = Holder("7", "http://127.0.0.1:1/", {"a b.sqlite3-wal": 42})
    assert Holder.read(holder.text) == holder
    assert Holder.read("7 http://127.0.0.1:1/") == ("7", "http://127.0.0.1:1/", {})
    assert Holder.read("") == ("unknown", "", {})
