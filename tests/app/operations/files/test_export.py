"""Export and import over REST and on the command line."""

import base64
import json
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from knitcore.formats.write.export import FORMATS, ExportKind
from tests.app.command_line import run
from tests.app.rest import post, upload

CHART = "KPKK\nPPKP\nKKPP"
KEEPING_OUTLINES = (ExportKind.KNITOUT, ExportKind.PNG, ExportKind.WRITTEN, ExportKind.DESIGN)


@pytest.mark.parametrize("kind", list(ExportKind))
def test_export_writes_the_file(kind: ExportKind, tmp_path: Path) -> None:
    out = tmp_path / f"chart{FORMATS[kind].suffix}"
    facts = run("export", "garter", "--size", "6x4", "--to", kind.value, "-o", str(out))
    assert facts["bytes"] == out.stat().st_size
    assert (facts["columns"], facts["rows"]) == (6, 4)
    assert facts["transfers"] == (18 if kind is ExportKind.KNITOUT else None)


def import_(client: TestClient, file: dict[str, str]) -> Any:
    return post(client, "import", {"file": {key: file[key] for key in ("name", "content")}})


@pytest.mark.parametrize("kind", [*KEEPING_OUTLINES, ExportKind.TEXT, ExportKind.KNITSPEAK])
def test_an_exported_file_is_imported(kind: ExportKind, client: TestClient, tmp_path: Path) -> None:
    file = post(client, "export", {"chart": CHART, "to": kind, "name": "A/b"})
    assert file["name"] == "A-b" + FORMATS[kind].suffix

    imported = import_(client, file)
    assert imported["chart"] == CHART
    path = tmp_path / file["name"]
    path.write_bytes(base64.b64decode(file["content"]))
    assert run("import", path) == imported
    if kind is ExportKind.DESIGN:
        assert (imported["name"], imported["material"]) == ("A/b", "acrylic")


SHAPED = {
    "chart": CHART,
    "outline": "xx..\nxxxx\nxxxx",
    "regions": [
        {"id": "a", "name": "Navy", "colour": "#1f3b70", "yarn": "navy", "runs": [[0, 0, 4]]}
    ],
}


@pytest.mark.parametrize("kind", KEEPING_OUTLINES)
def test_outlines_and_yarns_go_there_and_back(kind: ExportKind, client: TestClient) -> None:
    file = post(client, "export", SHAPED | {"to": kind, "linear_density_tex": 400})
    assert file["carriers"] == (2 if kind is ExportKind.KNITOUT else None)
    imported = import_(client, file)
    assert imported["outline"] == SHAPED["outline"]
    (region,) = imported["regions"]
    assert (region["yarn"], region["colour"], region["runs"]) == ("navy", "#1f3b70", [[0, 0, 4]])
    post(client, "export", SHAPED | {k: imported[k] for k in SHAPED} | {"to": kind})


def saved(folder: Path, **changes: object) -> Path:
    """The file of a design that is changed so."""
    design = folder / "shaped.json"
    design.write_text(json.dumps(SHAPED | {"format": "knitcore-design", "version": 2} | changes))
    return design


def test_the_command_line_keeps_what_a_design_holds(tmp_path: Path) -> None:
    more = {"note": "Mind the edge.", "name": "Shaped", "material": "cotton"}
    design, out = saved(tmp_path, **more), tmp_path / "again.json"
    run("export", design, "--to", "design", "-o", out)
    kept = run("import", out)
    assert (kept["name"], kept["material"], kept["note"]) == ("Shaped", "cotton", "Mind the edge.")
    assert kept["outline"] == SHAPED["outline"]
    assert kept["regions"][0]["yarn"] == "navy"


def test_an_import_notes_doubtful_readings(tmp_path: Path) -> None:
    cover = {"id": "b", "name": "Cover", "colour": "#ffffff", "runs": [[0, 0, 4]]}
    (note,) = run("import", saved(tmp_path, regions=[*SHAPED["regions"], cover]))["notes"]
    assert "Navy is lost" in note


def test_an_import_tells_what_a_knitout_program_leaves_out(
    client: TestClient, tmp_path: Path
) -> None:
    courses = ["knit - f2 1", "knit - f1 1", "knit + f1 1", "knit + f2 1"]
    program = [";!knitout-2", ";;Machine: SWGXYZ", "x-speed-number 3", "in 1", *courses]
    file = tmp_path / "strange.k"
    file.write_text("\n".join(program), encoding="utf-8-sig")
    imported = import_(client, upload(file))
    assert run("import", file) == imported
    assert imported["chart"] == "KK"
    machine, extension = imported["notes"]
    assert "SWGXYZ" in machine
    assert "x-speed-number (1 line from line 3)" in extension


def test_the_schema_is_published(client: TestClient) -> None:
    assert "chart" in client.get("/api/v1/schemas/design").json()["properties"]
