"""Export and import over REST and on the command line."""

import base64
import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore.formats.write.export import FORMATS, ExportKind
from tests.app.command_line import refused, run
from tests.app.rest import post

CHART = "KPKK\nPPKP\nKKPP"


@pytest.mark.parametrize("kind", list(ExportKind))
def test_export_writes_the_file(kind: ExportKind, tmp_path: Path) -> None:
    out = tmp_path / f"chart{FORMATS[kind].suffix}"
    facts = run("export", "garter", "--size", "6x4", "--to", kind.value, "-o", str(out))
    assert facts["bytes"] == out.stat().st_size
    assert (facts["columns"], facts["rows"]) == (6, 4)
    assert facts["transfers"] == (18 if kind is ExportKind.KNITOUT else None)


@pytest.mark.parametrize(
    "kind",
    [
        ExportKind.KNITOUT,
        ExportKind.PNG,
        ExportKind.TEXT,
        ExportKind.WRITTEN,
        ExportKind.KNITSPEAK,
        ExportKind.DESIGN,
    ],
)
def test_an_exported_file_is_imported(kind: ExportKind, client: TestClient, tmp_path: Path) -> None:
    file = post(client, "export", {"chart": CHART, "to": kind, "name": "A/b"})
    assert file["name"] == "A-b" + FORMATS[kind].suffix

    upload = {"file": {"name": file["name"], "content": file["content"]}}
    told = client.post("/api/v1/import", json=upload)
    assert told.json()["chart"] == CHART

    path = tmp_path / file["name"]
    path.write_bytes(base64.b64decode(file["content"]))
    assert run("import", str(path)) == told.json()
    if kind is ExportKind.DESIGN:
        assert (told.json()["name"], told.json()["material"]) == ("A/b", "acrylic")


SHAPED = {
    "chart": "KPKK\nPPKP\nKKPP",
    "outline": "xx..\nxxxx\nxxxx",
    "regions": [
        {"id": "a", "name": "Navy", "colour": "#1f3b70", "yarn": "navy", "runs": [[0, 0, 4]]}
    ],
}


@pytest.mark.parametrize(
    "kind", [ExportKind.KNITOUT, ExportKind.PNG, ExportKind.WRITTEN, ExportKind.DESIGN]
)
def test_outlines_and_yarns_go_there_and_back(kind: ExportKind, client: TestClient) -> None:
    file = post(client, "export", SHAPED | {"to": kind, "linear_density_tex": 400})
    assert file["carriers"] == (2 if kind is ExportKind.KNITOUT else None)
    upload = {"file": {"name": file["name"], "content": file["content"]}}
    told = client.post("/api/v1/import", json=upload).json()
    assert told["outline"] == SHAPED["outline"]
    (region,) = told["regions"]
    assert (region["yarn"], region["colour"], region["runs"]) == ("navy", "#1f3b70", [[0, 0, 4]])
    post(client, "export", SHAPED | {k: told[k] for k in SHAPED} | {"to": kind})


def test_the_command_line_keeps_what_a_design_holds(tmp_path: Path) -> None:
    document = SHAPED | {"format": "knitcore-design", "version": 2, "note": "Mind the edge."}
    design = tmp_path / "shaped.json"
    design.write_text(json.dumps(document | {"name": "Shaped", "material": "cotton"}))
    out = tmp_path / "again.json"
    run("export", str(design), "--to", "design", "-o", str(out))
    kept = run("import", str(out))
    assert (kept["name"], kept["material"], kept["note"]) == ("Shaped", "cotton", "Mind the edge.")
    assert kept["outline"] == SHAPED["outline"]
    assert kept["regions"][0]["yarn"] == "navy"


def test_an_import_notes_doubtful_readings(tmp_path: Path) -> None:
    cover = {"id": "b", "name": "Cover", "colour": "#ffffff", "runs": [[0, 0, 4]]}
    regions = [*SHAPED["regions"], cover]
    design = tmp_path / "lost.json"
    document = SHAPED | {"format": "knitcore-design", "version": 2, "regions": regions}
    design.write_text(json.dumps(document))
    (note,) = run("import", str(design))["notes"]
    assert "Navy is lost" in note


def test_an_import_tells_what_a_knitout_program_leaves_out(
    client: TestClient, tmp_path: Path
) -> None:
    courses = ["knit - f2 1", "knit - f1 1", "knit + f1 1", "knit + f2 1"]
    program = [";!knitout-2", ";;Machine: SWGXYZ", "x-speed-number 3", "in 1", *courses]
    file = tmp_path / "strange.k"
    file.write_text("\n".join(program), encoding="utf-8-sig")
    content = base64.b64encode(file.read_bytes()).decode()
    told = client.post("/api/v1/import", json={"file": {"name": file.name, "content": content}})
    assert run("import", str(file)) == told.json()
    assert told.json()["chart"] == "KK"
    machine, extension = told.json()["notes"]
    assert "SWGXYZ" in machine
    assert "x-speed-number (1 line from line 3)" in extension


@pytest.mark.parametrize(("name", "says"), [("none.png", "does not exist"), (".", "is a folder")])
def test_a_missing_file_is_reported(name: str, says: str, tmp_path: Path) -> None:
    assert says in refused("import", str(tmp_path / name))


def test_the_schema_is_published(client: TestClient) -> None:
    assert "chart" in client.get("/api/v1/schemas/design").json()["properties"]


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    out = tmp_path / "none" / "chart.png"
    assert "is not a folder" in refused("export", "rib", "--size", "2x2", "--to", "png", "-o", out)
