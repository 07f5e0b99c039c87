"""``bend`` on the command line and over REST."""

from __future__ import annotations

from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.bend import BendRequest, bend
from tests.app.command_line import run


def test_bend_says_what_the_edges_do(client: TestClient) -> None:
    answer = client.post("/api/v1/bend", json={"chart": "K", "material": "acrylic"})
    assert answer.status_code == 200, answer.text
    bent = answer.json()
    assert bent["moment_course_n"] < 0.0 < bent["moment_wale_n"]
    assert (bent["curl_course"], bent["curl_wale"]) == ("back", "front")
    assert bent["bending_length_course_mm"] is None
    assert "yarn level" in bent["provenance"]


def test_the_bending_length_needs_the_weight_of_the_yarn() -> None:
    request = BendRequest(chart="K", material="acrylic", linear_density_g_per_m=0.3)
    bent = bend(request, Context(Path()))
    assert bent.bending_length_course_mm == pytest.approx(18.0, rel=0.02)


def test_states_that_differ_much_are_noted() -> None:
    bent = bend(BendRequest(chart="P\nK", material="cotton"), Context(Path()))
    assert not bent.stable
    assert any("treat it as a range" in note for note in bent.notes)


def test_a_repeat_too_large_to_bend_is_refused(client: TestClient) -> None:
    chart = "\n".join("K" * row + "P" * (40 - row) for row in range(1, 9))
    answer = client.post("/api/v1/bend", json={"chart": chart, "material": "acrylic"})
    assert answer.status_code == 422
    assert answer.json()["field"] == "chart"


def test_bend_on_the_command_line() -> None:
    bent = run("bend", "garter", "--material", "acrylic")
    assert bent["curl"] == "lies flat"
    assert bent["bending_course_n_mm"] == pytest.approx(0.0055, rel=0.03)
