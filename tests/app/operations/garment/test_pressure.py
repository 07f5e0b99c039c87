"""Pressure over REST and on the command line."""

from dataclasses import asdict

import pytest
from fastapi.testclient import TestClient

from knitcore.chart.fabric import Fabric
from knitcore.materials import material
from tests.app.command_line import run
from tests.app.rest import post

GLOVE = ("--material", "glove-wool:glove", "--fabric", "stockinette", "--direction", "wale")


def test_pressure_of_a_material(client: TestClient) -> None:
    result = run("pressure", *GLOVE, "--rest-mm", "150", "--worn-mm", "180")
    mmhg = result["mmhg"]
    assert 0 < mmhg[0] < mmhg[1]
    assert mmhg == pytest.approx([7.50062 * end for end in result["kpa"]], rel=1e-5)
    assert result["warnings"]
    worn = {"direction": "wale", "rest_mm": 150, "worn_mm": 180}
    glove = {"material": "glove-wool:glove", "fabric": "stockinette"}
    assert post(client, "pressure", worn | glove) == result
    law = asdict(material("glove-wool:glove").law(Fabric.STOCKINETTE))
    assert post(client, "pressure", worn | {"law": law})["mmhg"] == mmhg


def test_a_tube_is_sized_for_a_target() -> None:
    result = run("pressure", *GLOVE, "--target-mmhg", "20", "--worn-mm", "180")
    sizes = result["rest_mm_for_target"]
    assert sizes[0] < result["rest_mm"] < sizes[1] < 180
    low, high = result["mmhg"]
    assert low < 20 < high
