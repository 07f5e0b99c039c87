"""Backups: whole, readable, movable to another database, refused when they are not."""

import gzip
import json
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from app.service.designs.document import DesignDocument, DesignSummary, ShareMode
from app.service.designs.sharing import Sharing
from app.service.designs.store import DesignStore
from app.service.jobs.document import JobState
from app.service.jobs.store import JobStore
from app.service.store.backup import back_up, restore
from app.service.store.database import Database
from app.service.store.material_store import MaterialStore
from app.service.store.schema import migrate
from knitcore.base.errors import InputError
from knitcore.materials import material
from knitcore.materials.material_document import MaterialDocument
from tests.app.command_line import refused, run
from tests.app.databases import opened

RIB = DesignDocument(name="Cuff “42”", material="acrylic", chart="KPKP\nKPKP", note="ä\n✓")


@pytest.fixture
def filled(tmp_path: Path) -> Iterator[Database]:
    with opened(tmp_path / "old") as database:
        designs = DesignStore(database)
        for _ in range(3):
            designs.create("ada", RIB)
        kept = designs.create("bob", RIB)
        designs.keep_version("bob", kept.id, "first")
        JobStore(database, "main").add("bob", "stretch", "{}", "k", JobState.WAITING)
        yield database


@pytest.fixture
def other(place: Path | str) -> Iterator[Database]:
    """A new database without tables, of either kind."""
    with opened(place / "new" if isinstance(place, Path) else place, migrated=False) as database:
        yield database


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "backup.gz"


def designs_of(database: Database, owner: str) -> list[DesignSummary]:
    return DesignStore(database).page(owner, limit=9, cursor=None, deleted=False).designs


def test_a_restore_brings_everything_back(filled: Database, other: Database, file: Path) -> None:
    (bob,) = designs_of(filled, "bob")
    link = Sharing(filled).give("bob", bob.id, ShareMode.READ)
    report = back_up(filled, file)
    assert report.tables["designs"] == 4
    assert file.stat().st_mode & 0o077 == 0
    assert restore(other, file).tables == report.tables
    for owner in ("ada", "bob"):
        assert designs_of(other, owner) == designs_of(filled, owner)
    assert DesignStore(other).get("bob", bob.id).document == RIB
    assert DesignStore(other).version("bob", bob.id, 1).document == RIB
    assert Sharing(other).open(link.token).document == RIB
    assert back_up(other, file.with_name("again.gz")).tables == report.tables


def test_a_backup_never_overwrites_a_file(filled: Database, tmp_path: Path, file: Path) -> None:
    back_up(filled, file)
    with pytest.raises(InputError, match="exists"):
        back_up(filled, file)
    with pytest.raises(InputError, match="holds 4 rows in designs"):
        restore(filled, file)
    with pytest.raises(InputError, match="cannot be written"):
        back_up(filled, tmp_path / "no" / "folder.gz")


def _of_lines(change: Callable[[list[bytes]], list[bytes]]) -> Callable[[bytes], bytes]:
    """The change of a backup's lines, as one of the packed file."""
    return lambda packed: gzip.compress(
        b"".join(change(gzip.decompress(packed).splitlines(keepends=True)))
    )


def _of_the_future(lines: list[bytes]) -> list[bytes]:
    header = json.loads(lines[0]) | {"schema": "9999"}
    return [json.dumps(header).encode() + b"\n", *lines[1:]]


def _rotten(packed: bytes) -> bytes:
    """Other content that can be unpacked, with the checksum of what was written."""
    content = gzip.decompress(packed).replace(b"acrylic", b"cottonn")
    return gzip.compress(content)[:-8] + packed[-8:]


DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "cut": lambda packed: packed[:-200],
    "without its end": _of_lines(lambda lines: lines[:-1]),
    "without a row": _of_lines(lambda lines: lines[:1] + lines[2:]),
    "rotten": _rotten,
    "scrambled": lambda packed: packed[:40] + bytes(20) + packed[60:],
    "of the future": _of_lines(_of_the_future),
    "of another program": lambda _: gzip.compress(b'{"format": "something else"}\n'),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_backup_changes_nothing(
    filled: Database, other: Database, file: Path, damage: str
) -> None:
    back_up(filled, file)
    file.write_bytes(DAMAGES[damage](file.read_bytes()))
    with pytest.raises(InputError):
        restore(other, file)
    migrate(other)
    assert designs_of(other, "ada") == []


def test_the_commands(
    filled: Database, tmp_path: Path, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path / "old"))
    assert run("backup", file)["tables"]["designs"] == 4
    assert "already" in refused("restore", file)
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path / "new"))
    run("restore", file)


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
    filled: Database, other: Database, file: Path, line: dict[str, object]
) -> None:
    back_up(filled, file)
    crafted = [f"{json.dumps(row)}\n".encode() for row in (line, {"end": {"designs": 1}})]
    file.write_bytes(_of_lines(lambda lines: [lines[0], *crafted])(file.read_bytes()))
    with pytest.raises(InputError, match=r"damaged|not whole"):
        restore(other, file)
    assert designs_of(other, "ada") == []


def test_own_materials_are_backed_up_and_restored(
    filled: Database, other: Database, file: Path
) -> None:
    document = MaterialDocument.from_material(material("acrylic"))
    names = [
        MaterialStore(filled).keep(document.model_copy(update={"name": name}), "ada").identifier
        for name in ("First", "Second")
    ]
    assert back_up(filled, file).tables["own_materials"] == 2
    restore(other, file)
    store = MaterialStore(other)
    assert [store.find(name).name for name in names] == ["First", "Second"]
    assert [own.name for own, mine in store.listed("ada") if mine] == ["Second"]
