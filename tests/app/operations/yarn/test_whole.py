"""``whole``: a chart relaxed as a whole, which goes on where it was stopped."""

import re
from pathlib import Path
from typing import Any

import pytest

from app.context import Context
from app.operations.yarn.whole import WholeRequest, whole
from knitcore.base.errors import CancelledError, InputError
from knitcore.yarn.study.whole_chart import MAX_STITCHES_WHOLE
from tests.app.command_line import run

REQUEST = WholeRequest(chart="K", material="acrylic", tolerance=0.1)
LACE = REQUEST.model_copy(update={"chart": "KKKK\nKO/K"})


def test_a_stopped_job_goes_on_where_it_was(tmp_path: Path) -> None:
    shares: list[float] = []

    def note(done: float, total: float) -> None:
        shares.append(done / total)

    stopping = Context(tmp_path, progress=note, cancelled=lambda: max(shares, default=0.0) > 0.5)
    with pytest.raises(CancelledError):
        whole(REQUEST, stopping)
    reached = len(shares)
    relaxed = whole(REQUEST, Context(tmp_path, progress=note))
    assert min(shares[reached:], default=1.0) >= shares[reached - 1]
    assert relaxed.converged
    assert re.fullmatch(r"Continued after \d rounds of an earlier run\.", relaxed.notes[1])
    assert len(whole(REQUEST, Context(tmp_path / "fresh")).notes) == 1
    assert relaxed.energy_n_mm == pytest.approx(0.2386, rel=5e-3)
    assert relaxed.rows == relaxed.columns == 1


@pytest.mark.slow
def test_rows_of_a_whole_chart_may_differ_in_yarn(tmp_path: Path) -> None:
    request = REQUEST.model_copy(update={"chart": "KP\nKK", "rounds": 2, "yarn_per_stitch": True})
    by_rule = whole(request, Context(tmp_path))
    alike = whole(request.model_copy(update={"yarn_per_stitch": False}), Context(tmp_path))
    assert by_rule.energy_n_mm != pytest.approx(alike.energy_n_mm, rel=1e-3)


@pytest.mark.slow
def test_a_whole_chart_on_the_command_line(tmp_path: Path) -> None:
    chart = tmp_path / "chart.txt"
    chart.write_text("KKKK\nKKPK\nKKKK\nKKKK\n")
    shown = run("whole", chart, "--material", "acrylic", "--tolerance", 0.01)
    assert shown["converged"]
    assert shown["cell_course_interval_mm"][0] < shown["cell_course_mm"]
    assert "Newton's method brought the chart to a minimum" in shown["notes"][0]
    assert shown["rounds"] >= 2
    assert abs(shown["energy_change"]) <= 0.01
    assert shown["size_change"] <= 0.1


def test_a_chart_of_other_stitches_is_shown_spread_and_goes_on(tmp_path: Path) -> None:
    shares: list[float] = []
    context = Context(
        tmp_path, progress=lambda done, total: shares.append(done / total),
        cancelled=lambda: len(shares) > 3,
    )  # fmt: skip
    with pytest.raises(CancelledError):
        whole(LACE, context)
    lace = whole(LACE.model_copy(update={"centre_lines": True}), Context(tmp_path))
    assert lace.converged
    assert lace.pull_n_per_mm == pytest.approx(0.03)
    assert lace.cell_course_interval_mm is lace.cell_wale_interval_mm is None
    assert lace.interval_source.startswith("No interval")
    assert (lace.rows, lace.columns, lace.folded) == (2, 4, False)
    assert lace.crossings == 32
    assert lace.eyelet_mm2 is not None
    assert lace.hole_share is not None
    assert lace.centre_lines_mm is not None
    assert len(lace.centre_lines_mm) == 2
    assert "blocking board" in lace.notes[1]
    assert re.search(r"drawn in by \d+%\.$", lace.notes[-1])


def test_knits_and_purls_are_not_pulled(tmp_path: Path) -> None:
    plain = whole(REQUEST, Context(tmp_path))
    assert plain.pull_n_per_mm is plain.crossings is plain.folded is plain.hole_share is None


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"flat": True}, "flat: is for charts of knits and purls only"),
        ({"yarn_per_stitch": True}, "yarn_per_stitch: is for charts of knits and purls only"),
        ({"loop_lengths_mm": [[11.0], [12.0]]}, "loop_lengths_mm: is for charts of knits"),
        ({"chart": "\n".join(["KO/" * 30] * 45)}, str(MAX_STITCHES_WHOLE)),
    ],
)
def test_what_other_stitches_do_not_take_is_refused(
    change: dict[str, Any], problem: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=problem):
        whole(LACE.model_copy(update=change), Context(tmp_path))
