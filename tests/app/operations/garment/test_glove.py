"""The glove on a hand, over REST and on the command line."""

from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import run
from tests.app.rest import post, solid

ASKED = {"garment": {"template": "glove"}, "material": "glove-wool:glove"}


@pytest.fixture(scope="module")
def worn() -> dict[str, Any]:
    return run("glove", "--material", "glove-wool:glove")


@pytest.mark.slow
def test_the_glove_is_worn_and_shown(client: TestClient, worn: dict[str, Any]) -> None:
    assert post(client, "glove", ASKED) == worn
    design = post(client, "garment", ASKED)
    assert (worn["rows"], worn["columns"]) == (design["rows"], design["columns"])
    view = {name: design[name] for name in ("chart", "outline")} | {
        "material": "glove-wool:glove", "curl": {"id": worn["id"]}, "colour": "pressure",
    }  # fmt: skip
    size = solid(client, view).extents
    assert size[1] > size[0] > size[2]  # a hand


def wrist_of(worn: dict[str, Any]) -> Any:
    return next(part for part in worn["parts"] if part["name"] == "wrist support")


def test_the_wrist_is_that_of_the_plan(worn: dict[str, Any]) -> None:
    plan = run("garment", "glove", "--material", "glove-wool:glove")
    planned = next(place for place in plan["worn"] if place["part"] == "wrist support")
    wrist = wrist_of(worn)
    assert wrist["rest_mm"] == pytest.approx(planned["rest_mm"])
    assert wrist["girth_mm"] == planned["worn_mm"]


def test_parts_that_press_too_hard_are_named() -> None:
    tight = run("glove", "--material", "glove-wool:glove", "--set", "ease=-0.3")["notes"][0]
    assert tight.startswith("Too tight: ")
    assert "index finger" in tight
    assert "stop the blood" in tight


@pytest.mark.slow
def test_measurements_are_options_and_a_file_is_written(tmp_path: Path) -> None:
    out = tmp_path / "glove.glb"
    small = ("--set", "wrist_circumference_mm=220", "--out", str(out))
    assert wrist_of(run("glove", "--material", "glove-wool:glove", *small))["mmhg"][0] > 0.0
    assert out.read_bytes()[:4] == b"glTF"
