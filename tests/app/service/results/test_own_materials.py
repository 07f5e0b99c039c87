"""Material files beside the library, offered to every user of the service."""

import logging
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.service.results.own_materials import (
    MAX_KEPT,
    added_by,
    keep_material,
    own_materials,
    remove_material,
)
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import MeasuredCurve, material, save_material_file
from knitcore.materials.material_document import MaterialDocument
from tests.app.clients import served
from tests.app.command_line import printed
from tests.app.rest import post, refusal

CURVE = MeasuredCurve((0.0, 0.2, 0.4), (0.0, 0.01, 0.03), pulls=4)
CHART = {"fabric": "garter", "columns": 6, "rows": 6}


def save_mine(folder: Path, *, stiffer: float = 1.0) -> Path:
    """A material file: acrylic's, with a measured curve, under another name."""
    acrylic = material("acrylic")
    garter = acrylic.record(Fabric.GARTER)
    law = replace(garter.law, beta_yy=garter.law.beta_yy * stiffer)
    fabrics = {**acrylic.fabrics}
    fabrics[Fabric.GARTER] = replace(garter, law=law, measured={Direction.WALE: CURVE})
    folder.mkdir(exist_ok=True)
    path = folder / "mine.yaml"
    save_material_file(replace(acrylic, identifier="mine", name="Mine", fabrics=fabrics), path)
    return path


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path))
    return tmp_path / "materials"


@pytest.fixture
def own(folder: Path) -> Iterator[TestClient]:
    """A service with one material of its own; its workers read the same folder."""
    save_mine(folder)
    with served() as client:
        yield client


def identifier(client: TestClient) -> str:
    first = client.get("/api/v1/materials").json()["materials"][0]
    assert first["name"] == "Mine"
    return str(first["id"])


def test_an_own_material_is_listed_first_with_its_measured_curve(own: TestClient) -> None:
    mine = identifier(own)
    assert mine.startswith("own:mine.")
    detail = own.get(f"/api/v1/materials/{mine}").json()
    assert detail["measured"] == {
        "garter": {
            "wale": {"strain": [0.0, 0.2, 0.4], "stress_n_per_mm": [0.0, 0.01, 0.03], "pulls": 4}
        }
    }


def test_charts_are_predicted_stretched_and_kept_with_it(own: TestClient) -> None:
    mine = identifier(own)
    moduli = [
        post(own, "predict", {"chart": CHART, "material": name})["modulus_wale_n_per_mm"]
        for name in (mine, "acrylic")
    ]
    assert moduli[0] == pytest.approx(moduli[1])
    pull = {"chart": CHART, "material": mine, "direction": "wale", "strain": 0.3, "steps": 2}
    assert post(own, "stretch", pull)["converged"]
    design = {"name": "Cuff", "material": mine, "chart": "KP\nKP"}
    kept = own.post("/api/v1/designs", json=design)
    assert kept.status_code == 201, kept.text
    again = own.get(f"/api/v1/designs/{kept.json()['id']}").json()
    assert mine in str(again)


def test_a_changed_file_is_another_material(folder: Path, own: TestClient) -> None:
    """Nothing that was kept for the old one is taken for the new one's."""
    old = identifier(own)
    save_mine(folder, stiffer=2.0)
    new = identifier(own)
    assert new != old
    problem = refusal(own, "predict", {"chart": CHART, "material": old})
    assert "changed" in problem["detail"]
    assert problem["remedy"] == "Choose it again."
    (folder / "mine.yaml").unlink()
    assert "gone" in refusal(own, "predict", {"chart": CHART, "material": new})["detail"]


def test_a_file_without_a_material_is_skipped_and_logged(
    folder: Path, own: TestClient, caplog: pytest.LogCaptureFixture
) -> None:
    (folder / "broken.json").write_text("{")
    (folder / "notes.txt").write_text("not looked at")
    with caplog.at_level(logging.WARNING, "knitcore.materials"):
        assert identifier(own)
    assert "broken.json" in caplog.text
    assert "notes.txt" not in caplog.text


def test_the_command_line_lists_it(folder: Path) -> None:
    save_mine(folder)
    listed = printed("materials").output
    assert listed.startswith("own:mine.")
    assert printed("materials", listed.split()[0]).output.startswith("Mine")


def test_a_material_is_added_used_given_back_and_removed(own: TestClient) -> None:
    file = own.get("/api/v1/materials/acrylic/document").json()
    file |= {"identifier": "aunts-wool", "name": "My aunt's wool"}
    added = own.post("/api/v1/materials", json=file)
    assert added.status_code == 201
    name = added.json()["id"]
    assert name.startswith("own:aunts-wool.")
    offered = own.get("/api/v1/materials").json()["materials"]
    assert [yarn["id"] for yarn in offered if yarn["added_by_you"]] == [name]
    mine, library = (
        post(own, "predict", {"chart": "KP", "material": yarn})["modulus_course_n_per_mm"]
        for yarn in (name, "acrylic")
    )
    assert mine == pytest.approx(library)
    assert own.get(f"/api/v1/materials/{name}/document").json() == file
    assert own.delete(f"/api/v1/materials/{name}").status_code == 204
    assert own.delete(f"/api/v1/materials/{name}").status_code == 404
    refusal(own, "predict", {"chart": "KP", "material": name})


def test_a_replaced_material_answers_those_who_compute_with_it(own: TestClient) -> None:
    file = own.get("/api/v1/materials/acrylic/document").json() | {"identifier": "mine"}
    names = [
        own.post("/api/v1/materials", json=file | {"name": name}).json()["id"]
        for name in ("First", "Second", "Third")
    ]

    def predicted(name: str) -> int:
        return own.post("/api/v1/predict", json={"chart": "KP", "material": name}).status_code

    assert [predicted(name) for name in names] == [422, 200, 200]
    offered = {yarn["id"] for yarn in own.get("/api/v1/materials").json()["materials"]}
    assert offered.isdisjoint(names[:2])
    own.delete(f"/api/v1/materials/{names[2]}")
    assert [predicted(name) for name in names] == [422, 422, 422]


def test_only_who_added_a_material_removes_it(folder: Path) -> None:
    document = MaterialDocument.from_material(material("acrylic"))
    kept = keep_material(document, "ann", folder.parent)
    assert added_by("ann", folder.parent) == {kept.identifier}
    assert added_by("bob", folder.parent) == set()
    assert not remove_material(kept.identifier, "bob", folder.parent)
    assert remove_material(kept.identifier, "ann", folder.parent)
    assert own_materials(folder.parent) == {}


def test_as_many_users_as_there_are_see_all_their_materials(folder: Path) -> None:
    document = MaterialDocument.from_material(material("acrylic"))
    users = [f"user-{number}" for number in range(6)]
    for user, number in product(users, range(MAX_KEPT)):
        own = document.model_copy(update={"identifier": f"{user}-{number}"})
        keep_material(own, user, folder.parent)
    everything = own_materials(folder.parent)
    for user in users:
        mine = added_by(user, folder.parent)
        assert len(mine) == MAX_KEPT
        assert mine <= everything.keys()
