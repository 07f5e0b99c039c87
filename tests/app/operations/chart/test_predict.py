"""The result over REST and on the command line: the same numbers under the same names."""

import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore.materials import material, save_material_file
from tests.app.command_line import run
from tests.app.rest import post, refusal

FIELDS = {
    "rows", "columns", "segments", "provenance", "poisson_yx", "poisson_xy",
    "modulus_course_n_per_mm", "modulus_wale_n_per_mm",
    "modulus_course_interval_n_per_mm", "modulus_wale_interval_n_per_mm",
    "extensibility_course_mm_per_n", "extensibility_wale_mm_per_n",
    "relaxed_course_mm", "relaxed_wale_mm",
    "relaxed_course_interval_mm", "relaxed_wale_interval_mm",
}  # fmt: skip


def test_garter_is_the_papers(client: TestClient) -> None:
    """Table 10: 0.223 and 0.056 N/mm, nu 0.481 and 0.150."""
    published = ("--laws", "published")
    result = run("predict", "garter", "--size", "31x31", "--material", "acrylic", *published)
    assert set(result) >= FIELDS
    assert result["modulus_course_n_per_mm"] == pytest.approx(0.223, rel=0.01)
    assert result["modulus_wale_n_per_mm"] == pytest.approx(0.056, rel=0.01)
    assert result["poisson_yx"] == pytest.approx(0.481, rel=0.01)
    assert result["poisson_xy"] == pytest.approx(0.150, rel=0.01)
    even, odd = {"even": 930, "odd": 0}, {"even": 0, "odd": 930}
    assert result["segments"] == {"course": even, "wale": odd}
    assert result["provenance"] == "measured"

    chart = {"fabric": "garter", "columns": 31, "rows": 31}
    body = {"chart": chart, "material": "acrylic", "laws": "published"}
    assert post(client, "predict", body) == result


def test_the_pull_of_a_hand_is_told_if_asked_for(client: TestClient) -> None:
    body = {"chart": "KKPP", "material": "acrylic"}
    assert post(client, "predict", body)["hand"] == []
    light, hand, firm = post(client, "predict", {**body, "hand": True})["hand"]
    assert (light["pull"], hand["n_per_mm"], firm["pull"]) == ("light", 0.1, "firm")
    low, high = hand["course"]["strain_interval"]
    assert low < hand["course"]["strain"] < high
    assert hand["wale"]["more_than"] == ["stockinette"]
    assert run("predict", "KKPP", "--material", "acrylic", "--hand")["hand"] == [light, hand, firm]


def test_a_chart_file_and_a_material_file_work(tmp_path: Path) -> None:
    chart, yarn = tmp_path / "rib.txt", tmp_path / "mine.json"
    chart.write_text("KPKP\n" * 4)
    save_material_file(material("cotton"), yarn)
    result = run("predict", str(chart), "--material", str(yarn))
    own = run("predict", "rib", "--size", "4x4", "--material", "cotton")
    assert result["modulus_course_n_per_mm"] == pytest.approx(own["modulus_course_n_per_mm"])


def test_a_prediction_is_of_the_largest_rectangle_in_the_outline(
    client: TestClient, tmp_path: Path
) -> None:
    chart, outline = "\n".join(["KKKK"] * 2 + ["PPPP"] * 4), ".xx.\n" * 2 + "xxxx\n" * 4
    body = {"chart": chart, "material": "acrylic", "outline": outline}
    result = client.post("/api/v1/predict", json=body).json()
    assert (result["columns"], result["rows"]) == (4, 4)
    own = run("predict", "stockinette", "--size", "4x4", "--material", "acrylic")
    assert result["modulus_wale_n_per_mm"] == pytest.approx(own["modulus_wale_n_per_mm"])
    assert "4 x 4" in result["notes"][0]
    assert result["height_mm"] > 5 * result["relaxed_wale_mm"]  # of the whole

    file = tmp_path / "shaped.json"
    design = {"format": "knitcore-design", "version": 2, "name": "Shaped", "material": "acrylic"}
    file.write_text(json.dumps(design | {"chart": chart, "outline": outline}))
    assert run("predict", str(file), "--material", "acrylic") == result

    assert refusal(client, "predict", body | {"outline": "xx\nxx"})["field"] == "outline"
