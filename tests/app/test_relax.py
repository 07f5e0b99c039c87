"""``relax`` and ``sweep`` on the command line and over REST."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main
from tests.app.command_line import run

FIELDS = {
    "cell_course_mm", "cell_wale_mm", "energy_n_mm", "bending_share", "contact_share",
    "yarn_length_mm", "seconds", "evaluations", "converged",
}  # fmt: skip


def test_relax_on_the_command_line_and_over_rest_agree(client: TestClient) -> None:
    told = run("relax", "stockinette", "--size", "4x4", "--material", "cotton")
    assert set(told) >= FIELDS
    assert told["converged"]
    assert told["energy_n_mm"] == pytest.approx(0.387, rel=5e-3)
    chart = {"fabric": "stockinette", "columns": 4, "rows": 4}
    body = {"chart": chart, "material": "cotton", "centre_lines": True}
    answer = client.post("/api/v1/relax", json=body).json()
    assert answer["cell_course_mm"] == pytest.approx(told["cell_course_mm"])
    assert len(answer["centre_lines_mm"]) == 1


def test_a_shape_that_only_its_mirrors_hold_says_so() -> None:
    garter = run("relax", "garter", "--size", "2x2", "--material", "cotton")
    assert not garter["unmirrored"]["minimum"]
    assert garter["unmirrored"]["energy_n_mm"] < 0.995 * garter["energy_n_mm"]
    assert any("only among mirrored ones" in note for note in garter["notes"])
    stockinette = run("relax", "stockinette", "--size", "2x2", "--material", "acrylic")
    assert stockinette["unmirrored"]["minimum"]
    held = run(
        "relax", "stockinette", "--size", "2x2", "--material", "acrylic", "--cell-course-mm", "3"
    )
    assert held["unmirrored"] is None


def test_relax_in_the_published_branch() -> None:
    told = run(
        "relax", "stockinette", "--size", "2x2", "--material", "cotton", "--branch", "published"
    )
    assert told["branch"] == "published"
    assert told["energy_n_mm"] == pytest.approx(0.401, rel=0.03)


def test_the_published_branch_refuses_mixed_charts(client: TestClient) -> None:
    body = {"chart": "KKP", "material": "cotton", "branch": "published"}
    answer = client.post("/api/v1/relax", json=body)
    assert answer.status_code == 422
    assert "four pure fabrics" in answer.text


def test_a_loop_that_is_too_short_is_refused_with_a_bound() -> None:
    arguments = ["relax", "rib", "--size", "2x2", "--material", "acrylic"]
    result = CliRunner().invoke(main, [*arguments, "--loop-length-mm", "5"])
    assert result.exit_code == 2
    assert "too short" in result.stderr
    assert "at least" in result.stderr


def test_loop_lengths_give_the_same_on_the_command_line_and_over_rest(client: TestClient) -> None:
    told = run(
        "relax", "stockinette", "--size", "1x2", "--material", "cotton",
        "--loop-lengths-mm", "14.5/15.5",
    )  # fmt: skip
    assert told["repeat_rows"] == 2
    assert told["yarn_length_mm"] == pytest.approx(15.0, abs=0.01)
    assert told["force_course_n"] == pytest.approx(0.0, abs=1e-5)
    body = {
        "chart": {"fabric": "stockinette", "columns": 1, "rows": 2},
        "material": "cotton",
        "loop_lengths_mm": [[14.5], [15.5]],
    }
    assert client.post("/api/v1/relax", json=body).json()["energy_n_mm"] == told["energy_n_mm"]
    wide = client.post(
        "/api/v1/relax", json={"chart": "K", "material": "cotton", "cell_course_mm": 3.5}
    )
    assert wide.json()["cell_course_mm"] == pytest.approx(3.5)
    assert wide.json()["force_course_n"] > 0.0


@pytest.mark.parametrize(
    ("asked", "field"),
    [
        ({"loop_lengths_mm": [[15.0]] * 3}, "loop_lengths_mm"),
        ({"loop_lengths_mm": [[15.0, 15.0], [15.0]]}, "loop_lengths_mm"),
        ({"loop_lengths_mm": [[15.0], [15.0]], "loop_length_mm": 15.0}, "loop_lengths_mm"),
        ({"loop_lengths_mm": []}, "loop_lengths_mm"),
        ({"branch": "published", "flat": True}, "branch"),
        ({"cell_wale_mm": 90.0}, "cell_wale_mm"),
    ],
)
def test_an_impossible_held_size_is_refused(
    client: TestClient, asked: dict[str, Any], field: str
) -> None:
    chart = {"fabric": "stockinette", "columns": 1, "rows": 2}
    answer = client.post("/api/v1/relax", json={"chart": chart, "material": "cotton"} | asked)
    assert answer.status_code == 422
    assert answer.json()["field"] == field


def test_sweep_on_the_command_line_and_over_rest_agree(client: TestClient) -> None:
    told = run(
        "sweep", "stockinette", "--size", "2x2", "--material", "cotton", "--direction", "course",
        "--max-strain", "0.2", "--points", "5",
    )  # fmt: skip
    assert told["strain"] == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])
    assert len(told["stress_n_per_mm"]) == len(told["transverse_strain"]) == 5
    assert told["law"]["modulus_course_n_per_mm"] == pytest.approx(0.298, rel=0.2)
    body = {
        "chart": "K", "material": "cotton", "direction": "course", "max_strain": 0.2, "points": 5,
    }  # fmt: skip
    answer = client.post("/api/v1/sweep", json=body).json()
    assert answer["stress_n_per_mm"] == pytest.approx(told["stress_n_per_mm"], rel=1e-6, abs=1e-6)
    held = client.post("/api/v1/sweep", json=body | {"slide_quenching": True}).json()
    assert held["stress_n_per_mm"][-1] >= answer["stress_n_per_mm"][-1]
    assert any("Slide quenching" in note for note in held["notes"])


def test_the_gauge_of_a_relaxation_makes_predictions_of_a_simulated_material_more_certain(
    client: TestClient,
) -> None:
    """The prediction names the repeat; measured materials and held shapes have no such gauge."""
    body = {"chart": "KKP\nPKP\nKPP\nKKP\nPKP\nKPP", "material": "acrylic:simulation"}
    learned = client.post("/api/v1/predict", json=body).json()
    asked = {"chart": learned["worth_relaxing"], "material": body["material"]}
    assert asked["chart"] == "KKP\nPKP\nKPP"
    gauge = client.post("/api/v1/relax", json=asked).json()["gauge"]
    known = client.post("/api/v1/predict", json=body | {"gauge": gauge}).json()
    assert known["relaxed_source"] == gauge["known_by"] == "relaxation"
    assert known["relaxed_course_mm"] == pytest.approx(100 / gauge["stitches_per_10_cm"])
    assert known["worth_relaxing"] is None
    widths = [
        high / low
        for low, high in (a["modulus_course_interval_n_per_mm"] for a in (learned, known))
    ]
    assert widths[1] < widths[0]
    # kept results of the same yarn are found again, but the gauge is the material's
    assert (
        client.post("/api/v1/relax", json=asked | {"material": "acrylic"}).json()["gauge"] is None
    )
    for held in ({"flat": True}, {"loop_length_mm": 13.0}, {"cell_course_mm": 3.4}):
        assert client.post("/api/v1/relax", json=asked | held).json()["gauge"] is None


def test_relax_prints_the_options_that_predict_takes(tmp_path: Path) -> None:
    chart = tmp_path / "chart.txt"
    chart.write_text("KKP\nPKP\nKPP\n")
    asked = [str(chart), "--material", "acrylic:simulation"]
    told = CliRunner().invoke(main, ["relax", *asked]).output
    options = next(line for line in told.splitlines() if line.startswith("for predict")).split()[2:]
    assert run("predict", *asked, *options)["relaxed_source"] == "relaxation"
