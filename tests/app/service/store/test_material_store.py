"""Materials of users in the database: whose they are, and what replaces them."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.service.limits.user_limits import USER_LIMITS, OverLimitError
from app.service.store import material_store
from app.service.store.database import Database
from app.service.store.material_store import MaterialStore
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import MeasuredCurve, material
from knitcore.materials.material_document import MaterialDocument
from tests.app.clients import served, state_of
from tests.app.command_line import printed, run
from tests.app.databases import opened
from tests.app.rest import post, refusal

CURVE = MeasuredCurve((0.0, 0.2, 0.4), (0.0, 0.01, 0.03), pulls=4)
CHART = {"fabric": "garter", "columns": 6, "rows": 6}
ACRYLIC = MaterialDocument.from_material(material("acrylic"))


def named(identifier: str, name: str = "Yarn") -> MaterialDocument:
    return ACRYLIC.model_copy(update={"identifier": identifier, "name": name})


def mine() -> MaterialDocument:
    """Acrylic with a measured curve, under another name."""
    yarn = material("acrylic")
    garter = replace(yarn.record(Fabric.GARTER), measured={Direction.WALE: CURVE})
    fabrics = {**yarn.fabrics, Fabric.GARTER: garter}
    return MaterialDocument.from_material(
        replace(yarn, identifier="mine", name="Mine", fabrics=fabrics)
    )


@pytest.fixture
def own() -> Iterator[TestClient]:
    """A service with a material of its user's."""
    with served() as client:
        MaterialStore(state_of(client).database).keep(mine(), "local")
        yield client


def identifier(client: TestClient) -> str:
    first = client.get("/api/v1/materials").json()["materials"][0]
    assert first["name"] == "Mine"
    return str(first["id"])


def test_a_material_is_listed_first_with_its_measured_curve(own: TestClient) -> None:
    mine = identifier(own)
    assert mine.startswith("own:mine.")
    assert own.get(f"/api/v1/materials/{mine}").json()["measured"] == {
        "garter": {
            "wale": {"strain": [0.0, 0.2, 0.4], "stress_n_per_mm": [0.0, 0.01, 0.03], "pulls": 4}
        }
    }


@pytest.mark.slow
def test_charts_are_predicted_stretched_and_kept_with_it(own: TestClient) -> None:
    """Here, on a worker, in a job, and in a picture that a worker draws."""
    mine = identifier(own)
    moduli = [
        post(own, "predict", {"chart": CHART, "material": name})["modulus_wale_n_per_mm"]
        for name in (mine, "acrylic")
    ]
    assert moduli[0] == pytest.approx(moduli[1])
    pull = {"chart": CHART, "material": mine, "direction": "wale", "strain": 0.3, "steps": 2}
    assert post(own, "stretch", pull)["converged"]
    assert (
        own.post("/api/v1/views/page", json={"chart": CHART, "material": mine}).status_code == 200
    )
    design = {"name": "Cuff", "material": mine, "chart": "KP\nKP"}
    kept = own.post("/api/v1/designs", json=design).json()
    assert own.get(f"/api/v1/designs/{kept['id']}").json()["document"]["material"] == mine
    link = own.post(f"/api/v1/designs/{kept['id']}/shares", json={"mode": "read"}).json()
    shared = own.get(f"/api/v1/shared/{link['token']}").json()["document"]["material"]
    assert own.get(f"/api/v1/materials/{shared}").json()["name"] == "Mine"


def test_a_material_is_added_used_given_back_and_removed(own: TestClient) -> None:
    file = own.get("/api/v1/materials/acrylic/document").json()
    file |= {"identifier": "aunts-wool", "name": "My aunt's wool"}
    added = own.post("/api/v1/materials", json=file)
    assert added.status_code == 201
    name = added.json()["id"]
    assert name.startswith("own:aunts-wool.")
    assert own.post("/api/v1/materials", json=file).json()["id"] == name  # again
    offered = own.get("/api/v1/materials").json()["materials"]
    assert [yarn["name"] for yarn in offered if yarn["added_by_you"]] == ["Mine", "My aunt's wool"]
    mine, library = (
        post(own, "predict", {"chart": "KP", "material": yarn})["modulus_course_n_per_mm"]
        for yarn in (name, "acrylic")
    )
    assert mine == pytest.approx(library)
    assert own.get(f"/api/v1/materials/{name}/document").json() == file
    assert own.get("/api/v1/session").json()["use"]["materials"] == {
        "used": 2, "most": USER_LIMITS.materials,
    }  # fmt: skip
    assert own.delete(f"/api/v1/materials/{name}").status_code == 204
    assert own.delete(f"/api/v1/materials/{name}").status_code == 404
    refusal(own, "predict", {"chart": "KP", "material": name})


def test_a_replaced_material_answers_those_who_compute_with_it(database: Database) -> None:
    store = MaterialStore(database)
    names = [store.keep(named("mine", name), "ann").identifier for name in ("1st", "2nd", "3rd")]
    with pytest.raises(InputError, match="was changed since"):
        store.find(names[0])
    assert [store.find(name).name for name in names[1:]] == ["2nd", "3rd"]
    assert [(own.name, mine) for own, mine in store.listed("ann")] == [("3rd", True)]
    back = store.keep(named("mine", "2nd"), "ann")
    assert [own.identifier for own, _ in store.listed("ann")] == [back.identifier] == [names[1]]
    assert store.find(names[2]).name == "3rd"
    assert store.remove(back.identifier, "ann")
    assert store.documents(names) == {}


def test_only_who_added_a_material_removes_or_replaces_it(database: Database) -> None:
    store = MaterialStore(database)
    kept = store.keep(named("mine"), "ann")
    assert not store.remove(kept.identifier, "bob")
    store.keep(named("mine", "Bob's"), "bob")
    assert [(own.name, mine) for own, mine in store.listed("bob")] == [
        ("Bob's", True), ("Yarn", False),
    ]  # fmt: skip
    assert store.remove(kept.identifier, "ann")
    assert [own.name for own, _ in store.listed("ann")] == ["Bob's"]


def test_of_two_materials_with_one_identifier_the_earlier_counts(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody puts a yarn in the place of another user's by a mark that is made to agree."""
    monkeypatch.setattr(material_store, "marked", lambda identifier, _: f"own:{identifier}.000000")
    store = MaterialStore(database)
    store.keep(named("mine", "Ann's"), "ann")
    store.keep(named("mine", "Bob's"), "bob")
    assert store.find("own:mine.000000").name == "Ann's"


@pytest.mark.slow
def test_many_users_see_all_their_materials(database: Database) -> None:
    """A user's quota has nothing to do with others', and holds when requests come at once."""
    store, most = MaterialStore(database), USER_LIMITS.materials
    users = [f"user-{number}" for number in range(12)]
    with ThreadPoolExecutor(4) as threads:
        for _ in threads.map(
            lambda kept: store.keep(named(f"{kept[0]}-{kept[1]}"), kept[0]),
            product(users, range(most)),
        ):
            pass
    listed = store.listed(users[7])
    assert len(listed) == len(users) * most
    assert [mine for _, mine in listed] == [True] * most + [False] * (len(users) - 1) * most
    for user in users:
        assert store.count(user) == most
        with pytest.raises(OverLimitError, match=f"{most} of {most}"):
            store.keep(named("too-many"), user)
    store.keep(named("user-7-0", "Changed"), "user-7")  # what is there may change


def test_the_command_line_has_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path))
    assert "own:" not in printed("materials").output
    assert not list(tmp_path.iterdir())
    with opened(tmp_path) as database:
        MaterialStore(database).keep(mine(), "local")
    listed = printed("materials").output
    assert listed.startswith("own:mine.")
    name = listed.split()[0]
    assert printed("materials", name).output.startswith("Mine")
    assert run("predict", "KP", "--material", name)["modulus_course_n_per_mm"] > 0
