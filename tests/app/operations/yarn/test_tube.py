"""``tube``: a repeat in the round, on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, run
from tests.app.rest import post


def test_a_tube_is_the_same_over_rest_and_on_the_command_line(client: TestClient) -> None:
    tube = post(client, "tube", {"chart": "K", "material": "cotton", "wales": 60})
    shown = run("tube", "stockinette", "--material", "cotton", "--wales", 60)
    assert shown["diameter_mm"] == pytest.approx(tube["diameter_mm"], rel=1e-9)
    low, high = tube["diameter_interval_mm"]
    assert low < tube["diameter_mm"] < high
    assert tube["energy_n_mm"] < tube["flat_energy_n_mm"]  # it curls that way by itself
    assert tube["notes"] == []  # it is a minimum without mirrors


def test_the_command_compares_the_tube_with_flat_fabric() -> None:
    words = ["tube", "stockinette", "--material", "cotton", "--wales", "60", "--no-face-outside"]
    shown = printed(*words).stdout
    assert "its back outside" in shown
    assert "against flat" in shown


@pytest.mark.slow
def test_a_tube_says_that_its_mirrored_shape_is_no_minimum() -> None:
    tube = run("tube", "rib", "--material", "acrylic", "--wales", 96)
    (note,) = tube["notes"]
    assert "mirrored shape" in note
    assert "has 0.1775 N·mm a stitch, with them 0.1825." in note
