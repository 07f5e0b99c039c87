"""Export and import over REST and on the command line."""

import base64
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient
from PIL import Image

from knitcore.formats.write.export import FORMATS, ExportKind
from knitcore.machine.profile import profile
from tests.app.command_line import printed, run
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


def test_a_measured_yarn_is_counted_in_the_pattern(client: TestClient) -> None:
    body = {"chart": "\n".join(["KPKPKP"] * 10), "to": "pattern-svg", "linear_density_tex": 500}
    file = post(client, "export", body | {"yarn_per_stitch_mm": 20.0})
    words = "In all 1.2 m (1.16 to 1.25) of yarn, 0.6 g, by the yarn measured in this cloth."
    assert words in base64.b64decode(file["content"]).decode()


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


def test_a_program_is_for_the_machine_of_the_design_or_of_the_command(tmp_path: Path) -> None:
    own = profile("v-bed-half-gauge").to_json()
    out, file = tmp_path / "made.k", tmp_path / "mine.json"
    file.write_text(own.replace('"generic"', '"Mine"'))
    for machine, header in (("kniterate", "Kniterate"), (own, "generic")):
        facts = run("export", saved(tmp_path, machine=machine), "--to", "knitout", "-o", out)
        assert f";;Machine: {header}\n" in out.read_text()
    assert "V-bed at half gauge" in facts["notes"][0]
    design = saved(tmp_path, machine="kniterate")
    run("export", design, "--to", "knitout", "--machine", file, "--stitch-number", "9", "-o", out)
    assert ";;Machine: Mine\n" in out.read_text()
    assert "\nx-stitch-number 9\n" in out.read_text()


def test_a_machine_that_knits_from_no_program_is_refused(client: TestClient) -> None:
    body = {"chart": CHART, "to": "knitout", "machine": "ayab"}
    refusal = client.post("/api/v1/export", json=body)
    assert refusal.status_code == 422
    assert "worked by hand" in refusal.text


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


def _picture(suffix: str) -> bytes:
    """Return a chart of 4 x 3 stitches, each 10 pixels wide and 20 high."""
    tones = np.array([[255, 0, 255, 255], [0, 0, 255, 0], [255, 255, 0, 0]])
    image = Image.fromarray(np.kron(tones, np.ones((20, 10))).astype(np.uint8))
    buffer = io.BytesIO()
    image.save(buffer, format=suffix)
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("name", "content", "options", "chart", "note"),
    [
        ("a.txt", b"- -\n -", {}, "PKP\nKPK", "blank squares are read as knits"),
        ("a.txt", b"\xef\xbb\xbfCO 2\nR1: k 1, p1 (so)", {}, "PK", "Left out as remarks"),
        ("a.txt", b"\x95|\n|\x95", {}, "PK\nKP", "Windows-1252"),
        ("a.txt", "KP\nPK".encode("utf-16"), {}, "KP\nPK", ""),
        ("a.ks", b"1st row k, p.", {}, "PK", "2 stitches are the fewest"),
        ("a.png", _picture("PNG"), {}, CHART, "A grid of 4 x 3 cells is seen"),
        ("a.jpg", _picture("JPEG"), {"columns": 4, "rows": 3}, CHART, "0.50 times"),
        ("a.png", _picture("PNG"), {"columns": 4, "aspect": "as-knitted"}, None, "as knitted"),
    ],
)
def test_readers_tell_what_they_chose_everywhere(
    name: str,
    content: bytes,
    options: dict[str, str | int],
    chart: str | None,
    note: str,
    client: TestClient,
    tmp_path: Path,
) -> None:
    path = tmp_path / name
    path.write_bytes(content)
    sent = {"file": {"name": name, "content": base64.b64encode(content).decode()}, **options}
    answer = post(client, "import", sent)
    given = [part for key, value in options.items() for part in (f"--{key}", str(value))]
    assert run("import", str(path), *given) == answer
    assert chart is None or answer["chart"] == chart
    assert note in " ".join(answer["notes"])
    if not options:
        written = printed("export", str(path), "--to", "text", "-o", str(tmp_path / "out.txt"))
        assert note in written.stderr


def test_a_design_with_a_byte_order_mark_is_read(tmp_path: Path) -> None:
    design = tmp_path / "d.json"
    document = {"format": "knitcore-design", "version": 2, "chart": CHART}
    design.write_text(json.dumps(document), encoding="utf-8-sig")
    assert run("import", str(design))["chart"] == CHART


def test_the_schema_is_published(client: TestClient) -> None:
    assert "chart" in client.get("/api/v1/schemas/design").json()["properties"]
