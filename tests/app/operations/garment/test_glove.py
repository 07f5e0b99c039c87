"""The glove on a hand, over REST and on the command line."""

import io
from pathlib import Path
from typing import Any

import pytest
import trimesh
from fastapi.testclient import TestClient

from tests.app.command_line import run
from tests.app.rest import post

ASKED = {"garment": {"template": "glove"}, "material": "glove-wool:glove"}


@pytest.fixture(scope="module")
def told() -> dict[str, Any]:
    return run("glove", "--material", "glove-wool:glove")


@pytest.mark.slow
def test_the_glove_is_worn_and_shown(client: TestClient, told: dict[str, Any]) -> None:
    assert post(client, "glove", ASKED) == told
    design = client.post("/api/v1/garment", json=ASKED).json()
    assert (told["rows"], told["columns"]) == (design["rows"], design["columns"])
    view = {
        "chart": design["chart"],
        "outline": design["outline"],
        "material": "glove-wool:glove",
        "curl": {"id": told["id"]},
        "colour": "pressure",
    }
    solid = client.post("/api/v1/views/solid", json=view)
    assert solid.status_code == 200, solid.text
    size = trimesh.load_mesh(io.BytesIO(solid.content), file_type="glb").extents
    assert size[1] > size[0] > size[2]  # a hand


def test_the_wrist_is_that_of_the_plan(told: dict[str, Any]) -> None:
    (planned,) = run("garment", "glove", "--material", "glove-wool:glove")["worn"]
    wrist = next(part for part in told["parts"] if part["name"] == "wrist support")
    assert wrist["rest_mm"] == pytest.approx(planned["rest_mm"])
    assert wrist["girth_mm"] == planned["worn_mm"]


@pytest.mark.slow
def test_measurements_are_options_and_a_file_is_written(tmp_path: Path) -> None:
    out = tmp_path / "glove.glb"
    small = ("--set", "wrist_circumference_mm=180", "--out", str(out))
    told = run("glove", "--material", "glove-wool:glove", *small)
    wrist = next(part for part in told["parts"] if part["name"] == "wrist support")
    assert wrist["mmhg"][0] > 0.0
    assert out.read_bytes()[:4] == b"glTF"
