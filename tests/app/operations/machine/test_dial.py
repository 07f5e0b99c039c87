"""Stitch numbers over REST and on the command line."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import printed, refused, run
from tests.app.rest import post

SWATCHES = [{"number": 5, "loop_length_mm": 9.2}, {"number": 7, "loop_length_mm": 11.6}]
REQUEST = {"machine": "kniterate", "loop_length_mm": 10.4}


def test_swatches_give_the_number(client: TestClient) -> None:
    result = post(client, "dial", REQUEST | {"swatches": SWATCHES})
    assert result["number"] == 6
    assert not result["guessed"]
    assert "2 swatches" in result["interval_source"]


def test_a_guess_is_called_one(client: TestClient) -> None:
    result = post(client, "dial", REQUEST)
    assert result["guessed"]
    assert "guess" in result["interval_source"]


def test_the_command_keeps_swatches_in_a_file(tmp_path: Path) -> None:
    kept = tmp_path / "wool.json"
    options = ["--machine", "kniterate", "--loop-length-mm", "10.4"]
    first = run("dial", *options, "--swatch", "5=9.2", "--swatch", "7=11.6", "-o", str(kept))
    again = run("dial", *options, "--from", str(kept))
    assert again == first
    assert "stitch number  6" in printed("dial", *options, "--from", str(kept)).stdout


@pytest.mark.parametrize("swatch", ["6", "six=ten"])
def test_a_swatch_that_cannot_be_read_is_refused(swatch: str) -> None:
    options = ["--machine", "kniterate", "--loop-length-mm", "10", "--swatch", swatch]
    assert "6=10.4" in refused("dial", *options)
