"""``measure swatch`` on the command line and over REST, and what a yarn serves for."""

import json
from dataclasses import asdict
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore.chart.fabric import Fabric
from knitcore.materials import load_material_file, material
from tests.app.command_line import run
from tests.app.rest import post, refusal

GAUGE = {"fabric": "stockinette", "stitches_per_10_cm": 20, "rows_per_10_cm": 28}
POINT = {
    "fabric": "stockinette", "direction": "wale", "force_n_per_mm": 0.1, "strain_along": 0.2,
    "strain_along_sd": 0.004, "strain_across": -0.1, "strain_across_sd": 0.004,
}  # fmt: skip


def test_a_swatch_gives_a_yarn_and_says_what_each_measurement_brought(
    client: TestClient, tmp_path: Path
) -> None:
    points, out = tmp_path / "points.json", tmp_path / "my yarn.json"
    points.write_text(json.dumps([POINT]))
    options = [f"--{name.replace('_', '-')}={value}" for name, value in GAUGE.items()]
    made = run(
        "measure", "swatch", *options, "--tex", "400", "--ten-stitches-mm", "150",
        "--fibre", "wool", "--points", points, "--out", out,
    )  # fmt: skip
    body = GAUGE | {"tex": 400, "ten_stitches_mm": 150, "fibre": "wool", "points": [POINT]}
    assert post(client, "measure/swatch", body) == made
    names = [step["name"] for step in made["steps"]]
    assert names[0] == "library"
    assert names[-1] == "photos, pulled wale-wise"
    stretch = made["steps"][-1]["strain_at_0_1_n_per_mm"]["wale"]
    assert stretch["value_interval"][0] < 0.2 < stretch["value_interval"][1]
    assert stretch["value"] == pytest.approx(0.2, rel=0.05)
    assert made["uses"][0]["serves"] == "roughly"
    kept = load_material_file(out)
    assert kept.is_complete
    assert kept.yarn.fibre == "wool"


@pytest.mark.slow
def test_a_law_of_one_fabric_gives_the_others(client: TestClient) -> None:
    law = material("cotton").law(Fabric.STOCKINETTE)
    made = post(client, "measure/swatch", GAUGE | {"law": asdict(law)})
    assert made["steps"][-1]["name"] == "tests, pulled wale-wise"
    assert set(made["material"]["fabrics"]) == {fabric.value for fabric in Fabric}


def test_contradictions_are_refused(client: TestClient) -> None:
    answer = refusal(client, "measure/swatch", GAUGE | {"ten_stitches_mm": 12})
    assert answer["field"] == "ten_stitches_mm"


def test_a_yarn_says_what_is_missing_before_it_is_kept(client: TestClient) -> None:
    document = client.get("/api/v1/materials/acrylic/document").json()
    whole = post(client, "measure/uses", {"material": document})["uses"]
    assert {use["serves"] for use in whole} == {"yes"}
    alone = document | {"fabrics": {"rib": document["fabrics"]["rib"]}}
    charts, *_ = post(client, "measure/uses", {"material": alone})["uses"]
    assert charts["serves"] == "no"
    assert "stockinette, garter, seed" in charts["missing"]
