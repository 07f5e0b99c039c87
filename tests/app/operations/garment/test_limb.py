"""A tube along a limb, over REST."""

from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, run
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


@pytest.mark.slow
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


@pytest.mark.slow
def test_a_planned_sleeve_is_worn_with_the_stitches_of_its_rows(
    client: TestClient, tmp_path: Path
) -> None:
    out, solid_of = tmp_path / "sleeve.json", tmp_path / "sleeve.glb"
    profile = "profile=[[0,180],[120,250]]"
    planned = run("garment", "limb", "--material=acrylic", "--set", profile, f"-o{out}")
    request = {name: planned[name] for name in ("chart", "outline")} | {
        "material": "acrylic",
        "girths": [{"at_mm": 0, "girth_mm": 180}, {"at_mm": 120, "girth_mm": 250}],
    }
    worn = post(client, "limb", request)
    girths = "--girth", "0:180", "--girth", "120:250", "--out", str(solid_of)
    as_command = run("limb", str(out), "--material=acrylic", *girths)
    assert as_command["length_mm"] == pytest.approx(worn["length_mm"])
    assert solid_of.read_bytes()[:4] == b"glTF"
    planned_rest = [place["rest_mm"] for place in planned["worn"] if place["part"] == "body"]
    middle = worn["places"][len(worn["places"]) // 2]
    assert min(planned_rest) * 0.9 < middle["rest_mm"] < max(planned_rest) * 1.1
    rectangle = post(client, "limb", request | {"outline": None})
    assert rectangle["places"][0]["rest_mm"] > 1.2 * worn["places"][0]["rest_mm"]
    view = {name: request[name] for name in ("chart", "outline", "material")}
    solid(client, view | {"curl": {"id": worn["id"]}, "colour": "pressure"})


@pytest.mark.slow
def test_the_highest_pressure_is_among_the_places_and_in_the_warning(client: TestClient) -> None:
    bump = [(0, 165), (70, 165), (77, 200), (84, 165), (200, 165)]
    girths = [{"at_mm": at, "girth_mm": girth} for at, girth in bump]
    tall = {"chart": {"fabric": "stockinette", "columns": 40, "rows": 60}, "girths": girths}
    worn = post(client, "limb", TUBE | tall)
    highest = max(place["mmhg"][1] for place in worn["places"] if place["mmhg"])
    assert highest > worn["limit_mmhg"]
    assert f"by up to {highest:.0f} mmHg" in worn["notes"][0]
    locked = [girth | {"girth_mm": 2.5 * girth["girth_mm"]} for girth in girths]
    worn = post(client, "limb", TUBE | tall | {"girths": locked})
    assert "can stretch no further" in worn["notes"][0]
    view = {"chart": tall["chart"], "material": "acrylic", "curl": {"id": worn["id"]}}
    solid(client, view | {"colour": "pressure"})


def test_where_the_tube_is_loose_the_table_says_so() -> None:
    girths = ["--girth", "0:110", "--girth", "15:170"]
    result = printed("limb", "stockinette", "--size", "40x6", "--material", "acrylic", *girths)
    first, *_, last = result.stdout.splitlines()[2:-1]
    assert first.split()[-2] == "loose"
    assert "(" in last
    assert "nearest to its lock-up" in result.stdout
