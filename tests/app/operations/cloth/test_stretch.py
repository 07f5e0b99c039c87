import re
from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.drawing.computed import StretchView
from app.operations.cloth.stretch import StretchRequest, stretch
from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.design_file import DesignFile
from tests.app.command_line import refused, run

GARTER = {"fabric": "garter", "columns": 9, "rows": 6}
ASKED = {"chart": GARTER, "material": "acrylic", "direction": "wale", "strain": 0.4, "steps": 4}


def test_the_service_pulls_a_swatch(client: TestClient) -> None:
    answer = client.post("/api/v1/stretch", json=ASKED).json()
    assert answer["converged"]
    assert answer["strain"] == pytest.approx([0.1, 0.2, 0.3, 0.4])
    assert np.all(np.diff(answer["force_n"]) > 0)
    assert answer["waist_strain"][-1] < 0
    assert (answer["rows"], answer["columns"]) == (6, 9)
    for name in ("strain_course", "strain_wale", "utilisation"):
        assert np.shape(answer["stitch_fields"][name]) == (4, 54)
    assert np.mean(answer["stitch_fields"]["strain_wale"][-1]) == pytest.approx(0.4, rel=0.1)


def test_force_waist_and_stitches_have_intervals(client: TestClient) -> None:
    """Those of a pure fabric's force are as wide as those of its modulus at first; the stiffened
    cloth is known better. No other source of doubt matters as much.
    """
    answer = client.post("/api/v1/stretch", json=ASKED | {"steps": 9}).json()
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


def test_intervals_between_the_computed_steps_are_as_computed(client: TestClient) -> None:
    chart = "\n".join(["KPKPKKKK"] * 4 + ["KKKKPKPK"] * 4)
    many = client.post("/api/v1/stretch", json=ASKED | {"chart": chart, "steps": 20}).json()
    few = client.post("/api/v1/stretch", json=ASKED | {"chart": chart, "steps": 4}).json()
    for name in ("strain_wale_interval", "utilisation_interval"):
        computed, between = (np.ptp(told["stitch_fields"][name], axis=0) for told in (few, many))
        widest = computed.max(axis=1, keepdims=True)
        assert np.all(np.abs(between[4::5] - computed) <= 0.06 * widest)


def test_the_command_line_gives_the_same_curve(client: TestClient, tmp_path: Path) -> None:
    out = tmp_path / "fields.npz"
    arguments = ["garter", "--size", "9x6", "--material", "acrylic", "--direction", "wale"]
    arguments += ["--strain", "0.4", "--steps", "4", "--out", str(out)]
    told = run("stretch", *arguments)
    asked = client.post("/api/v1/stretch", json=ASKED).json()
    for name in ("strain", "force_n", "stress_n_per_mm", "waist_strain", "iterations", "dofs"):
        assert told[name] == pytest.approx(asked[name])
    with np.load(out) as fields:
        assert set(fields) >= {
            *("x_mm", "y_mm", "ux_mm", "uy_mm", "strain_xx", "strain_yy", "strain_xy")
        }
        assert fields["uy_mm"].shape == (4, 13, 19)


def test_beyond_the_lock_up_the_limit_is_named(client: TestClient) -> None:
    problem = client.post("/api/v1/stretch", json=ASKED | {"strain": 2.0}).json()
    assert problem["field"] == "strain"
    assert 0 < problem["most"] < 2
    assert f"Use at most {problem['most']:.3f}." == problem["remedy"]
    arguments = ["stockinette", "--size", "8x8", "--material", "acrylic", "--direction", "wale"]
    result = refused("stretch", *arguments, "--strain", "0.9")
    assert "locks up before that" in result
    assert "Use at most 0.4" in result


def test_a_test_ends_at_the_force_that_was_asked_for(client: TestClient) -> None:
    asked = {field: value for field, value in ASKED.items() if field != "strain"}
    answer = client.post("/api/v1/stretch", json=asked | {"force_n": 1.5}).json()
    assert answer["force_n"][-1] == pytest.approx(1.5, rel=1e-5)
    assert np.diff(answer["strain"], prepend=0) == pytest.approx(answer["strain"][0])
    same = client.post("/api/v1/stretch", json=ASKED | {"strain": answer["strain"][-1]}).json()
    assert same["waist_strain"] == pytest.approx(answer["waist_strain"])


def test_a_force_beyond_the_lock_up_names_the_largest(client: TestClient) -> None:
    asked = {field: value for field, value in ASKED.items() if field != "strain"}
    problem = client.post("/api/v1/stretch", json=asked | {"force_n": 9_999}).json()
    assert problem["field"] == "force_n"
    assert 0 < problem["most"] < 9_999
    most = client.post("/api/v1/stretch", json=asked | {"force_n": problem["most"]}).json()
    assert most["force_n"][-1] == pytest.approx(problem["most"])


def test_the_published_model_warns_beyond_the_lock_up(client: TestClient) -> None:
    body = ASKED | {"model": "published", "strain": 1.5}
    answer = client.post("/api/v1/stretch", json=body).json()
    assert any("the cloth locks at 1" in message for message in answer["messages"])


@pytest.mark.slow
def test_the_full_model_reports_where_its_law_is_extrapolated(client: TestClient) -> None:
    """Stockinette beside rib locks first; pulled on, the force is thousands of newtons."""
    chart = "\n".join(["KP" * 8 + "K" * 16] * 16 + ["K" * 16 + "KP" * 8] * 16)
    body = ASKED | {"chart": chart, "direction": "course", "strain": 1.2, "steps": 12}
    body["laws"] = "published"
    answer = client.post("/api/v1/stretch", json=body).json()
    assert answer["converged"]
    (message,) = answer["messages"]
    found = re.match(r"Beyond a stretch of (\S+) %", message)
    assert found
    assert 70 < float(found[1]) < 120
    assert "extrapolated" in message
    before = client.post("/api/v1/stretch", json=body | {"strain": 0.7, "steps": 7}).json()
    assert before["messages"] == []


def test_a_lock_up_in_part_of_a_quarter_cell_is_reported(client: TestClient) -> None:
    """A piece that hangs on one stitch locks at the neck; the mean of a cell hides that."""
    body = ASKED | {
        "chart": "PPKKPKP\nKKKPPKK\nPKKKPKK",
        "outline": "xxxxxxx\nxxxxxxx\n...x...",
        "strain": 0.95,
        "steps": 8,
    }
    answer = client.post("/api/v1/stretch", json=body).json()
    assert answer["nearest_lock_up"]["utilisation"] < 1.0
    assert "extrapolated" in answer["messages"][0]


@pytest.mark.parametrize("out", ["nowhere/fields.npz", ".", "fields.doc"])
def test_an_unwritable_file_is_refused_before_the_work(tmp_path: Path, out: str) -> None:
    arguments = ["garter", "--size", "9x6", "--material", "acrylic", "--direction", "wale"]
    arguments += ["--strain", "0.2", "--out", str(tmp_path / out), "--json"]
    assert "out" in refused("stretch", *arguments)


def test_a_shaped_piece_is_pulled_without_its_empty_cells(client: TestClient) -> None:
    """Its stitches are those of the narrow rectangle, in whichever chart they stand."""
    shape = {"outline": "\n".join(["..xxxxx.."] * 6)}
    shaped = client.post("/api/v1/stretch", json=ASKED | shape).json()
    narrow = ASKED | {"chart": GARTER | {"columns": 5}}
    alone = client.post("/api/v1/stretch", json=narrow).json()
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


def test_the_command_line_pulls_a_design_in_its_outline(tmp_path: Path) -> None:
    design = DesignFile(
        name="narrow",
        material="acrylic",
        chart=StitchChart.of_fabric("garter", rows=6, columns=9).text,
        outline="\n".join(["..xxxxx.."] * 6),
    )
    file = tmp_path / "narrow.json"
    file.write_text(design.model_dump_json(), encoding="utf-8")
    rest = ["--material", "acrylic", "--direction", "wale", "--strain", "0.4", "--steps", "4"]
    shaped = run("stretch", file, *rest)
    alone = run("stretch", "garter", "--size", "5x6", *rest)
    assert shaped["force_n"] == pytest.approx(alone["force_n"], rel=1e-6)


@pytest.mark.parametrize(("clamps", "uniform"), [("sliding", True), ("clamped", False)])
def test_ends_that_slide_let_a_pure_fabric_narrow_evenly(
    client: TestClient, clamps: str, uniform: bool
) -> None:
    result = client.post("/api/v1/stretch", json=ASKED | {"clamps": clamps}).json()
    across = "strain_course" if ASKED["direction"] == "wale" else "strain_wale"
    last = np.array(result["stitch_fields"][across][-1])
    assert bool(np.ptp(last) < 2e-3) is uniform
