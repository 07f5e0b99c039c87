"""The result over REST and on the command line: the same numbers under the same names."""

import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore.materials import material, save_material_file
from tests.app.command_line import printed, refused, run
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


@pytest.mark.slow
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


LACE = {
    "rows": [
        [["K"]] * 4,
        [["K", 3], ["K", 2], ["K"], ["K", 1, 0]],
        [["K", i] for i in (3, 2, 1, 0)],
    ]
}


def test_lace_is_predicted_from_a_file_standard_input_a_repeat_and_rest(
    client: TestClient, tmp_path: Path
) -> None:
    file = tmp_path / "lace.stitches.json"
    file.write_text(json.dumps(LACE))
    result = run("predict", str(file), "--material", "acrylic")
    assert (result["rows"], result["columns"]) == (2, 4)
    assert result["provenance"] == "learned with other stitches"
    assert (
        result["relaxed_course_mm"]
        > run("predict", "K", "--material", "acrylic")["relaxed_course_mm"]
    )
    assert result["other_stitches"]["yarn_overs"] == pytest.approx(1 / 8)
    repeat = "KKKK;/OKK"
    assert run("predict", repeat, "--material", "acrylic") == result
    assert post(client, "predict", {"chart": repeat, "material": "acrylic"}) == result
    curve = run("curve", str(file), "--material", "acrylic", "--direction", "course")
    assert curve["provenance"] == result["provenance"]


def test_knits_and_purls_with_parents_are_a_chart_everywhere(tmp_path: Path) -> None:
    file = tmp_path / "seed.stitches.json"
    rows = [[["K"], ["K"]], [["P", 1], ["K", 0]], [["P", 1], ["K", 0]]]
    file.write_text(json.dumps({"rows": rows}))
    seed = run("predict", "KP/PK", "--material", "acrylic")
    assert run("predict", str(file), "--material", "acrylic") == seed
    assert run("rs", "--material", "acrylic")
    assert run("curl", str(file), "--material", "acrylic")["converged"]


def test_other_commands_name_the_stitches_that_they_refuse(tmp_path: Path) -> None:
    file = tmp_path / "lace.stitches.json"
    file.write_text(json.dumps(LACE))
    words = refused("curl", file, "--material", "acrylic")
    assert "yarn over and knit 2 together" in words
    assert "predict" in words


@pytest.mark.parametrize("chart", ["O/K;KKO", "VK;VK", "[2/2R]K;KKKK"])
def test_a_row_that_does_not_balance_is_refused(client: TestClient, chart: str) -> None:
    problem = refusal(client, "predict", {"chart": chart, "material": "acrylic"})
    assert problem["field"] == "chart"
    assert "row 1" in problem["detail"]


def test_the_yarn_of_a_stitch_is_given_if_it_is_known(client: TestClient) -> None:
    knit, slipped = (
        post(client, "predict", {"chart": chart, "material": "acrylic"}) for chart in ("K", "VK;KK")
    )
    low, high = knit["yarn_per_stitch_interval_mm"]
    assert low < knit["yarn_per_stitch_mm"] < high
    assert slipped["yarn_per_stitch_mm"] < knit["yarn_per_stitch_mm"]
    assert knit["other_stitches"] is None
    others = slipped["other_stitches"]
    assert others["longest_float_mm"] == pytest.approx(2 * slipped["relaxed_course_mm"])
    assert others["longest_float_interval_mm"] == pytest.approx(
        [2 * end for end in slipped["relaxed_course_interval_mm"]]
    )
    assert others["yarn_m"] == pytest.approx(4 * slipped["yarn_per_stitch_mm"] / 1000)
    low, high = others["yarn_interval_m"]
    assert low < others["yarn_m"] < high


def test_yarn_and_floats_of_other_stitches_are_printed() -> None:
    shown = printed("predict", "VK;KK", "--material", "acrylic").output
    assert "floats up to" in shown
    assert "yarn of all" in shown
    assert "floats" not in printed("predict", "KK;O/", "--material", "acrylic").output


def test_what_would_narrow_an_interval_does_so_over_rest(client: TestClient) -> None:
    body = {"chart": "KKPP", "material": "acrylic", "hand": True}
    first = post(client, "predict", body)
    narrowing = {(n["quantity"], n["n_per_mm"]): n for n in first["narrowing"]}
    stretch = narrowing["strain_course", 0.1]
    assert stretch["act"] == "count"
    assert next(iter(stretch["shares"])) == "size at rest"
    assert stretch["now"] == first["hand"][1]["course"]["strain_interval"]
    gauge = {
        "stitches_per_10_cm": 100 / first["relaxed_course_mm"],
        "rows_per_10_cm": 100 / first["relaxed_wale_mm"],
    }
    counted = post(client, "predict", {**body, "gauge": gauge})
    assert counted["hand"][1]["course"]["strain_interval"] == pytest.approx(stretch["left"])
    shares = post(client, "curve", {**body_of(body), "stress_n_per_mm": [0.1]})["shares"]
    for part, share in stretch["shares"].items():
        assert shares[part] == pytest.approx([share])


def body_of(body: dict[str, object]) -> dict[str, object]:
    """The same chart, pulled along its rows."""
    return {name: body[name] for name in ("chart", "material")} | {"direction": "course"}
