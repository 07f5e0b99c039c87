"""Atlas and search over REST and on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient

from app.cli.main import main
from app.operations.atlas import repeats_of

WISH = {"quantity": "modulus_course_n_per_mm", "value": 0.223, "tolerance": 0.05, "weight": 1.0}


def test_rest_and_command_line_find_the_same(client: TestClient, tmp_path: Path) -> None:
    request = {"materials": ["acrylic"], "targets": [WISH], "count": 3}
    asked = client.post("/api/v1/find", json=request)
    assert asked.status_code == 200, asked.text
    assert asked.json()["reached"]
    assert asked.json()["candidates"][0]["chart"] in ("K\nP", "P\nK")
    assert asked.json()["searched"] == len(repeats_of("small"))

    file = tmp_path / "acrylic.npz"
    build = ["atlas", "--material", "acrylic", "--repeats", "small", "-o", str(file), "--json"]
    built = CliRunner().invoke(main, build)
    assert built.exit_code == 0, built.output
    assert len(json.loads(built.stdout)["repeats"]) == len(repeats_of("small"))

    find = ["find", "--atlas", str(file), "--target", "course=0.223~5%*1", "--count=3", "--json"]
    told = CliRunner().invoke(main, find)
    assert told.exit_code == 0, told.output
    assert json.loads(told.stdout) == asked.json()

    columns = client.post("/api/v1/atlas", json={"material": "acrylic"}).json()
    assert columns == json.loads(built.stdout)


@pytest.mark.parametrize("target", ["course", "course=x", "colour=1", "course=0.1~%"])
def test_targets_that_cannot_be_read(target: str, tmp_path: Path) -> None:
    refused = CliRunner().invoke(main, ["find", "--atlas", "none.npz", "--target", target])
    assert refused.exit_code == 2


def test_there_must_be_something_to_search() -> None:
    refused = CliRunner().invoke(main, ["find", "--target", "course=0.1"])
    assert refused.exit_code == 2
    assert "nothing to search" in refused.stderr
