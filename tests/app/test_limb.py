"""A tube along a limb, over REST."""

from __future__ import annotations

from fastapi.testclient import TestClient

CONE = [
    {"at_mm": 0, "girth_mm": 140, "rest_mm": 150},
    {"at_mm": 200, "girth_mm": 220, "rest_mm": 170},
]


def test_limb_over_rest(client: TestClient) -> None:
    body = {"chart": "KP", "material": "acrylic", "girths": CONE}
    answer = client.post("/api/v1/limb", json=body)
    assert answer.status_code == 200, answer.text
    told = answer.json()
    assert told["tightest_mm"] == 200.0
    assert 0.0 < told["loose_mm"] < 200.0
    first, last = told["places"][0], told["places"][-1]
    assert first["mmhg"] is None
    assert last["mmhg_with_spread"][0] <= last["mmhg"][0] < last["mmhg"][1]


def test_places_that_do_not_increase_are_refused(client: TestClient) -> None:
    body = {"chart": "KP", "material": "acrylic", "girths": CONE[::-1]}
    answer = client.post("/api/v1/limb", json=body)
    assert answer.status_code == 422
    assert answer.json()["field"] == "girths"
