"""``tube``: a repeat in the round, on the command line and over REST."""

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, run
from tests.app.rest import post


def test_a_tube_is_the_same_over_rest_and_on_the_command_line(client: TestClient) -> None:
    found = post(client, "tube", {"chart": "K", "material": "cotton", "wales": 60})
    told = run("tube", "stockinette", "--material", "cotton", "--wales", 60)
    assert told["diameter_mm"] == pytest.approx(found["diameter_mm"], rel=1e-9)
    low, high = found["diameter_interval_mm"]
    assert low < found["diameter_mm"] < high
    assert found["energy_n_mm"] < found["flat_energy_n_mm"]  # it curls that way by itself
    assert found["notes"] == []  # it is a minimum without mirrors


def test_the_command_compares_the_tube_with_flat_fabric() -> None:
    asked = ["tube", "stockinette", "--material", "cotton", "--wales", "60", "--no-face-outside"]
    told = printed(*asked)
    assert "its back outside" in told.stdout
    assert "against flat" in told.stdout


def test_a_tube_says_that_its_mirrored_shape_is_no_minimum() -> None:
    told = run("tube", "rib", "--material", "acrylic", "--wales", 96)
    (note,) = told["notes"]
    assert "mirrored shape" in note
    assert "has 0.1775 N·mm a stitch, with them 0.1825." in note
