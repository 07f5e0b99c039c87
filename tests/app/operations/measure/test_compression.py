"""``measure compression`` on the command line and over REST."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from tests.app.command_line import refused, run
from tests.app.rest import upload
from tests.knitcore.measure.test_compression import WORKBOOK, squeeze, write


def test_compression_from_csv(client: TestClient, tmp_path: Path) -> None:
    made = squeeze(1e-3, 2.5)
    path = write(tmp_path / "mine-1.csv", made.depth_mm, made.force_n)
    result = run("measure", "compression", path, "--diameter-mm", "2.0")
    assert result["k_n_per_mm3"] == pytest.approx(1e-3, rel=0.05)
    assert result["p"] == pytest.approx(2.5, rel=0.05)
    body = {"file": upload(path), "diameter_mm": 2.0}
    assert client.post("/api/v1/measure/compression", json=body).json() == result
    assert "steel" in refused("measure", "compression", path, "--yarn", "steel")


def test_a_workbook_of_two_yarns_on_the_command_line() -> None:
    result = run("measure", "compression", WORKBOOK)
    assert result["k_n_per_mm3"] is None  # two yarns have no common mean
    assert "ask for one yarn" in result["notes"][0]
    assert set(result["mean"]) == {"soft", "firm"}
    soft = run("measure", "compression", WORKBOOK, "--yarn", "soft")
    assert soft["k_n_per_mm3"] == pytest.approx(1e-3, rel=0.03)
