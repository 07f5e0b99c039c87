"""Garments over REST and on the command line."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from knitcore.formats.designs.design_file import read_design
from tests.app.command_line import printed, refused, run
from tests.app.rest import post

REQUESTS = (
    {"template": "glove"},
    {"template": "wrist-brace", "wrist_mm": 170, "length_mm": 90},
    {"template": "sock-leg", "ankle_mm": 220, "calf_mm": 360, "length_mm": 200},
    {"template": "limb", "profile": [[0, 180], [200, 260]], "body": "seed"},
    {
        "template": "limb",
        "profile": [[0, 200], [200, 220]],
        "mmhg_profile": [[0, 15], [200, 8]],
        "hem": "stockinette",
    },
)


@pytest.mark.parametrize("garment", REQUESTS, ids=lambda garment: garment["template"])
def test_rest_and_command_line_agree(
    client: TestClient, garment: dict[str, object], tmp_path: Path
) -> None:
    planned = post(client, "garment", {"garment": garment, "material": "glove-wool"})
    out = tmp_path / "garment.json"
    settings = [f"--set={k}={json.dumps(v)}" for k, v in garment.items() if k != "template"]
    words = str(garment["template"]), "--material=glove-wool", *settings, f"-o{out}"
    assert run("garment", *words) == planned
    assert read_design(out).to_piece().shaped.stitches == planned["stitches"]


def test_a_garment_is_kept_as_a_design(client: TestClient) -> None:
    request = {"garment": {"template": "glove"}, "material": "glove-wool", "intarsia": True}
    planned = client.post("/api/v1/garment", json=request).json()
    kept = client.post("/api/v1/designs", json=planned["design"])
    assert kept.status_code == 201, kept.text
    document = kept.json()["document"]
    assert document["regions"] == planned["design"]["regions"]
    assert document["outline"] == planned["outline"]
    wrist = next(r for r in planned["regions"] if r["name"] == "wrist support")
    mm_a_stitch = 11.7  # table 6
    assert wrist["yarn_m"] == pytest.approx(wrist["stitches"] * mm_a_stitch / 1000, rel=0.01)


def test_a_region_stretches_by_hand_as_its_fabric_does(client: TestClient) -> None:
    planned = post(client, "garment", {"garment": {"template": "glove"}, "material": "acrylic"})
    for region in planned["regions"]:
        request = {"chart": region["fill"], "material": "acrylic", "hand": True}
        hand = next(p for p in post(client, "predict", request)["hand"] if p["pull"] == "hand")
        for way in ("course", "wale"):
            assert region["hand"][way]["word"] == hand[way]["word"]
            strain = pytest.approx(hand[way]["strain"])
            assert region["hand"][way]["strain"] == strain


def test_gauge_yarn_and_pressure_of_ones_own(client: TestClient) -> None:
    brace = {"template": "wrist-brace", "wrist_mm": 170, "length_mm": 90, "target_mmhg": 20}
    request = {"garment": brace, "material": "acrylic", "linear_density_tex": 500}
    plain = client.post("/api/v1/garment", json=request).json()
    place = next(place for place in plain["worn"] if place["part"] == "support")
    low, high = place["mmhg"]
    assert low < 22
    assert high > 18
    assert plain["yarn_g"] == pytest.approx(plain["yarn_m"] / 2)
    assert "Yarn: the loop lengths of acrylic." in plain["interval_source"]
    swatch = client.post("/api/v1/garment", json=request | {"yarn_per_stitch_mm": 12.0}).json()
    support = next(r for r in swatch["regions"] if r["name"] == "support")
    assert support["yarn_m"] == pytest.approx(support["stitches"] * 12.0 / 1000, rel=0.02)
    assert np.ptp(swatch["yarn_interval_m"]) < np.ptp(plain["yarn_interval_m"]) * 12.0 / 11.28
    assert "measured in stockinette" in swatch["interval_source"]
    inches = request | {"gauge": {"stitches": 22, "rows": 30, "per": "4 in"}}
    fine = client.post("/api/v1/garment", json=inches).json()
    gauge = next(g for g in fine["gauges"] if g["fabric"] == "stockinette")
    assert gauge["stitches_per_4_in"] == pytest.approx(22)
    assert gauge["rows_per_5_cm"] == pytest.approx(30 * 50 / 101.6)
    sizes = "--set=wrist_mm=170", "--set=length_mm=90", "--set=target_mmhg=20"
    knitter = "--material=acrylic", "--gauge=22x30", "--per=4 in", "--tex=500"
    assert run("garment", "wrist-brace", *sizes, *knitter) == fine


def test_an_outline_is_drawn_and_never_dropped(tmp_path: Path) -> None:
    design, drawing = tmp_path / "glove.json", tmp_path / "glove.svg"
    printed("garment", "glove", "--material=glove-wool", f"-o{design}")
    printed("export", design, "--to", "svg", "-o", drawing)
    assert "no stitch" in drawing.read_text()
    assert "cannot hold an outline" in refused("export", design, "--to", "text", "-o", "x.txt")


def test_sizes_and_yarn_have_intervals_and_a_swatch_narrows_those_of_sizes(
    client: TestClient,
) -> None:
    brace = {"template": "wrist-brace", "wrist_mm": 165.0, "length_mm": 80.0}
    widths = []
    for gauge in (None, {"stitches": 30, "rows": 40, "per": "10 cm"}):
        body = {"garment": brace, "material": "acrylic", "gauge": gauge}
        planned = post(client, "garment", body)
        low, high = planned["yarn_interval_m"]
        assert low < planned["yarn_m"] < high
        plain = next(r for r in planned["regions"] if "P" not in r["fill"])
        low, high = plain["width_interval_mm"]
        assert low < plain["width_mm"] < high
        widths.append(high / low)
        assert "gauge" in planned["interval_source"]
    assert widths[1] < widths[0]


def test_sizes_are_counted_and_the_design_carries_them(client: TestClient) -> None:
    garment = {"template": "limb", "profile": [[0, 180], [200, 260]], "hem_mm": 30}
    request = {"garment": garment, "material": "acrylic"}
    steps = {"wider_percent": 6.0, "longer_percent": 4.0}
    planned = post(client, "garment", request | {"sizes": steps})
    sizes = {size["name"]: size for size in planned["sizes"]}
    assert list(sizes) == ["XS", "S", "as measured", "L", "XL"]
    assert sizes["as measured"]["columns"] == planned["columns"]
    assert sizes["as measured"]["yarn_m"] == planned["yarn_m"]
    large = {"template": "limb", "profile": [[0, 180 * 1.06], [208, 260 * 1.06]], "hem_mm": 30}
    alone = post(client, "garment", {"garment": large, "material": "acrylic"})
    assert (sizes["L"]["columns"], sizes["L"]["rows"]) == (alone["columns"], alone["rows"])
    parts = {part["name"]: part for part in sizes["L"]["parts"]}
    assert parts["body"]["rows"] < sizes["L"]["rows"]
    counts = "; ".join(f"{size['columns']} × {size['rows']}" for size in sizes.values())
    assert f"Whole: {counts}." in planned["design"]["note"]
    words = "limb", "--material=acrylic", "--sizes", "6", "4"
    settings = [f"--set={k}={json.dumps(v)}" for k, v in garment.items() if k != "template"]
    assert run("garment", *words, *settings) == planned


@pytest.mark.parametrize("garment", REQUESTS, ids=lambda garment: garment["template"])
def test_a_larger_body_has_more_stitches_along_and_around(
    client: TestClient, garment: dict[str, object]
) -> None:
    request = {"garment": garment, "material": "acrylic", "sizes": {"longer_percent": 6.0}}
    sizes = post(client, "garment", request)["sizes"]
    for smaller, larger in pairwise(sizes):
        assert smaller["columns"] < larger["columns"]
        assert smaller["rows"] < larger["rows"]
        assert smaller["yarn_m"] < larger["yarn_m"]


def test_a_size_that_cannot_be_planned_is_named(client: TestClient) -> None:
    garment = {"template": "glove", "wrist_circumference_mm": 490}
    request = {"garment": garment, "material": "acrylic", "sizes": {"wider_percent": 20.0}}
    answer = client.post("/api/v1/garment", json=request)
    assert answer.status_code == 422, answer.text
    assert "size XL cannot be planned" in answer.json()["detail"]
