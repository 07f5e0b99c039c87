"""``hysteresis`` on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed
from tests.app.rest import post


@pytest.mark.slow
def test_a_loop_over_rest(client: TestClient) -> None:
    body = {"chart": "K", "material": "acrylic", "points": 4, "cycles": 1, "rest_sizes": False}
    loop = post(client, "hysteresis", body)
    there, back = loop["legs"]
    assert (there["loading"], back["loading"]) == (True, False)
    assert 0.05 < loop["lost_share"] < 0.5
    assert (loop["friction"], loop["friction_interval"]) == (0.26, [0.13, 0.51])
    assert loop["left_strain"] > 0.0
    low, high = loop["lost_share_interval"]
    assert low < loop["lost_share"] < high
    assert loop["left_strain_interval"][0] < loop["left_strain_interval"][1]


def test_a_given_coefficient_has_no_interval(client: TestClient) -> None:
    body = {"chart": "K", "material": "acrylic", "points": 2, "cycles": 1, "rest_sizes": False}
    loop = client.post("/api/v1/hysteresis", json={**body, "friction": 0.2}).json()
    assert loop["friction"] == 0.2
    assert loop["lost_share_interval"] is None


@pytest.mark.slow
def test_rest_sizes_on_the_command_line() -> None:
    result = printed("hysteresis", "stockinette", "--material", "acrylic", "--points", "6")
    assert "rest, stretched-course" in result.stdout
    assert "lost in a cycle" in result.stdout
