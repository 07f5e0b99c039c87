"""Pressure over REST and on the command line."""

from dataclasses import asdict

import pytest
from fastapi.testclient import TestClient

from knitcore.chart.fabric import Fabric
from knitcore.materials import material
from tests.app.command_line import run

GLOVE = ("--material", "glove-wool:glove", "--fabric", "stockinette", "--direction", "wale")


def test_pressure_of_a_material(client: TestClient) -> None:
    told = run("pressure", *GLOVE, "--rest-mm", "150", "--worn-mm", "180")
    mmhg, kpa = told["mmhg"], told["kpa"]
    assert isinstance(mmhg, list)
    assert isinstance(kpa, list)
    assert 0 < mmhg[0] < mmhg[1]
    assert mmhg == pytest.approx([7.50062 * end for end in kpa], rel=1e-5)
    assert told["warnings"]
    body = {
        "material": "glove-wool:glove",
        "fabric": "stockinette",
        "direction": "wale",
        "rest_mm": 150,
        "worn_mm": 180,
    }
    assert client.post("/api/v1/pressure", json=body).json() == told
    law = asdict(material("glove-wool:glove").law(Fabric.STOCKINETTE))
    body = {"law": law, "direction": "wale", "rest_mm": 150, "worn_mm": 180}
    assert client.post("/api/v1/pressure", json=body).json()["mmhg"] == mmhg


def test_a_tube_is_sized_for_a_target() -> None:
    told = run("pressure", *GLOVE, "--target-mmhg", "20", "--worn-mm", "180")
    sizes = told["rest_mm_for_target"]
    assert isinstance(sizes, list)
    assert sizes[0] < told["rest_mm"] < sizes[1] < 180
    low, high = told["mmhg"]  # type: ignore[misc]
    assert low < 20 < high
