"""``relax`` on the command line and over REST."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.operations.yarn.relax import RelaxRequest
from knitcore import StitchChart, relax
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.solve.splines import RelaxedRepeat, size_intervals
from tests.app.command_line import printed, refused, run
from tests.app.rest import post
from tests.knitcore.refusals import refuses

FIELDS = {
    "cell_course_mm", "cell_wale_mm", "energy_n_mm", "bending_share", "contact_share",
    "yarn_length_mm", "seconds", "evaluations", "converged",
}  # fmt: skip


@pytest.mark.slow
def test_relax_on_the_command_line_and_over_rest_agree(client: TestClient) -> None:
    shape = run("relax", "stockinette", "--size", "4x4", "--material", "cotton")
    assert set(shape) >= FIELDS
    assert shape["converged"]
    assert shape["energy_n_mm"] == pytest.approx(0.387, rel=5e-3)
    chart = {"fabric": "stockinette", "columns": 4, "rows": 4}
    answer = post(client, "relax", {"chart": chart, "material": "cotton", "centre_lines": True})
    assert answer["cell_course_mm"] == pytest.approx(shape["cell_course_mm"])
    assert len(answer["centre_lines_mm"]) == 1


def test_a_shape_that_only_its_mirrors_hold_says_so() -> None:
    words = "relax", "garter", "--size", "2x2", "--material", "cotton"
    garter = run(*words, "--branch", "mirrored")
    assert garter["minimum"] is False
    assert garter["mirrored"] is None
    assert garter["unmirrored"]["energy_n_mm"] < 0.995 * garter["energy_n_mm"]
    assert any("only among mirrored ones" in note for note in garter["notes"])
    lowest = run(*words)
    assert (lowest["branch"], lowest["minimum"]) == ("free", True)
    assert lowest["energy_n_mm"] == pytest.approx(garter["unmirrored"]["energy_n_mm"])
    assert lowest["mirrored"]["energy_n_mm"] == pytest.approx(garter["energy_n_mm"])
    low, high = (
        math.log(shape["cell_wale_interval_mm"][1] / shape["cell_wale_mm"])
        for shape in (garter, lowest)
    )
    assert high > 1.5 * low  # such shapes are farther from cloth


def test_a_shape_that_needs_no_mirrors_says_so() -> None:
    words = "relax", "stockinette", "--size", "2x2", "--material", "acrylic"
    for shape in (run(*words), run(*words, "--branch", "mirrored")):
        assert shape["branch"] == "mirrored"
        assert shape["minimum"]
        assert shape["mirrored"] is shape["unmirrored"] is None
    assert run(*words, "--cell-course-mm", "3")["minimum"] is None


def test_intervals_cover_other_minima_that_are_as_low() -> None:
    entry = sample("acrylic", "stockinette")
    cell = relax(StitchChart.parse("K"), entry.yarn, entry.loop_length_mm)
    assert isinstance(cell, RelaxedRepeat)
    course, wale = size_intervals(cell)
    other = replace(cell, other_minima_mm=((2.0 * cell.cell_course_mm, cell.cell_wale_mm),))
    wider, same = size_intervals(other)
    assert (wider.low, wider.high) == pytest.approx((course.low, 2.0 * course.high))
    assert same == wale


def test_relax_in_the_published_branch() -> None:
    shape = run("relax", "stockinette", "--material", "cotton", "--branch", "published")
    assert shape["branch"] == "published"
    assert shape["energy_n_mm"] == pytest.approx(0.401, rel=0.03)


def test_a_loop_that_is_too_short_is_refused_with_a_bound() -> None:
    words = refused("relax", "rib", "--material", "acrylic", "--loop-length-mm", "5")
    assert "too short" in words
    assert "at least" in words


def test_loop_lengths_give_the_same_on_the_command_line_and_over_rest(client: TestClient) -> None:
    shape = run(
        "relax", "stockinette", "--size", "1x2", "--material", "cotton",
        "--loop-lengths-mm", "14.5/15.5",
    )  # fmt: skip
    assert shape["repeat_rows"] == 2
    assert shape["yarn_length_mm"] == pytest.approx(15.0, abs=0.01)
    assert shape["force_course_n"] == pytest.approx(0.0, abs=1e-5)
    chart = {"fabric": "stockinette", "columns": 1, "rows": 2}
    body = {"chart": chart, "material": "cotton", "loop_lengths_mm": [[14.5], [15.5]]}
    assert post(client, "relax", body)["energy_n_mm"] == shape["energy_n_mm"]
    wide = post(client, "relax", {"chart": "K", "material": "cotton", "cell_course_mm": 3.5})
    assert wide["cell_course_mm"] == pytest.approx(3.5)
    assert wide["force_course_n"] > 0.0


def test_rows_with_changes_take_more_yarn_if_that_is_chosen(tmp_path: Path) -> None:
    context = Context(tmp_path)
    request = RelaxRequest(chart="KP\nKK", material="cotton", yarn_per_stitch=True)
    given = request.with_row_lengths(context)
    (plain,), (changing,) = given.loop_lengths_mm or []
    assert changing / plain == pytest.approx((17.94 + 17.32) / (12.28 + 16.05), rel=1e-6)
    used = request.yarn(request.repeat(), context)
    assert (plain + changing) / 2 == pytest.approx(used.loop_length_mm)
    even = RelaxRequest(chart="KP", material="cotton", yarn_per_stitch=True)
    assert even.with_row_lengths(context).loop_lengths_mm is None
    with refuses("loop_lengths_mm", "yarn_per_stitch"):
        given.model_copy(update={"yarn_per_stitch": True}).check_parts(context)


@pytest.mark.slow
def test_the_gauge_of_a_relaxation_makes_predictions_of_a_simulated_material_more_certain(
    client: TestClient, tmp_path: Path
) -> None:
    """The prediction names the repeat; measured materials and held shapes have no such gauge."""
    repeat = "KKPKP\nKPPKK"
    body = {"chart": f"{repeat}\n{repeat}", "material": "acrylic:simulation"}
    learned = post(client, "predict", body)
    assert learned["worth_relaxing"] == repeat
    single = body | {"chart": repeat}
    gauge = post(client, "relax", single)["gauge"]
    known = post(client, "predict", body | {"gauge": gauge})
    assert known["relaxed_source"] == gauge["known_by"] == "relaxation"
    assert known["relaxed_course_mm"] == pytest.approx(100 / gauge["stitches_per_10_cm"])
    assert known["worth_relaxing"] is None
    ends = (answer["modulus_course_interval_n_per_mm"] for answer in (learned, known))
    widths = [high / low for low, high in ends]
    assert widths[1] < widths[0]
    # kept results of the same yarn are found again, but the gauge is the material's
    assert post(client, "relax", single | {"material": "acrylic"})["gauge"] is None
    for held in ({"flat": True}, {"loop_length_mm": 13.0}, {"cell_course_mm": 3.4}):
        assert post(client, "relax", body | {"chart": "KKP"} | held)["gauge"] is None
    # the command line, which finds the result as well, prints the options that predict takes
    chart = tmp_path / "chart.txt"
    chart.write_text(repeat)
    words = [str(chart), "--material", "acrylic:simulation"]
    lines = printed("relax", *words).output.splitlines()
    options = next(line for line in lines if line.startswith("for predict")).split()[2:]
    assert run("predict", *words, *options)["relaxed_source"] == "relaxation"


ACRYLIC = ("--material", "acrylic")


@pytest.mark.slow
def test_a_fabric_rests_at_the_sizes_that_hysteresis_gives(client: TestClient) -> None:
    """Without a coefficient of its own the request has that of the yarn."""
    shape = run("relax", "stockinette", *ACRYLIC, "--history", "stretched-course")
    assert set(shape) >= FIELDS
    assert (shape["friction"], shape["history"]) == (0.26, "stretched-course")
    assert shape["converged"]
    assert shape["force_course_n"] == pytest.approx(0.0, abs=1e-5)
    assert shape["unmirrored"] is shape["gauge"] is None
    sizes = {rest["history"]: rest["course_mm"] for rest in shape["rest_sizes"]}
    assert shape["cell_course_mm"] == sizes["stretched-course"]
    low, high = shape["cell_course_interval_mm"]
    assert low * high == pytest.approx(shape["cell_course_mm"] ** 2)
    assert sizes["as-knitted"] < sizes["agitated"] < sizes["stretched-course"]
    body = {"chart": "K", "material": "acrylic", "points": 2, "cycles": 1, "intervals": False}
    loop = client.post("/api/v1/hysteresis", json=body).json()
    by_loop = {rest["history"]: rest["course_mm"] for rest in loop["rest_sizes"]}
    assert by_loop == pytest.approx(sizes, rel=1e-9)
    plain = run("relax", "stockinette", *ACRYLIC)
    assert plain["cell_course_mm"] == pytest.approx(sizes["agitated"], rel=1e-9)
    assert plain["friction"] is plain["history"] is plain["rest_sizes"] is None


@pytest.mark.slow
def test_a_coefficient_alone_means_as_knitted(client: TestClient) -> None:
    body = {"chart": "K", "material": "acrylic", "friction": 0.4, "centre_lines": True}
    shape = client.post("/api/v1/relax", json=body).json()
    assert (shape["friction"], shape["history"]) == (0.4, "as-knitted")
    assert shape["cell_wale_mm"] > 1.004 * shape["rest_sizes"][0]["wale_mm"]
    assert len(shape["centre_lines_mm"]) == 1
    assert "Coefficient of friction 0.4: as given." in shape["notes"]
    again = "--friction", "0.4", "--centre-lines"  # known from storage
    output = printed("relax", "stockinette", *ACRYLIC, *again).output
    assert "stored result" in output
    (here,) = (line for line in output.splitlines() if line.endswith(", here"))
    assert here.startswith("rest, as-knitted")
