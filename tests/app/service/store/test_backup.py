"""Backups: whole, readable, movable to another database, refused when they are not."""

import gzip
import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner

from app.cli.main import main
from app.service.designs.document import DesignDocument, ShareMode
from app.service.designs.sharing import Sharing
from app.service.designs.store import DesignStore
from app.service.jobs.document import JobState
from app.service.jobs.store import JobStore
from app.service.store.backup import back_up, restore
from app.service.store.database import Database
from app.service.store.schema import migrate
from knitcore.base.errors import InputError

RIB = DesignDocument(name="Cuff “42”", material="acrylic", chart="KPKP\nKPKP", note="ä\n✓")


def _database(folder: Path) -> Database:
    folder.mkdir(exist_ok=True)
    return Database(f"sqlite:///{folder / 'knitcore.sqlite3'}")


@pytest.fixture
def filled(tmp_path: Path) -> Iterator[Database]:
    database = _database(tmp_path / "old")
    migrate(database)
    designs = DesignStore(database)
    for _ in range(3):
        designs.create("ada", RIB)
    kept = designs.create("bob", RIB)
    designs.keep_version("bob", kept.id, "first")
    JobStore(database, "main").add("bob", "stretch", "{}", "k", JobState.WAITING)
    yield database
    database.close()


def test_a_restore_brings_everything_back(filled: Database, tmp_path: Path) -> None:
    bob = DesignStore(filled).page("bob", limit=9, cursor=None, deleted=False).designs[0]
    link = Sharing(filled).give("bob", bob.id, ShareMode.READ)
    file = tmp_path / "backup.gz"
    report = back_up(filled, file)
    assert report.tables["designs"] == 4
    assert file.stat().st_mode & 0o077 == 0
    other = _database(tmp_path / "new")
    assert restore(other, file).tables == report.tables
    for owner in ("ada", "bob"):
        page = DesignStore(other).page(owner, limit=9, cursor=None, deleted=False)
        assert page == DesignStore(filled).page(owner, limit=9, cursor=None, deleted=False)
    assert DesignStore(other).get("bob", bob.id).document == RIB
    assert DesignStore(other).version("bob", bob.id, 1).document == RIB
    assert Sharing(other).open(link.token).document == RIB
    again = tmp_path / "again.gz"
    assert back_up(other, again).tables == report.tables
    other.close()


def test_a_backup_never_overwrites_a_file(filled: Database, tmp_path: Path) -> None:
    file = tmp_path / "backup.gz"
    back_up(filled, file)
    with pytest.raises(InputError, match="exists"):
        back_up(filled, file)
    with pytest.raises(InputError, match="holds 4 rows in designs"):
        restore(filled, file)
    with pytest.raises(InputError, match="cannot be written"):
        back_up(filled, tmp_path / "no" / "folder.gz")


def _cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-200])


def _without_end(file: Path) -> None:
    lines = gzip.decompress(file.read_bytes()).splitlines(keepends=True)
    file.write_bytes(gzip.compress(b"".join(lines[:-1])))


def _without_a_row(file: Path) -> None:
    lines = gzip.decompress(file.read_bytes()).splitlines(keepends=True)
    file.write_bytes(gzip.compress(b"".join(lines[:1] + lines[2:])))


def _rotten(file: Path) -> None:
    """Other content that can be unpacked, with the checksum of what was written."""
    packed = file.read_bytes()
    other = gzip.decompress(packed).replace(b"acrylic", b"cottonn")
    file.write_bytes(gzip.compress(other)[:-8] + packed[-8:])


def _scrambled(file: Path) -> None:
    packed = bytearray(file.read_bytes())
    packed[40:60] = bytes(20)
    file.write_bytes(packed)


def _of_the_future(file: Path) -> None:
    lines = gzip.decompress(file.read_bytes()).splitlines()
    header = json.loads(lines[0]) | {"schema": "9999"}
    file.write_bytes(gzip.compress(b"\n".join([json.dumps(header).encode(), *lines[1:]])))


def _other(file: Path) -> None:
    file.write_bytes(gzip.compress(b'{"format": "something else"}\n'))


@pytest.mark.parametrize(
    "damage", [_cut, _without_end, _without_a_row, _rotten, _scrambled, _of_the_future, _other]
)
def test_a_damaged_backup_changes_nothing(filled: Database, tmp_path: Path, damage: object) -> None:
    assert callable(damage)
    file = tmp_path / "backup.gz"
    back_up(filled, file)
    damage(file)
    other = _database(tmp_path / "new")
    with pytest.raises(InputError):
        restore(other, file)
    migrate(other)
    assert DesignStore(other).page("ada", limit=9, cursor=None, deleted=False).designs == []
    other.close()


def test_the_commands(filled: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "backup.gz"
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path / "old"))
    told = CliRunner().invoke(main, ["backup", str(file), "--json"])
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout)["tables"]["designs"] == 4
    refused = CliRunner().invoke(main, ["restore", str(file)])
    assert refused.exit_code == 2
    assert "already" in refused.stderr
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path / "new"))
    assert CliRunner().invoke(main, ["restore", str(file), "--json"]).exit_code == 0


@pytest.mark.parametrize(
    "line",
    [
        {"table": "no_such_table", "row": {}},
        {"table": "designs", "row": [1]},
        {"table": "designs", "row": {"id": "a", "no_such_column": 1}},
        {"table": "designs", "row": {"id": {}}},
        {"tabel": "designs"},
        {"end": 3},
    ],
)
def test_a_crafted_backup_is_refused_with_a_message(
    filled: Database, tmp_path: Path, line: dict[str, object]
) -> None:
    whole, crafted = tmp_path / "whole.gz", tmp_path / "crafted.gz"
    back_up(filled, whole)
    with gzip.open(whole, "rt") as text:
        header = text.readline()
    with gzip.open(crafted, "wt") as text:
        text.write(header + json.dumps(line) + "\n" + json.dumps({"end": {"designs": 1}}) + "\n")
    other = _database(tmp_path / "new")
    with pytest.raises(InputError, match=r"damaged|not whole"):
        restore(other, crafted)
    assert DesignStore(other).page("ada", limit=9, cursor=None, deleted=False).designs == []
    other.close()


def test_own_materials_are_backed_up_and_restored_inside_their_folder(
    filled: Database, tmp_path: Path
) -> None:
    here, there = tmp_path / "here", tmp_path / "there" / "materials"
    here.mkdir()
    (here / "wool.yaml").write_text("name: Wool ä")
    (here / "notes.txt").write_text("no material")
    file = tmp_path / "with-materials.gz"
    assert back_up(filled, file, here).tables["own materials"] == 1
    other = _database(tmp_path / "new")
    restore(other, file, there)
    other.close()
    assert [f.name for f in there.iterdir()] == ["wool.yaml"]
    assert (there / "wool.yaml").read_text() == "name: Wool ä"
    with gzip.open(file, "rt") as text:
        lines = text.read().replace('"wool.yaml"', '"../../escaped.yaml"')
    crafted = tmp_path / "crafted.gz"
    with gzip.open(crafted, "wt") as text:
        text.write(lines)
    other = _database(tmp_path / "newer")
    restore(other, crafted, there)
    other.close()
    assert not list(tmp_path.glob("escaped*"))
    assert (there / "escaped.yaml").exists()
