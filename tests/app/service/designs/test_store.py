"""Designs in the database, on SQLite and on PostgreSQL."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from app.service.designs import sharing as sharing_module
from app.service.designs import store as store_module
from app.service.designs.conditions import (
    KEPT_S,
    ConflictError,
    Retry,
    ReusedKeyError,
    StaleError,
    UnconditionalError,
    forget_old_keys,
)
from app.service.designs.document import (
    Design,
    DesignDocument,
    DesignPatch,
    Run,
    ShareMode,
    Strokes,
)
from app.service.designs.sharing import NotAllowedError, Sharing
from app.service.designs.store import DesignStore
from app.service.limits.user_limits import OverLimitError, UserLimits
from app.service.problems import NotFoundError
from app.service.store.database import Database
from knitcore.base.errors import InputError

RIB = DesignDocument(name="Cuff", material="acrylic", chart="KPKP\nKPKP", note="soft")


@pytest.fixture
def designs(database: Database) -> DesignStore:
    return DesignStore(database)


@pytest.fixture
def made(designs: DesignStore) -> Design:
    """A design of Ada's."""
    return designs.create("ada", RIB)


def _paint(
    designs: DesignStore, design: Design, *runs: tuple[int, int, str], rows: int = 2,
    columns: int = 4, owner: str = "ada",
) -> None:  # fmt: skip
    painted = [Run(row=r, column=c, stitches=s) for r, c, s in runs]
    strokes = Strokes(rows=rows, columns=columns, runs=painted)
    asyncio.run(designs.paint(owner, design.id, strokes))


def _listed(designs: DesignStore, owner: str, *, deleted: bool = False, part: str = "") -> Any:
    return designs.page(owner, limit=9, cursor=None, deleted=deleted, part=part).designs


def test_a_saved_design_is_returned(designs: DesignStore) -> None:
    made = designs.create("ada", RIB.model_copy(update={"chart": "kp|•\nkpkp"}))
    assert made.document == RIB
    assert (made.rows, made.columns, made.revision) == (2, 4, 1)
    assert designs.get("ada", made.id) == made


def test_designs_are_private_to_their_owner(designs: DesignStore, made: Design) -> None:
    for attempt in (
        lambda: designs.get("eve", made.id),
        lambda: _paint(designs, made, (0, 0, "P"), owner="eve"),
        lambda: designs.replace("eve", made.id, RIB, "*"),
        lambda: designs.delete("eve", made.id, None),
        lambda: designs.versions("eve", made.id),
        lambda: designs.duplicate("eve", made.id),
    ):
        with pytest.raises(NotFoundError):
            attempt()
    assert _listed(designs, "eve") == []
    assert designs.get("ada", made.id) == made


def test_pages_hold_every_design_once(designs: DesignStore) -> None:
    made = [designs.create("ada", RIB).id for _ in range(7)]
    seen: list[str] = []
    cursor = None
    while True:
        page = designs.page("ada", limit=3, cursor=cursor, deleted=False)
        assert len(page.designs) <= 3
        seen += [d.id for d in page.designs]
        cursor = page.next_cursor
        if cursor is None:
            break
    assert seen == made[::-1]
    with pytest.raises(InputError, match="next_cursor"):
        designs.page("ada", limit=3, cursor="nonsense", deleted=False)


def test_designs_are_found_by_a_part_of_their_name(designs: DesignStore) -> None:
    for name in ("Ribbed cuff", "Cuff, 100% cotton", "Sock"):
        designs.create("ada", RIB.model_copy(update={"name": name}))

    def named(part: str) -> set[str]:
        return {design.name for design in _listed(designs, "ada", part=part)}

    assert named("cuff") == {"Ribbed cuff", "Cuff, 100% cotton"}
    assert named("0%") == {"Cuff, 100% cotton"}  # no pattern
    assert named("hat") == set()


def test_a_change_on_an_old_state_is_refused(designs: DesignStore, made: Design) -> None:
    mine = RIB.model_copy(update={"name": "Mine"})
    assert designs.replace("ada", made.id, mine, '"1"').revision == 2
    with pytest.raises(StaleError, match="revision 2"):
        designs.replace("ada", made.id, RIB, '"1"')
    with pytest.raises(UnconditionalError):
        designs.patch("ada", made.id, DesignPatch(name="Other"), None)
    assert designs.get("ada", made.id).name == "Mine"
    renamed = designs.patch("ada", made.id, DesignPatch(name="Other"), '"1", "2"')
    assert (renamed.name, renamed.document.note) == ("Other", "soft")


def test_of_many_concurrent_changes_one_wins(designs: DesignStore, made: Design) -> None:
    def change(number: int) -> int | None:
        renamed = RIB.model_copy(update={"name": f"N{number}"})
        try:
            return designs.replace("ada", made.id, renamed, '"1"').revision
        except StaleError:
            return None

    with ThreadPoolExecutor(8) as threads:
        outcomes = list(threads.map(change, range(16)))
    assert sorted(outcomes, key=str) == [2, *[None] * 15]


def test_strokes_of_several_people_merge(designs: DesignStore) -> None:
    chart = "\n".join(["K" * 16] * 16)
    made = designs.create("ada", RIB.model_copy(update={"chart": chart}))

    def stroke(number: int) -> None:
        row, column = divmod(number, 16)
        _paint(designs, made, (row, column, "P"), rows=16, columns=16)

    with ThreadPoolExecutor(8) as threads:
        list(threads.map(stroke, range(0, 256, 2)))
    kept = designs.get("ada", made.id)
    assert kept.document.chart == "\n".join(["PK" * 8] * 16)
    assert kept.revision == 1 + 128


def test_strokes_are_painted_in_place_or_refused(designs: DesignStore, made: Design) -> None:
    _paint(designs, made, (0, 1, "KK"), (1, 3, "K"), (0, 2, "P"))
    assert designs.get("ada", made.id).document.chart == "KPKK\nKKPP"
    with pytest.raises(InputError, match="reaches beyond the chart"):
        _paint(designs, made, (0, 3, "KK"))
    with pytest.raises(ConflictError, match="4x2"):
        _paint(designs, made, (0, 0, "K"), rows=3)
    assert designs.get("ada", made.id).revision == 2


def test_a_deleted_design_can_be_recovered_for_a_while(
    designs: DesignStore, made: Design, monkeypatch: pytest.MonkeyPatch
) -> None:
    gone = designs.create("ada", RIB)
    designs.delete("ada", made.id, None)
    with pytest.raises(NotFoundError):
        designs.get("ada", made.id)
    (aside,) = _listed(designs, "ada", deleted=True)
    assert aside.id == made.id
    assert aside.deleted_at is not None
    assert designs.recover("ada", made.id).document == made.document
    with pytest.raises(NotFoundError):
        designs.recover("ada", made.id)

    with pytest.raises(StaleError):
        designs.delete("ada", gone.id, '"7"')
    designs.keep_version("ada", gone.id, "first")
    designs.delete("ada", gone.id, '"1"')
    assert designs.forget_deleted() == 0
    monkeypatch.setattr(store_module, "DELETED_KEPT_S", -1.0)
    assert designs.forget_deleted() == 1
    with pytest.raises(NotFoundError):
        designs.recover("ada", gone.id)


def test_versions_are_kept_and_a_restore_loses_nothing(designs: DesignStore, made: Design) -> None:
    kept = designs.keep_version("ada", made.id, "As discussed")
    assert (kept.number, kept.revision) == (1, 1)
    wide = RIB.model_copy(update={"name": "Wide", "chart": "KKKKKK"})
    designs.replace("ada", made.id, wide, '"1"')
    with pytest.raises(StaleError):
        designs.restore("ada", made.id, 1, '"1"')
    restored = designs.restore("ada", made.id, 1, '"2"')
    assert restored.document == RIB
    assert (restored.rows, restored.columns, restored.revision) == (2, 4, 3)
    versions = designs.versions("ada", made.id).versions
    assert [(v.number, v.automatic) for v in versions] == [(1, False), (2, True)]
    assert designs.version("ada", made.id, 2).document == wide
    with pytest.raises(NotFoundError, match="no version 3"):
        designs.version("ada", made.id, 3)


def test_a_copy_is_an_independent_design(designs: DesignStore, made: Design) -> None:
    copy = designs.duplicate("ada", made.id)
    assert copy.id != made.id
    assert copy.name == "Cuff (copy)"
    _paint(designs, copy, (0, 0, "PPPP"))
    assert designs.get("ada", made.id).document == RIB


def test_the_designs_of_one_owner_are_limited(
    designs: DesignStore, made: Design, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_module, "USER_LIMITS", UserLimits(designs=2, versions=1))
    designs.create("ada", RIB)
    designs.create("bob", RIB)
    with pytest.raises(OverLimitError, match="the most allowed"):
        designs.create("ada", RIB)
    designs.keep_version("ada", made.id, "first")
    with pytest.raises(OverLimitError, match="the most allowed"):
        designs.keep_version("ada", made.id, "second")


def test_a_retried_request_takes_effect_once(
    database: Database, designs: DesignStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    retry = Retry.of("ada", "key-0001", "POST", "body")
    with ThreadPoolExecutor(4) as threads:
        made = list(threads.map(lambda _: designs.create("ada", RIB, retry), range(4)))
    assert len({d.id for d in made}) == 1
    assert len(_listed(designs, "ada")) == 1
    with pytest.raises(ReusedKeyError):
        designs.create("ada", RIB, Retry.of("ada", "key-0001", "POST", "another body"))
    assert designs.create("bob", RIB, Retry.of("bob", "key-0001", "POST", "b")).id != made[0].id
    monkeypatch.setattr("app.service.designs.conditions.KEPT_S", KEPT_S - 2 * KEPT_S)
    forget_old_keys(database)
    assert designs.create("ada", RIB, retry).id != made[0].id


def test_links_show_copy_and_close(database: Database, designs: DesignStore, made: Design) -> None:
    links = Sharing(database)
    read = links.give("ada", made.id, ShareMode.READ)
    copy = links.give("ada", made.id, ShareMode.COPY)
    _paint(designs, made, (0, 0, "P"))
    assert links.open(read.token).document.chart == "KPKP\nPPKP"
    with pytest.raises(NotAllowedError):
        links.copy("bob", read.token)
    assert links.copy("bob", copy.token).document.chart == "KPKP\nPPKP"
    with pytest.raises(NotFoundError):
        links.give("bob", made.id, ShareMode.READ)

    links.revoke("ada", made.id, read.id)
    assert [s.id for s in links.given("ada", made.id).shares] == [copy.id]
    for closed in (read.token, "x" * 43):
        with pytest.raises(NotFoundError):
            links.open(closed)
    with pytest.raises(NotFoundError):
        links.revoke("ada", made.id, read.id)
    designs.delete("ada", made.id, None)
    with pytest.raises(NotFoundError):
        links.open(copy.token)


def test_the_secret_of_a_link_is_not_in_the_database(database: Database, made: Design) -> None:
    token = Sharing(database).give("ada", made.id, ShareMode.READ).token
    with database.read() as connection:
        kept = connection.exec_driver_sql("SELECT * FROM shares").all()
    assert len(kept) == 1
    assert token not in str(kept)


PLACED = {"row": 0, "column": 0, "rows": 2, "columns": 4}
LAYOUT = RIB.model_validate(
    {
        "version": 2,
        "name": "Shaped",
        "material": "acrylic",
        "chart": "KPKP\nKPKP",
        "outline": "xxx.\nxxxx",
        "regions": [
            {"id": "a", "name": "A", "colour": "#112233", "fill": "KP", "runs": [[0, 0, 2]]},
            {"id": "b", "name": "B", "colour": "#445566", "yarn": "blue", "runs": [[0, 1, 3]]},
        ],
        "repeats": [{"id": "m", "name": "rib", "motif": "KP", "placements": [PLACED]}],
        "shelf": [{"name": "mine", "motif": "KP/PK"}],
    }
)


def test_outline_regions_repeats_and_shelf_are_kept_everywhere(designs: DesignStore) -> None:
    made = designs.create("ada", LAYOUT)
    assert made.document == LAYOUT
    assert made.document.version == 2
    designs.keep_version("ada", made.id, "shaped")
    _paint(designs, made, (0, 0, "P"))
    painted = designs.get("ada", made.id).document
    assert painted == LAYOUT.model_copy(update={"chart": "KPKP\nPPKP"})
    assert designs.duplicate("ada", made.id).document.regions == LAYOUT.regions
    assert designs.replace("ada", made.id, RIB, "*").document == RIB
    assert designs.version("ada", made.id, 1).document == LAYOUT
    assert designs.restore("ada", made.id, 1, "*").document == LAYOUT


def test_other_stitches_are_kept_everywhere_and_painted_over(designs: DesignStore) -> None:
    lace = [{"row": 1, "column": 1, "codes": "O/"}, {"row": 0, "column": 0, "codes": "[2/2R]"}]
    document = DesignDocument.model_validate({**LAYOUT.model_dump(), "other_stitches": lace})
    made = designs.create("ada", document)
    assert made.document == document
    designs.keep_version("ada", made.id, "lace")
    assert designs.duplicate("ada", made.id).document.other_stitches == document.other_stitches
    _paint(designs, made, (1, 2, "P"), (0, 3, "K"))
    left = designs.get("ada", made.id).document.other_stitches
    assert [(run.row, run.column, run.codes) for run in left] == [(1, 1, "O")]
    assert designs.restore("ada", made.id, 1, "*").document == document


def test_a_layout_must_belong_to_its_chart(designs: DesignStore) -> None:
    with pytest.raises(InputError, match="4x2 cells, the chart 2x1"):
        designs.create("ada", LAYOUT.model_copy(update={"chart": "KP"}))


LARGE = DesignDocument(name="Cuff", material="acrylic", chart="\n".join(["KP" * 50] * 100))
BESIDE_IT = {"other_stitches", "outline", "machine", "regions", "repeats", "shelf"}
SIZE = len(LARGE.chart) + len(LARGE.model_dump_json(include=BESIDE_IT))


def test_bytes_kept_are_counted_with_versions(
    designs: DesignStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(store_module, "USER_LIMITS", UserLimits(kept_bytes=3 * SIZE))
    first = designs.create("ada", LARGE)
    designs.keep_version("ada", first.id, "one")
    assert (designs.most_versions("ada"), designs.most_versions("bob")) == (1, 0)
    second = designs.duplicate("ada", first.id)
    larger = LARGE.model_copy(update={"note": "n"})
    for refused in (
        lambda: designs.create("ada", LARGE),
        lambda: designs.keep_version("ada", first.id, "two"),
        lambda: designs.replace("ada", second.id, larger, "*"),
    ):
        with pytest.raises(OverLimitError, match="of 0 MB"):
            refused()
    small = LARGE.model_copy(update={"chart": "KP"})
    assert designs.replace("ada", second.id, small, "*").columns == 2  # smaller is always taken
    assert designs.replace("ada", second.id, larger.model_copy(update={"chart": "K"}), "*")
    assert designs.create("bob", LARGE)


def test_links_to_a_design_are_bounded(
    database: Database, made: Design, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sharing_module, "USER_LIMITS", UserLimits(links=2))
    links = Sharing(database)
    first = links.give("ada", made.id, ShareMode.READ)
    links.give("ada", made.id, ShareMode.COPY)
    with pytest.raises(OverLimitError, match="2 open links"):
        links.give("ada", made.id, ShareMode.READ)
    assert links.most_given("ada") == 2
    links.revoke("ada", made.id, first.id)
    assert (links.most_given("ada"), links.most_given("bob")) == (1, 0)
    assert links.give("ada", made.id, ShareMode.READ).token
