import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.drawing.computed import StretchView
from app.operations.cloth.stretch import StretchRequest, stretch
from tests.app.command_line import refused, run
from tests.app.rest import post, refusal

GARTER = {"fabric": "garter", "columns": 9, "rows": 6}
ASKED = {"chart": GARTER, "material": "acrylic", "direction": "wale", "strain": 0.4, "steps": 4}


def pulled(client: TestClient, **changes: Any) -> Any:
    """The result of a test that is changed so; None leaves a field out."""
    body = {name: value for name, value in (ASKED | changes).items() if value is not None}
    return post(client, "stretch", body)


def test_the_service_pulls_a_swatch(client: TestClient) -> None:
    answer = pulled(client)
    assert answer["converged"]
    assert answer["strain"] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert np.all(np.diff(answer["force_n"]) > 0)
    assert answer["waist_strain"][-1] < 0
    assert (answer["rows"], answer["columns"]) == (6, 9)
    for name in ("strain_course", "strain_wale", "utilisation"):
        assert np.shape(answer["stitch_fields"][name]) == (4, 54)
    assert np.mean(answer["stitch_fields"]["strain_wale"][-1]) == pytest.approx(0.4, rel=0.1)


def test_force_waist_and_stitches_have_intervals(client: TestClient) -> None:
    """At first the intervals of a pure fabric's force are as wide as those of its modulus; the
    stiffened cloth is known better. No other source of doubt matters as much.
    """
    answer = pulled(client, steps=9)
    (low, high), force = np.array(answer["force_interval_n"]), np.array(answer["force_n"])
    assert np.all(low < force)
    assert np.all(force < high)
    modulus = client.post("/api/v1/predict", json={"chart": GARTER, "material": "acrylic"}).json()
    ends = np.array(modulus["modulus_wale_interval_n_per_mm"]) / modulus["modulus_wale_n_per_mm"]
    assert high[0] / force[0] == pytest.approx(ends[1], rel=0.05)
    assert np.all(np.diff(high / force) < 0)
    waist_low, waist_high = np.array(answer["waist_strain_interval"])
    assert np.all((waist_low < answer["waist_strain"]) & (answer["waist_strain"] < waist_high))
    for name in ("strain_wale", "utilisation"):
        ends = np.array(answer["stitch_fields"][f"{name}_interval"])
        assert ends.shape == (2, 9, 54)
        assert ends.mean(axis=0) == pytest.approx(np.array(answer["stitch_fields"][name]), abs=1e-4)
        assert 0 < np.ptp(ends, axis=0)[-1].max() < 0.2
    assert answer["stitch_fields"]["strain_course_interval"] is None


@pytest.mark.slow
def test_intervals_between_the_computed_steps_are_as_computed(client: TestClient) -> None:
    chart = "\n".join(["KPKPKKKK"] * 4 + ["KKKKPKPK"] * 4)
    many, few = (pulled(client, chart=chart, steps=steps) for steps in (20, 4))
    for name in ("strain_wale_interval", "utilisation_interval"):
        computed, between = (np.ptp(test["stitch_fields"][name], axis=0) for test in (few, many))
        widest = computed.max(axis=1, keepdims=True)
        assert np.all(np.abs(between[4::5] - computed) <= 0.06 * widest)


def test_the_command_line_gives_the_same_curve(client: TestClient, tmp_path: Path) -> None:
    out = tmp_path / "fields.npz"
    arguments = ["garter", "--size", "9x6", "--material", "acrylic", "--direction", "wale"]
    arguments += ["--strain", "0.4", "--steps", "4", "--out", str(out)]
    shown, answer = run("stretch", *arguments), pulled(client)
    for name in ("strain", "force_n", "stress_n_per_mm", "waist_strain", "iterations", "dofs"):
        assert shown[name] == pytest.approx(answer[name])
    with np.load(out) as fields:
        names = "x_mm", "y_mm", "ux_mm", "uy_mm", "strain_xx", "strain_yy", "strain_xy"
        assert set(fields) >= set(names)
        assert fields["uy_mm"].shape == (4, 13, 19)


def test_beyond_the_lock_up_the_limit_is_named(client: TestClient) -> None:
    problem = refusal(client, "stretch", ASKED | {"strain": 2.0})
    assert problem["field"] == "strain"
    assert 0 < problem["most"] < 2
    assert f"Use at most {problem['most']:.3f}." == problem["remedy"]
    arguments = ["stockinette", "--size", "8x8", "--material", "acrylic", "--direction", "wale"]
    result = refused("stretch", *arguments, "--strain", "0.9")
    assert "runs out of stretch before that" in result
    assert "Use at most 0.4" in result


def test_a_test_ends_at_the_force_that_was_asked_for(client: TestClient) -> None:
    answer = pulled(client, strain=None, force_n=1.5)
    assert answer["force_n"][-1] == pytest.approx(1.5, rel=1e-5)
    assert np.diff(answer["strain"], prepend=0) == pytest.approx(answer["strain"][0])
    same = pulled(client, strain=answer["strain"][-1])
    assert same["waist_strain"] == pytest.approx(answer["waist_strain"])


def test_a_force_beyond_the_lock_up_names_the_largest(client: TestClient) -> None:
    problem = refusal(client, "stretch", ASKED | {"strain": None, "force_n": 9_999})
    assert problem["field"] == "force_n"
    assert 0 < problem["most"] < 9_999
    largest = pulled(client, strain=None, force_n=problem["most"])
    assert largest["force_n"][-1] == pytest.approx(problem["most"])


def test_the_published_model_warns_beyond_the_lock_up(client: TestClient) -> None:
    messages = pulled(client, model="published", strain=1.5)["messages"]
    assert any("runs out of stretch" in message for message in messages)


@pytest.mark.slow
def test_the_full_model_reports_where_its_law_is_extrapolated(client: TestClient) -> None:
    """Stockinette beside rib locks first; pulled on, the force is thousands of newtons."""
    chart = "\n".join(["KP" * 8 + "K" * 16] * 16 + ["K" * 16 + "KP" * 8] * 16)
    changes = {"chart": chart, "direction": "course", "laws": "published"}
    answer = pulled(client, **changes, strain=1.5, steps=12)
    assert answer["converged"]
    message, beside_the_curve = answer["messages"]
    assert "from the chart's curve" in beside_the_curve
    limit = re.match(r"Do not rely on forces beyond a stretch of (\S+) %", message)
    assert limit
    assert 100 < float(limit[1]) < 140
    assert pulled(client, **changes, strain=0.7, steps=7)["messages"] == [beside_the_curve]


def test_a_lock_up_in_part_of_a_quarter_cell_is_reported(client: TestClient) -> None:
    """A piece that hangs on one stitch locks at the neck; the mean of a cell hides that."""
    chart, outline = "PPKKPKP\nKKKPPKK\nPKKKPKK", "xxxxxxx\nxxxxxxx\n...x..."
    answer = pulled(client, chart=chart, outline=outline, strain=1.0, steps=8)
    assert answer["nearest_lock_up"]["utilisation"] < 1.0
    assert "Do not rely on forces" in answer["messages"][0]


def test_a_shaped_piece_is_pulled_without_its_empty_cells(client: TestClient) -> None:
    """Its stitches are those of the narrow rectangle, in whichever chart they stand."""
    shaped = pulled(client, outline="\n".join(["..xxxxx.."] * 6))
    alone = pulled(client, chart=GARTER | {"columns": 5})
    assert shaped["id"] != alone["id"]
    assert shaped["force_n"] == pytest.approx(alone["force_n"], rel=1e-6)
    assert shaped["waist_strain"] == pytest.approx(alone["waist_strain"], abs=1e-6)
    used = [answer["nearest_lock_up"]["utilisation"] for answer in (shaped, alone)]
    assert used[0] == pytest.approx(used[1], abs=1e-6)
    for name in ("strain_course", "strain_wale", "utilisation"):
        there = np.reshape(shaped["stitch_fields"][name], (4, 6, 9))
        assert there[:, :, 2:7].reshape(4, 30) == pytest.approx(
            np.array(alone["stitch_fields"][name]), abs=2e-4
        )
        assert not there[:, :, :2].any()
        assert not there[:, :, 7:].any()


def test_positions_go_on_smoothly_where_a_shaped_piece_has_no_stitch() -> None:
    request = StretchRequest.model_validate(
        ASKED | {"outline": "\n".join(["xxxxxxxxx"] * 2 + ["...xxx..."] * 2 + ["xxxxxxxxx"] * 2)}
    )
    view = stretch(request, Context(Path())).view
    assert isinstance(view, StretchView)
    assert np.isfinite(view.positions_mm).all()
    across = np.diff(view.positions_mm[-1, :, :, 0], axis=1)
    assert across.min() > 0.5 * across.max()


@pytest.mark.parametrize(("clamps", "uniform"), [("sliding", True), ("clamped", False)])
def test_ends_that_slide_let_a_pure_fabric_narrow_evenly(
    client: TestClient, clamps: str, uniform: bool
) -> None:
    across = pulled(client, clamps=clamps)["stitch_fields"]["strain_course"]
    assert bool(np.ptp(across[-1]) < 2e-3) is uniform


@pytest.mark.slow
def test_a_chart_of_any_size_is_pulled_in_blocks_and_says_so(client: TestClient) -> None:
    chart = "\n".join(
        "".join("KP"[(row // 4 + k // 4) % 2] for k in range(210)) for row in range(200)
    )
    answer = pulled(client, chart=chart, strain=0.1, steps=1)
    assert answer["block"] == 3
    for values in answer["stitch_fields"].values():
        assert values is None or np.shape(values)[-1] == 67 * 70
    assert answer["messages"][-2].endswith("3 × 3 stitches count as one.")
    assert answer["messages"][-1].endswith("which the intervals allow for.")
    assert "what blocks of stitches leave out" in answer["interval_source"]
    assert refusal(client, "stretch", ASKED | {"chart": chart, "block": 1})["field"] == "block"


def test_blocks_give_nearly_the_same_and_the_view_has_all_stitches(client: TestClient) -> None:
    chart = "\n".join(["KPKPKPKPKKKKKKKKK"] * 9 + ["K" * 17, "P" * 17] * 5)
    exact, blurred = (pulled(client, chart=chart, block=block) for block in (None, 2))
    assert (exact["block"], blurred["block"]) == (1, 2)
    assert blurred["force_n"] == pytest.approx(exact["force_n"], rel=0.1)
    assert blurred["waist_strain"] == pytest.approx(exact["waist_strain"], abs=0.02)
    request = StretchRequest.model_validate(ASKED | {"chart": chart, "block": 2})
    view = stretch(request, Context(Path())).view
    assert isinstance(view, StretchView)
    assert view.positions_mm.shape == (4, 19, 17, 2)
    assert view.strain.shape == (4, 19, 17, 2)
    assert view.utilisation.shape == (4, 19, 17)
    assert np.all(np.diff(view.positions_mm[-1, ..., 1], axis=0) > 0)
    assert np.all(np.diff(view.positions_mm[-1, ..., 0], axis=1) > 0)
    arguments = ["KPKP/PKPK", "--size", "16x16", "--material", "acrylic", "--direction", "wale"]
    shown = run("stretch", *arguments, "--strain", "0.1", "--steps", "1", "--block", "4")
    assert shown["block"] == 4
