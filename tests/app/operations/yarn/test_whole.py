"""``whole``: a chart relaxed as a whole, which goes on where it was stopped."""

import re
from pathlib import Path

import pytest

from app.context import Context
from app.operations.yarn.whole import WholeRequest, whole
from knitcore.base.errors import CancelledError
from tests.app.command_line import run

REQUEST = WholeRequest(chart="K", material="acrylic", tolerance=0.1)


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
