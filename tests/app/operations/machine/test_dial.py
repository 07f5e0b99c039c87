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
    again = post(client, "dial", REQUEST | {"machine": result["profile"]})
    assert again == result


def test_a_guess_is_called_one(client: TestClient) -> None:
    result = post(client, "dial", REQUEST)
    assert result["guessed"]
    assert "guess" in result["interval_source"]


def test_swatches_of_a_yarn_replace_those_of_before(client: TestClient) -> None:
    first = post(client, "dial", REQUEST | {"swatches": SWATCHES})
    other = REQUEST | {"machine": first["profile"], "material": "cotton"}
    second = post(client, "dial", other | {"swatches": SWATCHES[:1]})
    third = REQUEST | {"machine": second["profile"]}
    assert post(client, "dial", third)["swatches"] == SWATCHES
    corrected = post(client, "dial", third | {"swatches": SWATCHES[1:]})
    assert corrected["swatches"] == SWATCHES[1:]
    assert post(client, "dial", other | {"machine": corrected["profile"]})["swatches"]


def test_the_profile_that_the_command_writes_sets_programs(tmp_path: Path) -> None:
    kept = tmp_path / "wool.json"
    options = ["--loop-length-mm", "10.4", "--material", "glove-wool"]
    swatches = ["--swatch", "5=9.2", "--swatch", "8=12.8", "-o", str(kept)]
    first = run("dial", "--machine", "kniterate", *options, *swatches)
    assert run("dial", "--machine", kept, *options) == first
    assert "stitch number  6" in printed("dial", "--machine", kept, *options).stdout
    rib = ["rib", "--size", "8x4", "--material", "glove-wool", "--machine", str(kept)]
    report = run("program", *rib)
    assert "by your swatches" in report["notes"][0]
    program = tmp_path / "rib.k"
    assert "by your swatches" in run("export", *rib, "--to", "knitout", "-o", program)["notes"][0]
    assert f"x-stitch-number {report['stitch_number']:g}\n" in program.read_text()
    assert "glove-wool: stitch number 6 gives loops" in printed("machines", kept).stdout


@pytest.mark.parametrize("swatch", ["6", "six=ten"])
def test_a_swatch_that_cannot_be_read_is_refused(swatch: str) -> None:
    options = ["--machine", "kniterate", "--loop-length-mm", "10", "--swatch", swatch]
    assert "6=10.4" in refused("dial", *options)
