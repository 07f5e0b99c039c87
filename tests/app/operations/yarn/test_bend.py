"""``bend`` on the command line and over REST."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.yarn.bend import BendRequest, BendResult, bend
from knitcore.base.errors import ConvergenceError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials import material
from knitcore.yarn.library.yarns import yarn_for
from tests.app.command_line import run
from tests.app.rest import post


def bent_in(material: str, chart: str, **more: float | None) -> BendResult:
    return bend(BendRequest(chart=chart, material=material, **more), Context(Path()))


def test_bend_says_what_the_edges_do(client: TestClient) -> None:
    bent = post(client, "bend", {"chart": "K", "material": "acrylic"})
    assert bent["moment_course_n"] < 0.0 < bent["moment_wale_n"]
    assert (bent["curl_course"], bent["curl_wale"]) == ("back", "front")
    assert bent["bending_length_course_mm"] is None
    assert "yarn level" in bent["provenance"]


def test_the_bending_length_needs_the_weight_of_the_yarn() -> None:
    bent = bent_in("acrylic", "K", linear_density_g_per_m=0.3)
    assert bent.bending_length_course_mm == pytest.approx(18.0, rel=0.02)


@pytest.mark.parametrize(
    ("material", "chart", "stable", "says"),
    [
        ("acrylic", "K\nP\nP\nK", False, "not quite a minimum"),
        ("cotton", "P\nK", False, "treat it as a range"),
        ("acrylic", "P\nK", True, "along a diagonal"),
    ],
)
def test_a_note_says_how_far_a_stiffness_is_known(
    material: str, chart: str, stable: bool, says: str
) -> None:
    bent = bent_in(material, chart)
    assert bent.stable is stable
    assert any(says in note for note in bent.notes)


def test_twist_is_left_out_where_the_mirrored_state_is_no_minimum() -> None:
    assert bent_in("acrylic", "K\nP\nP\nK").twist_n_mm is None


@pytest.mark.slow
def test_packaged_repeats_are_bent_from_the_store(monkeypatch: pytest.MonkeyPatch) -> None:
    length_mm = yarn_for(material("acrylic"), StitchChart.parse("PPK")).loop_length_mm
    near = bent_in("acrylic", "PPK", loop_length_mm=1.0001 * length_mm)
    assert "stored" not in near.provenance
    monkeypatch.setattr("app.operations.yarn.bend.relax", None)
    stored = bent_in("acrylic", "PPK")
    assert "stored" in stored.provenance
    assert stored.curl_course == near.curl_course == "front"
    assert stored.bending_course_n_mm == pytest.approx(near.bending_course_n_mm, rel=0.01)
    assert stored.moment_wale_n == pytest.approx(near.moment_wale_n, rel=0.01)
    assert stored.thickness_mm == pytest.approx(near.thickness_mm, rel=0.01)
    assert stored.notes[0] == near.notes[0]


def test_a_repeat_that_folds_by_itself_is_refused() -> None:
    with pytest.raises(ConvergenceError, match="folds spontaneously"):
        bent_in("acrylic", "KP\nKK")


def test_bend_on_the_command_line() -> None:
    bent = run("bend", "garter", "--material", "acrylic")
    assert bent["curl"] == "lies flat"
    assert bent["bending_course_n_mm"] == pytest.approx(0.0055, rel=0.03)
