"""The prediction over REST and on the command line: the same numbers under the same names."""

import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore import Fabric
from knitcore.materials import load_library
from tests.app.command_line import run
from tests.app.rest import refusal

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
    told = run("predict", "garter", "--size", "31x31", "--material", "acrylic", *published)
    assert set(told) >= FIELDS
    assert told["modulus_course_n_per_mm"] == pytest.approx(0.223, rel=0.01)
    assert told["modulus_wale_n_per_mm"] == pytest.approx(0.056, rel=0.01)
    assert told["poisson_yx"] == pytest.approx(0.481, rel=0.01)
    assert told["poisson_xy"] == pytest.approx(0.150, rel=0.01)
    assert told["segments"] == {"course": {"even": 930, "odd": 0}, "wale": {"even": 0, "odd": 930}}
    assert told["provenance"] == "measured"

    chart = {"fabric": "garter", "columns": 31, "rows": 31}
    asked = client.post(
        "/api/v1/predict", json={"chart": chart, "material": "acrylic", "laws": "published"}
    )
    assert asked.json() == told


@pytest.mark.parametrize("material", list(load_library()))
@pytest.mark.parametrize("fabric", list(Fabric))
def test_every_pure_fabric_has_its_table_values(material: str, fabric: Fabric) -> None:
    told = run("predict", fabric, "--size", "31x31", "--material", material, "--laws", "published")
    printed = load_library()[material].record(fabric).printed
    for name, direction in (("Y_x", "course"), ("Y_y", "wale")):
        modulus = told[f"modulus_{direction}_n_per_mm"]
        assert isinstance(modulus, float)
        assert modulus == pytest.approx(printed[name].corrected, rel=0.01)
        assert told[f"extensibility_{direction}_mm_per_n"] == pytest.approx(1 / modulus)


def test_a_chart_file_and_a_material_file_work(tmp_path: Path) -> None:
    from knitcore.materials import material
    from knitcore.materials.material_files import save_material_file

    chart, yarn = tmp_path / "rib.txt", tmp_path / "mine.json"
    chart.write_text("KPKP\n" * 4)
    save_material_file(material("cotton"), yarn)
    told = run("predict", str(chart), "--material", str(yarn))
    own = run("predict", "rib", "--size", "4x4", "--material", "cotton")
    assert told["modulus_course_n_per_mm"] == pytest.approx(own["modulus_course_n_per_mm"])


def test_a_prediction_is_of_the_largest_rectangle_in_the_outline(
    client: TestClient, tmp_path: Path
) -> None:
    chart, outline = "\n".join(["KKKK"] * 2 + ["PPPP"] * 4), ".xx.\n" * 2 + "xxxx\n" * 4
    asked = {"chart": chart, "material": "acrylic", "outline": outline}
    told = client.post("/api/v1/predict", json=asked).json()
    assert (told["columns"], told["rows"]) == (4, 4)
    own = run("predict", "stockinette", "--size", "4x4", "--material", "acrylic")
    assert told["modulus_wale_n_per_mm"] == pytest.approx(own["modulus_wale_n_per_mm"])
    assert "4 x 4" in told["notes"][0]
    assert told["height_mm"] > 5 * told["relaxed_wale_mm"]  # of the whole

    file = tmp_path / "shaped.json"
    design = {"format": "knitcore-design", "version": 2, "name": "Shaped", "material": "acrylic"}
    file.write_text(json.dumps(design | {"chart": chart, "outline": outline}))
    assert run("predict", str(file), "--material", "acrylic") == told

    assert refusal(client, "predict", asked | {"outline": "xx\nxx"})["field"] == "outline"


def test_a_small_mixed_repeat_is_labelled_with_care(client: TestClient) -> None:
    rows = "\n".join(["KKPP" * 5] * 10)
    told = client.post("/api/v1/predict", json={"chart": rows, "material": "acrylic"}).json()
    assert told["provenance"] == "learned"
