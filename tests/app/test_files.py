"""Export and import over REST and on the command line."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main
from app.operations.export import MAX_MESH_STITCHES
from knitcore.formats.export import SUFFIXES, ExportKind

CHART = "KPKK\nPPKP\nKKPP"


def run(*arguments: str) -> dict[str, Any]:
    result = CliRunner().invoke(main, [*arguments, "--json"])
    assert result.exit_code == 0, result.output
    answer = json.loads(result.stdout)
    assert isinstance(answer, dict)
    return answer


@pytest.mark.parametrize("kind", list(ExportKind))
def test_export_writes_the_file(kind: ExportKind, tmp_path: Path) -> None:
    out = tmp_path / f"chart{SUFFIXES[kind][0]}"
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
        ExportKind.DESIGN,
    ],
)
def test_what_was_exported_is_imported(
    kind: ExportKind, client: TestClient, tmp_path: Path
) -> None:
    asked = client.post("/api/v1/export", json={"chart": CHART, "to": kind, "name": "A/b"})
    assert asked.status_code == 200, asked.text
    file = asked.json()
    assert file["name"] == "A-b" + SUFFIXES[kind][0]

    upload = {"file": {"name": file["name"], "content": file["content"]}}
    told = client.post("/api/v1/import", json=upload)
    assert told.json()["chart"] == CHART

    path = tmp_path / file["name"]
    path.write_bytes(base64.b64decode(file["content"]))
    assert run("import", str(path)) == told.json()
    if kind is ExportKind.DESIGN:
        assert (told.json()["name"], told.json()["material"]) == ("A/b", "acrylic")


def test_limits_are_told(client: TestClient) -> None:
    side = int(MAX_MESH_STITCHES**0.5) + 1
    chart = {"fabric": "rib", "rows": side, "columns": side}
    refused = client.post("/api/v1/export", json={"chart": chart, "to": "glb"})
    assert refused.status_code == 422
    assert "too many" in refused.json()["detail"]


@pytest.mark.parametrize(
    ("name", "content", "field"),
    [("chart.k", b"knit", "knitout"), ("chart.doc", b"KP", "chart"), ("a.txt", b"KX", "chart")],
)
def test_files_that_hold_no_chart(
    client: TestClient, name: str, content: bytes, field: str
) -> None:
    upload = {"file": {"name": name, "content": base64.b64encode(content).decode()}}
    refused = client.post("/api/v1/import", json=upload)
    assert refused.status_code == 422
    assert refused.json()["field"] == field


def test_the_schema_is_published(client: TestClient) -> None:
    assert "chart" in client.get("/api/v1/schemas/design").json()["properties"]


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    out = tmp_path / "none" / "chart.png"
    result = CliRunner().invoke(
        main, ["export", "rib", "--size", "2x2", "--to", "png", "-o", str(out)]
    )
    assert result.exit_code == 2
    assert "is no folder" in result.stderr
