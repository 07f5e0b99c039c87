"""Fits over REST and on the command line: the same numbers, the same names."""

import base64
import json
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from knitcore.chart.fabric import Direction
from knitcore.formats.read.law_files import load_law
from tests.app.command_line import refused, run
from tests.app.rest import post, refusal, upload
from tests.knitcore.measure.synthetic import LAW, write_csv, write_h5

CONSTANTS = {
    "stiffness_xxxx_n_per_mm", "stiffness_yyyy_n_per_mm", "stiffness_xxyy_n_per_mm",
    "stiffness_yyxx_n_per_mm", "alpha_xx", "alpha_yy", "beta_xx_n_per_mm", "beta_yy_n_per_mm",
}  # fmt: skip


@pytest.fixture
def tests(tmp_path: Path) -> list[Path]:
    return [write_csv(tmp_path / f"{d}.csv", d, noise=0.01) for d in Direction]


@pytest.mark.slow
def test_fit_gives_eight_constants_with_errors(client: TestClient, tests: list[Path]) -> None:
    fitted = run("fit", *tests, "--reduction", "published")
    assert set(fitted) >= CONSTANTS | {"poisson_yx", "poisson_xy", "rms_n_per_mm"}
    assert set(fitted["standard_errors"]) >= CONSTANTS
    assert fitted["stiffness_xxxx_n_per_mm"] == pytest.approx(LAW.stiffness_xxxx, rel=0.1)
    body = {"test_course": upload(tests[0]), "test_wale": upload(tests[1])}
    assert post(client, "fit", body | {"reduction": "published"}) == fitted


@pytest.mark.slow
def test_fit_writes_a_law_and_residuals(tmp_path: Path, tests: list[Path]) -> None:
    law, residuals = tmp_path / "law.json", tmp_path / "residuals.csv"
    fitted = run("fit", *tests, "--out", law, "--residuals", residuals)
    assert load_law(law).law.alpha_xx == fitted["alpha_xx"]
    assert residuals.read_text().startswith("direction,strain_along,strain_across")
    # what --json prints is a law file too
    printed = tmp_path / "printed.json"
    printed.write_text(json.dumps(fitted))
    assert load_law(printed).law == load_law(law).law
    worn = ("--direction", "wale", "--rest-mm", "100", "--worn-mm", "120")
    pressures = [run("pressure", "--law", file, *worn) for file in (law, printed)]
    assert "course.csv" in pressures[0].pop("law_source")
    assert pressures[1].pop("law_source") == ""  # what is printed names no files
    assert pressures[0] == pressures[1]


@pytest.mark.slow
def test_fit_reads_the_authors_layout(tmp_path: Path) -> None:
    files = [write_h5(tmp_path / f"{d}.h5", d) for d in Direction]
    assert run("fit", *files, "--format", "h5")["runs"] == {"course": 4, "wale": 4}


def test_residuals_over_rest_are_bounded(client: TestClient, tests: list[Path]) -> None:
    body = {"test_course": upload(tests[0]), "test_wale": upload(tests[1]), "residuals": True}
    points = post(client, "fit", body | {"reduction": "published"})["residuals"]["course"]
    assert 100 < len(points["strain_along"]) <= 2000
    assert len(points["fitted_n_per_mm"]) == len(points["strain_along"])


def test_bad_tests_end_with_code_2_or_422(client: TestClient, tests: list[Path]) -> None:
    assert "same points" in refused("fit", str(tests[0]), str(tests[0]))
    body = {"test_course": upload(tests[0]), "test_wale": upload(tests[0])}
    problem = refusal(client, "fit", body)
    assert problem["field"] == "test_wale"
    body["test_wale"] = {"name": "../../etc/x.csv", "content": base64.b64encode(b"a,b\n").decode()}
    assert refusal(client, "fit", body)["field"] == "x.csv"
