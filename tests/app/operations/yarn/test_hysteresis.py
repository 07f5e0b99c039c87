"""``hysteresis`` on the command line and over REST."""

from __future__ import annotations

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main


def test_a_loop_over_rest(client: TestClient) -> None:
    asked = {"chart": "K", "material": "acrylic", "points": 4, "cycles": 1, "rest_sizes": False}
    answer = client.post("/api/v1/hysteresis", json=asked)
    assert answer.status_code == 200, answer.text
    loop = answer.json()
    there, back = loop["legs"]
    assert (there["loading"], back["loading"]) == (True, False)
    assert 0.05 < loop["lost_share"] < 0.5
    assert (loop["friction"], loop["friction_interval"]) == (0.26, [0.13, 0.51])
    assert loop["left_strain"] > 0.0
    low, high = loop["lost_share_interval"]
    assert low < loop["lost_share"] < high
    assert loop["left_strain_interval"][0] < loop["left_strain_interval"][1]


def test_a_given_coefficient_has_no_interval(client: TestClient) -> None:
    asked = {"chart": "K", "material": "acrylic", "points": 2, "cycles": 1, "rest_sizes": False}
    loop = client.post("/api/v1/hysteresis", json={**asked, "friction": 0.2}).json()
    assert loop["friction"] == 0.2
    assert loop["lost_share_interval"] is None


@pytest.mark.parametrize(
    ("wrong", "field"), [({"friction": 3.0}, "friction"), ({"cycles": 9}, "cycles")]
)
def test_what_is_out_of_range_is_refused(client: TestClient, wrong: dict, field: str) -> None:
    answer = client.post("/api/v1/hysteresis", json={"chart": "K", "material": "acrylic", **wrong})
    assert answer.status_code == 422
    assert answer.json()["field"] == field


@pytest.mark.slow
def test_rest_sizes_on_the_command_line() -> None:
    asked = ["hysteresis", "stockinette", "--material", "acrylic", "--points", "6"]
    result = CliRunner().invoke(main, asked)
    assert result.exit_code == 0, result.stderr
    assert "rest, stretched-course" in result.stdout
    assert "lost in a cycle" in result.stdout
