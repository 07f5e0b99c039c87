"""Minutes, passes, yarn and cost of programs."""

from dataclasses import replace

import pytest

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.machine.duration import RUN_OUT_NEEDLES, program_report
from knitcore.machine.profile import profile
from knitcore.machine.program import knitout_program
from knitcore.machine.tension import LoopYarn
from knitcore.materials import material

KNITERATE = profile("kniterate")
YARN = LoopYarn.of(material("acrylic"), loop_length_mm=11, linear_density_tex=500)


def rows(count: int) -> str:
    lines = ["inhook 1"]
    for row in range(count):
        needles = range(1, 11) if row % 2 == 0 else range(10, 0, -1)
        lines += [f"knit {'-' if row % 2 else '+'} f{n} 1" for n in needles]
    return "\n".join(lines)


def test_minutes_are_passes_over_the_width_and_their_turns() -> None:
    report = program_report(rows(4), KNITERATE, YARN)
    way_m = (9 + 2 * RUN_OUT_NEEDLES) * 25.4 / 7 / 1000
    times = KNITERATE.times
    each = way_m / times.carriage_speed_m_per_s + times.turn_s
    assert report.minutes == pytest.approx(4 * each / 60)
    assert (report.passes, report.empty_passes, report.rackings) == (4, 0, 0)


def test_a_pass_from_the_wrong_side_brings_the_carriage_back_first() -> None:
    twice = "knit + f1 1\nknit + f2 1\nknit + f1 1\nknit + f2 1"
    assert program_report(twice, KNITERATE, YARN).empty_passes == 1


def test_tucks_with_knits_take_a_pass_of_their_own_where_the_machine_parts_them() -> None:
    mixed = "knit + f1 1\ntuck + f2 1"
    assert program_report(mixed, KNITERATE, YARN).empty_passes == 2
    assert program_report(mixed, profile("swg091n2"), YARN).empty_passes == 0


def test_transfers_and_rackings_take_time() -> None:
    moved = rows(1) + "\nxfer f5 b5\nrack 1\nxfer b5 f6\nrack 0"
    report = program_report(moved, KNITERATE, YARN)
    assert (report.transfer_passes, report.transfers, report.rackings) == (2, 2, 2)
    slower = replace(KNITERATE, times=replace(KNITERATE.times, racking_s=31, transfer_pass_s=16))
    added = program_report(moved, slower, YARN).minutes - report.minutes
    assert added == pytest.approx((2 * 30 + 2 * 15) / 60)
    assert report.tightest is not None


def test_yarn_is_counted_by_carrier_with_its_floats() -> None:
    (yarn,) = program_report(rows(3), KNITERATE, YARN).yarns
    assert yarn.loops == 30
    assert yarn.length_m == pytest.approx(0.33)
    assert yarn.mass_g == pytest.approx(0.165)
    floated = program_report("knit + f1 1\nknit + f4 1", KNITERATE, YARN).yarns[0]
    assert floated.length_m * 1000 == pytest.approx(2 * 11 + 2 * 25.4 / 7)
    other = program_report(rows(1), KNITERATE, YARN, tex_of_carriers={"1": 100}).yarns[0]
    assert other.mass_g == pytest.approx(0.011)


def test_cost_is_of_yarn_and_machine() -> None:
    report = program_report(rows(4), KNITERATE, YARN, price_per_kg=40, price_per_hour=12)
    assert report.cost == pytest.approx(report.minutes / 5 + report.yarns[0].mass_g * 0.04)
    assert program_report(rows(4), KNITERATE, YARN).cost is None
    with pytest.raises(InputError, match="price_per_kg"):
        program_report(rows(1), KNITERATE, YARN, price_per_kg=-1)


def test_a_report_of_a_chart_is_whole() -> None:
    chart = StitchChart.of_fabric("rib", rows=6, columns=8)
    report = program_report(knitout_program(chart).text, profile("swg091n2"), YARN)
    document = report.to_dict()
    assert document["passes"] == report.passes
    assert sum(yarn["loops"] for yarn in document["yarns"]) > 48
