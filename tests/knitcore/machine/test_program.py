from dataclasses import replace
from typing import Literal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Fabric, InputError, StitchChart, material
from knitcore.formats.read.knitout_reader import KnitoutMismatchError, knitted_chart, verified
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.profile import DEFAULT, MachineProfile, profile, profiles
from knitcore.machine.program import Finish, knitout_program
from knitcore.machine.program_check import check_program
from knitcore.machine.tension import BREAK_RISK, LoopYarn, pass_tensions
from tests.knitcore.charts import stitch_charts
from tests.knitcore.machine.second_machine import verified_twice
from tests.knitcore.pieces import pieces


@settings(max_examples=8)
@given(chart=stitch_charts(most=7))
@pytest.mark.parametrize("finish", list(Finish))
def test_the_machine_knits_the_chart(finish: Finish, chart: StitchChart) -> None:
    assert knitted_chart(verified_twice(chart, finish=finish).text).chart == chart


@settings(max_examples=40)
@given(piece=pieces(most_rows=6, most_columns=8), finish=st.sampled_from(Finish))
@pytest.mark.slow
def test_the_machine_knits_outlines_and_colours(piece: Piece, finish: Finish) -> None:
    try:
        program = verified_twice(piece, finish=finish)
    except InputError as error:
        assert "blocks of colour" in error.problem  # noqa: PT017 - the only way to fail
        return
    assert knitted_chart(program.text).piece == piece.cropped()
    assert program.carriers >= len(piece.yarns)


def test_a_carrier_stays_with_its_block() -> None:
    """Blue, cream, blue: two blues are two carriers, as in hand intarsia two bobbins."""
    yarn_of = np.array([[1] * 3 + [0] * 4 + [1] * 3] * 4)
    chart = ShapedChart.rectangle(StitchChart.of_fabric("stockinette", rows=4, columns=10))
    yarns = (MAIN_YARN, PieceYarn("blue", "#0000ff"))
    program = verified_twice(Piece(chart, yarns, yarn_of))
    assert program.carriers == 3
    assert "; carrier 1 knits #0000ff blue\n" in program.text
    assert program.text.count("inhook") == 4  # and waste
    assert program.transfers == 0


def test_a_course_of_one_stitch_ends_a_chain_and_carries_another_yarn() -> None:
    shaped = ShapedChart.parse("KKK\nKKK\nKKK", "..x\n..x\nxxx")
    yarn_of = np.array([[0, 0, 0], [0, 0, 0], [0, 0, 1]])
    piece = Piece(shaped, (MAIN_YARN, PieceYarn("blue", "#0000ff")), yarn_of)
    assert knitted_chart(verified_twice(piece).text).piece == piece


def test_too_many_blocks_of_colour_are_refused() -> None:
    yarn_of = np.arange(12)[None, :] % 2
    chart = ShapedChart.rectangle(StitchChart.of_fabric("stockinette", rows=1, columns=12))
    with pytest.raises(InputError, match="blocks of colour to 12"):
        knitout_program(Piece(chart, (MAIN_YARN, PieceYarn("blue", "#0000ff")), yarn_of))


def test_single_steps_are_decreases_and_larger_ones_are_bound_off() -> None:
    outline = "....xxxx....\n.xxxxxxxxxx.\nxxxxxxxxxxxx"
    text = "\n".join(["K" * 12] * 3)
    program = verified_twice(Piece.plain(ShapedChart.parse(text, outline)))
    assert program.transfers == 0
    assert program.shaping_transfers == 2 * (2 + 6)
    assert "rack 1" in program.text
    assert "rack -1" in program.text


KNITERATE = profile("kniterate")
MACHINES = [machine for machine in profiles().values() if machine.reads_programs]
each_machine = pytest.mark.parametrize("machine", MACHINES, ids=lambda m: m.identifier)


@each_machine
@pytest.mark.parametrize(
    ("fabric", "transfers"), list(zip(Fabric, (0, 18, 0, 18), strict=True)), ids=list(Fabric)
)
def test_transfers_only_where_the_kind_changes_in_a_wale(
    machine: MachineProfile, fabric: Fabric, transfers: int
) -> None:
    program = knitout_program(StitchChart.of_fabric(fabric, rows=4, columns=6), machine=machine)
    assert program.transfers == transfers
    courses = program.text[program.text.index("; cast-on") :]
    assert courses.count("xfer") == transfers


def in_blocks(colours: int, rows: int = 6, width: int = 7) -> Piece:
    yarns = (MAIN_YARN, *(PieceYarn(f"yarn {k}", f"#0000{k:02x}") for k in range(1, colours)))
    yarn_of = np.repeat(np.arange(colours), width)[None, :].repeat(rows, axis=0)
    chart = StitchChart.of_fabric("rib", rows=rows, columns=colours * width)
    return Piece(ShapedChart.rectangle(chart), yarns, yarn_of)


def shaped() -> Piece:
    spans = [(5, 15), (4, 16), (1, 19), (1, 19), (2, 18), (2, 15), (6, 15), (7, 14)]
    outline = ["".join("x" if a <= c < b else "." for c in range(20)) for a, b in spans][::-1]
    rows = [("KP" if row % 2 else "PK") * 10 for row in range(len(spans))]
    return Piece.plain(ShapedChart.parse("\n".join(rows), "\n".join(outline)))


DESIGNS = {
    "plain": Piece.of(StitchChart.of_fabric("stockinette", rows=4, columns=24)),
    "rib": Piece.of(StitchChart.of_fabric("rib", rows=4, columns=5)),
    "seed": Piece.of(StitchChart.of_fabric("seed", rows=4, columns=21)),
    "garter": Piece.of(StitchChart.of_fabric("garter", rows=4, columns=20)),
    "two colours": in_blocks(2),
    "three colours": in_blocks(3),
    "shaped": shaped(),
}


@each_machine
@pytest.mark.parametrize("finish", list(Finish))
@pytest.mark.parametrize("design", DESIGNS)
def test_no_machine_finds_fault_with_its_programs(
    machine: MachineProfile, finish: Finish, design: str
) -> None:
    program = knitout_program(DESIGNS[design], finish=finish, machine=machine)
    assert check_program(program.text, machine) == ()


def parked(machine: MachineProfile, side: Literal["left", "right"]) -> MachineProfile:
    return replace(machine, carriers=replace(machine.carriers, parking=side))


OTHER_SIDE = parked(profile("kniterate"), "right")


@pytest.mark.parametrize("finish", list(Finish))
@pytest.mark.parametrize("design", DESIGNS)
def test_a_machine_whose_carriers_park_on_the_right_knits_mirrored(
    design: str, finish: Finish
) -> None:
    program = knitout_program(DESIGNS[design], finish=finish, machine=OTHER_SIDE)
    assert check_program(program.text, OTHER_SIDE) == ()
    assert "carriers" in {problem.subject for problem in check_program(program.text, KNITERATE)}
    usual = knitout_program(DESIGNS[design].mirrored(), finish=finish, machine=KNITERATE)
    assert len(program.text.splitlines()) == len(usual.text.splitlines())


@pytest.mark.parametrize("machine", [OTHER_SIDE])
@pytest.mark.parametrize("design", ["rib", "three colours", "shaped"])
@pytest.mark.slow
def test_the_virtual_machine_knits_mirrored_programs(machine: MachineProfile, design: str) -> None:
    machine = replace(machine, waste_passes=4)
    program = verified_twice(DESIGNS[design], machine=machine, finish=Finish.BIND_OFF)
    assert knitted_chart(program.text).piece == DESIGNS[design].cropped()


@each_machine
@pytest.mark.parametrize("design", ["rib", "three colours", "shaped"])
@pytest.mark.slow
def test_the_virtual_machine_knits_the_programs_of_every_machine(
    machine: MachineProfile, design: str
) -> None:
    machine = replace(machine, waste_passes=4)
    program = verified_twice(DESIGNS[design], machine=machine, finish=Finish.BIND_OFF)
    assert knitted_chart(program.text).piece == DESIGNS[design].cropped()


def kniterate_lines(piece: Piece, finish: Finish = Finish.WASTE) -> list[str]:
    return knitout_program(piece, finish=finish, machine=profile("kniterate")).text.splitlines()


@pytest.mark.parametrize("machine", [DEFAULT, KNITERATE.identifier])
def test_a_carrier_ends_a_block_and_begins_another_in_one_row(machine: str) -> None:
    """The blue block on the left ends where that on the right begins: one carrier is enough."""
    yarns = (MAIN_YARN, PieceYarn("blue", "#1f3b70"))
    colours = np.array([[1] * 4 + [0] * 8] * 2 + [[0] * 8 + [1] * 4] * 2)
    chart = ShapedChart.rectangle(StitchChart.of_fabric(Fabric.STOCKINETTE, rows=4, columns=12))
    program = verified_twice(Piece(chart, yarns, colours), machine=profile(machine))
    assert program.carriers == 2


def test_a_kniterate_has_its_headers_at_the_top() -> None:
    assert kniterate_lines(DESIGNS["rib"])[:6] == [
        ";!knitout-2",
        ";;Machine: Kniterate",
        ";;Gauge: 7",
        ";;Width: 252",
        ";;Position: Center",
        ";;Carriers: 1 2 3 4 5 6",
    ]


def test_a_kniterate_knits_waste_yarn_and_a_draw_thread_first() -> None:
    lines = kniterate_lines(DESIGNS["two colours"])
    waste, draw, cast_on = (
        lines.index(o)
        for o in ("; waste yarn, which takes in all yarns", "; draw thread", "; cast-on")
    )
    assert waste < draw < cast_on
    assert lines[waste + 1 : waste + 4] == [
        "x-stitch-number 6",
        "x-speed-number 300",
        "x-roller-advance 400",
    ]
    assert [line for line in lines if line.startswith("in ")] == ["in 1", "in 2", "in 3", "in 4"]
    assert lines.index("in 4") < draw
    assert {line.split()[-1] for line in lines[draw + 1 : draw + 15]} == {"2"}
    assert lines[cast_on - 4 : cast_on] == [
        "x-stitch-number 6",
        "x-xfer-stitch-number 3",
        "x-speed-number 100",
        "x-roller-advance 100",
    ]
    assert not any("hook" in line for line in lines)
    assert sorted(line for line in lines if line.startswith("out ")) == [
        "out 1",
        "out 2",
        "out 3",
        "out 4",
    ]


def test_the_waste_of_a_narrow_piece_is_wide_enough_for_the_rollers() -> None:
    lines = kniterate_lines(DESIGNS["rib"])
    start = lines[: lines.index("; cast-on")]
    assert "knit + f20 1" in start
    assert [line for line in start if line.startswith("drop f")] == [
        f"drop f{needle}" for needle in range(6, 21)
    ]


def test_a_machine_that_cannot_tuck_in_a_knitting_pass_tucks_in_one_of_its_own() -> None:
    lines = kniterate_lines(DESIGNS["two colours"])
    courses = lines[lines.index("; course 1") :]
    ties = [index for index, line in enumerate(courses) if line.startswith("tuck")]
    assert len(ties) == 6
    for index in ties:
        way = courses[index].split()[1]
        assert courses[index - 1].startswith(f"miss {'+' if way == '-' else '-'}")


def test_waste_yarn_takes_the_place_of_a_draw_thread_where_all_carriers_hold_yarns() -> None:
    program = knitout_program(in_blocks(5), machine=profile("kniterate"))
    assert program.draws_waste
    assert "; draw thread" not in program.text
    with pytest.raises(InputError, match=r"blocks of colour to 6, .* the machine has 6"):
        knitout_program(in_blocks(6), machine=profile("kniterate"))


def test_half_gauge_leaves_every_other_needle_free() -> None:
    machine = profile("v-bed-half-gauge")
    program = knitout_program(shaped(), machine=machine)
    needles = {
        int(word[1:])
        for line in program.text.splitlines()
        if line.split(" ")[0] in ("knit", "tuck", "xfer")
        for word in line.split(" ")
        if word[0] in "fb"
    }
    assert all(needle % 2 for needle in needles)
    assert "rack 2\n" in program.text


@pytest.mark.parametrize(("number", "line"), [(None, "5"), (40, "40")])
def test_the_stitch_number_is_the_machines_unless_one_is_given(
    number: float | None, line: str
) -> None:
    program = knitout_program(DESIGNS["rib"], stitch_number=number)
    assert f"\nx-stitch-number {line}\n" in program.text
    assert program.stitch_number == float(line)


def test_a_kniterate_writes_stitch_numbers_from_ten_on_as_letters() -> None:
    kniterate = profile("kniterate")
    wide = replace(kniterate, stitch_number=replace(kniterate.stitch_number, most=35))
    program = knitout_program(DESIGNS["rib"], machine=wide, stitch_number=12)
    assert "\nx-stitch-number C\n" in program.text


@pytest.mark.parametrize("number", [-1, 2.5, 400, float("nan")])
def test_a_stitch_number_that_the_machine_lacks_is_refused(number: float) -> None:
    with pytest.raises(InputError, match=r"stitch_number: .* a whole number from 0 to 120"):
        knitout_program(DESIGNS["rib"], stitch_number=number)


SINGLE_BED = replace(profile(DEFAULT), name="A single bed", beds=1)


@pytest.mark.parametrize(
    ("machine", "piece", "finish", "says"),
    [
        (profile("ayab"), DESIGNS["plain"], Finish.WASTE, "machine: .* is worked by hand"),
        (SINGLE_BED, DESIGNS["garter"], Finish.WASTE, "chart: row 2, column 1 is a purl"),
        (SINGLE_BED, DESIGNS["plain"], Finish.BIND_OFF, "outline: .* over a second bed"),
        (
            replace(profile(DEFAULT), racking=replace(profile(DEFAULT).racking, most_needles=0)),
            DESIGNS["plain"],
            Finish.BIND_OFF,
            "outline: .* rack a bed",
        ),
        (
            profile("v-bed-half-gauge"),
            Piece.of(StitchChart.of_fabric("rib", rows=2, columns=201)),
            Finish.WASTE,
            "chart: 201 columns are wider than the machine's 400 needles at half gauge",
        ),
    ],
    ids=["hand", "purl", "bind-off", "racking", "width"],
)
def test_what_a_machine_cannot_knit_is_refused_with_a_remedy(
    machine: MachineProfile, piece: Piece, finish: Finish, says: str
) -> None:
    with pytest.raises(InputError, match=says) as refusal:
        knitout_program(piece, finish=finish, machine=machine)
    assert refusal.value.remedy


def test_a_single_bed_knits_a_plain_rectangle() -> None:
    program = knitout_program(DESIGNS["plain"], machine=SINGLE_BED)
    assert check_program(program.text, SINGLE_BED) == ()


LACE = material("lace-acrylic")


@pytest.mark.slow
def test_short_loops_are_staged_so_that_racking_spares_them() -> None:
    machine = profile("v-bed-half-gauge")
    short = LoopYarn.of(LACE, loop_length_mm=6.2)
    program = knitout_program(DESIGNS["shaped"], machine=machine, yarn=short)
    assert "come to the front" in program.spared
    risky = [step for step in pass_tensions(program.text, short, machine) if step.tightest]
    assert max(step.tightest.break_chance for step in risky if step.tightest) < BREAK_RISK
    long = LoopYarn.of(LACE, loop_length_mm=7.2)
    plain = knitout_program(DESIGNS["shaped"], machine=machine, yarn=long)
    assert plain.spared == ""


def test_transfers_that_may_break_the_yarn_are_slowed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("knitcore.machine.program.BREAK_RISK", 0.0)
    seed = StitchChart.of_fabric("seed", rows=3, columns=4)
    yarn = LoopYarn.of(LACE, loop_length_mm=11)
    program = knitout_program(seed, machine=replace(KNITERATE, waste_passes=4), yarn=yarn)
    assert "Slowed to 50: " in program.spared
    lines = program.text.splitlines()
    slow = [index for index, line in enumerate(lines) if line == "x-speed-number 50"]
    assert slow
    for index in slow:
        assert lines[index + 1].startswith("xfer")
        after = next(line for line in lines[index + 1 :] if not line.startswith("xfer"))
        assert after == "x-speed-number 100"
    watched = knitout_program(seed, machine=profile("v-bed-half-gauge"), yarn=yarn)
    assert "Slow down and watch" in watched.spared
    assert "x-speed" not in watched.text


def test_32_x_32_is_exported_and_verified() -> None:
    chart = StitchChart(np.random.default_rng(1).random((32, 32)) < 0.5)
    assert verified_twice(chart).text.count("\nknit") == 32 * 32 + 6 * 32


def test_a_chart_that_is_not_knitted_is_never_exported(monkeypatch: pytest.MonkeyPatch) -> None:
    other = knitout_program(StitchChart.parse("KP\nPP"))
    monkeypatch.setattr(
        "knitcore.formats.read.knitout_reader.stitch_program", lambda *_, **__: other
    )
    with pytest.raises(KnitoutMismatchError, match="another chart"):
        verified(StitchChart.parse("KP\nPK"))


def test_a_chart_wider_than_the_machine_is_refused() -> None:
    remedy = "needles.*2 pieces of 16; turned by a quarter it is 2 columns"
    with pytest.raises(InputError, match=remedy):
        knitout_program(
            StitchChart.of_fabric("rib", rows=2, columns=31),
            machine=replace(profile(DEFAULT), needles=30),
        )


def changed(text: str, other: str, course: str = "") -> str:
    """A program with another text for one, in a course or at its first place."""
    program = knitout_program(StitchChart.of_fabric("stockinette", rows=3, columns=4)).text
    at = program.index(text, program.index(course))
    return program[:at] + other + program[at + len(text) :]


@pytest.mark.parametrize(
    ("program", "says"),
    [
        ("", "no loops"),
        (";!knitout-2\n;;Carriers: 1\nfly f1\n", "line 3: 'fly'"),
        (";!knitout-2\n;;Carriers: 1\nknit - f1 1\n", "line 3: carrier 1 is not in"),
        (changed("tuck - f2 1\n", ""), r"course 1, needle f2 \(line 20\): a loop begun"),
        (changed("f2 1\n", "f3 1\n", "; course 2\n"), "course 2, needle f2 .*: a missed stitch"),
        (changed("outhook 1", "outhook 0"), "carrier 0 is not in"),
        ("x" * 5_000_000, "too long"),
    ],
    ids=["empty", "no instruction", "carrier not in", "gap", "miss", "no such carrier", "long"],
)
def test_programs_that_cannot_be_read(program: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        knitted_chart(program)
