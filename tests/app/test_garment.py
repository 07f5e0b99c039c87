"""Garments over REST and on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main
from knitcore.formats.design import read_design

REQUESTS = (
    {"template": "glove"},
    {"template": "wrist-brace", "wrist_mm": 170, "length_mm": 90},
    {"template": "sock-leg", "ankle_mm": 220, "calf_mm": 360, "length_mm": 200},
    {"template": "limb", "profile": [[0, 180], [200, 260]], "body": "seed"},
)


@pytest.mark.parametrize("garment", REQUESTS, ids=lambda garment: garment["template"])
def test_rest_and_command_line_agree(
    client: TestClient, garment: dict[str, object], tmp_path: Path
) -> None:
    asked = client.post("/api/v1/garment", json={"garment": garment, "material": "glove-wool"})
    assert asked.status_code == 200, asked.text
    out = tmp_path / "garment.json"
    settings = [f"--set={k}={json.dumps(v)}" for k, v in garment.items() if k != "template"]
    told = CliRunner().invoke(
        main,
        [
            "garment",
            str(garment["template"]),
            "--material=glove-wool",
            *settings,
            f"-o{out}",
            "--json",
        ],
    )
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout) == asked.json()
    assert read_design(out).to_piece().shaped.stitches == asked.json()["stitches"]


def test_an_outline_is_drawn_and_never_dropped(tmp_path: Path) -> None:
    design, drawing = tmp_path / "glove.json", tmp_path / "glove.svg"
    make = ["garment", "glove", "--material=glove-wool", f"-o{design}"]
    assert CliRunner().invoke(main, make).exit_code == 0
    export = ["export", str(design), "--to", "svg", "-o", str(drawing)]
    assert CliRunner().invoke(main, export).exit_code == 0
    assert "no stitch" in drawing.read_text()
    refused = CliRunner().invoke(main, ["export", str(design), "--to", "text", "-o", "x.txt"])
    assert refused.exit_code == 2
    assert "cannot hold a chart with an outline" in refused.stderr


def test_a_missing_measurement_is_named(client: TestClient) -> None:
    garment = {"template": "wrist-brace", "wrist_mm": 170}
    refused = client.post("/api/v1/garment", json={"garment": garment, "material": "acrylic"})
    assert refused.status_code == 422
    assert "length_mm" in refused.json()["detail"]
