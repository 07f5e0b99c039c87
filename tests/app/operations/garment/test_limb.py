"""A tube along a limb, over REST."""

from pathlib import Path

import numpy as np
from fastapi.testclient import TestClient

from tests.app.command_line import printed
from tests.app.rest import post, solid

CONE = [
    {"at_mm": 0, "girth_mm": 140, "rest_mm": 150},
    {"at_mm": 200, "girth_mm": 220, "rest_mm": 170},
]


def test_limb_over_rest(client: TestClient) -> None:
    sleeve = post(client, "limb", {"chart": "KP", "material": "acrylic", "girths": CONE})
    assert sleeve["tightest_mm"] == 200.0
    assert 0.0 < sleeve["loose_mm"] < 200.0
    first, last = sleeve["places"][0], sleeve["places"][-1]
    assert first["mmhg"] is None
    assert last["mmhg_with_spread"][0] <= last["mmhg"][0] < last["mmhg"][1]


TUBE = {
    "chart": {"fabric": "stockinette", "columns": 40, "rows": 6},
    "material": "acrylic",
    "girths": [{"at_mm": 0, "girth_mm": 165}, {"at_mm": 20, "girth_mm": 200}],
}


def test_the_answer_says_where_the_pressure_of_a_hem_steps(client: TestClient) -> None:
    hem = {"chart": "\n".join(["K" * 20] * 12 + ["KP" * 10] * 12)}
    plain, hemmed = (post(client, "limb", TUBE | more)["notes"] for more in ({}, hem))
    assert not any("hem" in note for note in plain)
    assert any("at a hem" in note for note in hemmed)


def test_a_whole_chart_is_worn_and_shown(client: TestClient) -> None:
    sleeve = post(client, "limb", TUBE)
    assert len(sleeve["places"]) == 6
    assert sleeve["length_mm"] < sleeve["relaxed_length_mm"]
    view = {"chart": TUBE["chart"], "material": "acrylic", "curl": {"id": sleeve["id"]}}
    worn = solid(client, view | {"colour": "pressure"})
    around = 1000 * worn.extents[[0, 2]]
    assert (around > 165 / np.pi).all()
    colours = {tuple(colour) for colour in worn.visual.vertex_colors}
    assert len(colours) == 6 + 1  # of the rows, and of the limb


def test_limb_at_the_command_line(tmp_path: Path) -> None:
    out = tmp_path / "sleeve.glb"
    arguments = ["limb", "stockinette", "--size", "40x4", "--material", "acrylic"]
    result = printed(*arguments, "--girth", "0:165", "--girth", "20:200", "--out", out)
    assert "nearest to its lock-up" in result.stdout
    assert out.stat().st_size > 1000


def test_where_the_tube_is_loose_the_table_says_so() -> None:
    girths = ["--girth", "0:110", "--girth", "15:170"]
    result = printed("limb", "stockinette", "--size", "40x6", "--material", "acrylic", *girths)
    first, *_, last = result.stdout.splitlines()[2:-1]
    assert first.split()[-2] == "loose"
    assert "(" in last
