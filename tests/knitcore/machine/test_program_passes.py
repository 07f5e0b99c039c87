"""The passes of programs, and how far each pulls loops apart."""

import pytest

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.machine.program import knitout_program
from knitcore.machine.program_passes import Link, read_passes


def row(way: str, needles: range, bed: str = "f") -> list[str]:
    return [f"knit {way} {bed}{n} 1" for n in needles]


def test_a_pass_ends_where_the_carriage_turns() -> None:
    lines = ["inhook 1", *row("+", range(1, 5)), *row("-", range(4, 0, -1))]
    steps = read_passes("\n".join(lines)).passes
    assert [(step.kind, step.loops, step.rightwards) for step in steps] == [
        ("knit", 4, True),
        ("knit", 4, False),
    ]
    assert (steps[0].low, steps[0].high, steps[1].line) == (1, 4, 6)


def test_a_needle_knits_once_in_a_pass() -> None:
    steps = read_passes("tuck - f1 1\nknit - f1 1\nmiss - f1 1\nmiss - f0 1").passes
    assert [(step.loops, step.changes) for step in steps] == [(1, 0), (1, 0)]


def test_both_beds_go_over_from_tucks_to_knits_at_once() -> None:
    lines = ["knit + f1 1", "knit + b2 1", "tuck + f3 1", "tuck + b4 1", "knit + f5 1"]
    (step,) = read_passes("\n".join(lines)).passes
    assert step.changes == 2


def test_a_pass_of_transfers_has_one_racking_and_one_bed() -> None:
    lines = [*row("+", range(1, 5)), "xfer f1 b1", "xfer f2 b2", "xfer b1 f1", "rack 1"]
    lines += ["xfer b2 f3", "rack 0"]
    steps = [step for step in read_passes("\n".join(lines)).passes if step.kind == "transfer"]
    assert [(step.bed, step.rack, step.loops) for step in steps] == [
        ("f", 0, 2),
        ("b", 0, 1),
        ("b", 1, 1),
    ]


def test_a_straight_transfer_pulls_the_yarn_to_both_neighbours() -> None:
    steps = read_passes("\n".join([*row("+", range(1, 6)), "xfer f3 b3"])).passes
    assert {pull.link for pull in steps[-1].pulls} == {Link(1, True, 1)}
    assert {len(pull.left) + len(pull.right) for pull in steps[-1].pulls} == {3}


def test_racking_pulls_before_and_after_the_transfer() -> None:
    lines = [*row("+", range(1, 7)), "xfer f3 b3", "rack 2", "xfer b3 f5"]
    steps = read_passes("\n".join(lines)).passes
    spans = {(pull.link.needles, pull.link.across) for pull in steps[-1].pulls}
    assert spans == {(3, True), (1, True), (3, False)}


def test_loops_knitted_off_pull_no_more() -> None:
    lines = [*row("+", range(1, 4)), *row("-", range(3, 0, -1)), "xfer f2 b2"]
    pulls = read_passes("\n".join(lines)).passes[-1].pulls
    assert {len(pull.left) + len(pull.right) for pull in pulls} == {1}


def test_floats_and_loops_are_counted_by_carrier() -> None:
    reading = read_passes("knit + f1 1\nknit + f4 1\nknit + f5 2\nout 1\nknit + f9 1")
    assert reading.loops == {"1": 3, "2": 1}
    assert reading.float_needles["1"] == 2


@pytest.mark.parametrize("line", ["xfer f1 g2", "rack left", "rack"])
def test_a_line_that_cannot_be_read_is_named(line: str) -> None:
    with pytest.raises(InputError, match="line 2"):
        read_passes(f"knit + f1 1\n{line}")


def test_passes_of_a_chart_count_its_courses_and_transfers() -> None:
    chart = StitchChart.of_fabric("garter", rows=4, columns=6)
    program = knitout_program(chart)
    steps = read_passes(program.text).passes
    moved = sum(step.loops for step in steps if step.kind == "transfer")
    assert moved == program.transfers + program.shaping_transfers
    assert sum(step.kind == "transfer" for step in steps) == 3


def test_transfers_of_a_course_are_one_pass_to_each_bed() -> None:
    program = knitout_program(StitchChart.of_fabric("seed", rows=4, columns=6))
    steps = [step for step in read_passes(program.text).passes if step.kind == "transfer"]
    assert [(step.bed, step.loops) for step in steps] == [("f", 3), ("b", 3)] * 3
