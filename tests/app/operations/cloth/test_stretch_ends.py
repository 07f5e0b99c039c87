"""How the ends of a stretched swatch are held."""

from __future__ import annotations

import numpy as np
import pytest
from fastapi.testclient import TestClient

from tests.app.operations.cloth.test_stretch import ASKED


@pytest.mark.parametrize(("clamps", "uniform"), [("sliding", True), ("clamped", False)])
def test_ends_that_slide_let_a_pure_fabric_narrow_evenly(
    client: TestClient, clamps: str, uniform: bool
) -> None:
    result = client.post("/api/v1/stretch", json=ASKED | {"clamps": clamps}).json()
    across = "strain_course" if ASKED["direction"] == "wale" else "strain_wale"
    last = np.array(result["stitch_fields"][across][-1])
    assert bool(np.ptp(last) < 2e-3) is uniform
