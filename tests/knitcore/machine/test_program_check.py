"""Programs held against machines: the failures that users of back ends report, and others."""

from dataclasses import replace

import pytest

from knitcore.machine.profile import DEFAULT, MachineProfile, profile, profiles
from knitcore.machine.program_check import check_program

KNITERATE, SHIMA = profile("kniterate"), profile(DEFAULT)
SETTINGS = ("x-stitch-number 5", "x-roller-advance 100")
MACHINES = [machine for machine in profiles().values() if machine.reads_programs]
each_machine = pytest.mark.parametrize("machine", MACHINES, ids=lambda m: m.identifier)


def program(machine: MachineProfile, *lines: str, headers: tuple[str, ...] = ()) -> str:
    carriers = " ".join(str(k) for k in range(1, machine.carriers.count + 1))
    return "\n".join(
        [
            ";!knitout-2",
            f";;Machine: {machine.header}",
            f";;Carriers: {carriers}",
            *headers,
            *lines,
            *SETTINGS,
        ]
    )


def on_front(way: str, needles: range, carrier: int = 1, operation: str = "knit") -> list[str]:
    return [f"{operation} {way} f{n} {carrier}" for n in needles[:: 1 if way == "+" else -1]]


def subjects(text: str, machine: MachineProfile) -> list[tuple[str, bool]]:
    return [(problem.subject, problem.stops) for problem in check_program(text, machine)]


@each_machine
def test_a_plain_program_has_no_fault(machine: MachineProfile) -> None:
    lines = ["in 1", *on_front("+", range(1, 9)), *on_front("-", range(1, 9)), "out 1"]
    assert check_program(program(machine, *lines), machine) == ()


@each_machine
def test_rib_that_is_transferred_to_and_fro_in_each_row(machine: MachineProfile) -> None:
    row = [
        *(f"xfer f{n} b{n}" for n in range(2, 9, 2)),
        *(f"knit + {'fb'[n % 2 == 0]}{n} 1" for n in range(1, 9)),
        *(f"xfer b{n} f{n}" for n in range(2, 9, 2)),
    ]
    back = [line.replace("+", "-") for line in row[:4]] + [
        f"knit - {'fb'[n % 2 == 0]}{n} 1" for n in range(8, 0, -1)
    ]
    lines = ["in 1", *on_front("+", range(1, 9)), *on_front("-", range(1, 9)), *row, *back, "out 1"]
    (problem,) = check_program(program(machine, *lines), machine)
    assert (problem.subject, problem.stops, problem.times) == ("transfers", False, 4)


@each_machine
@pytest.mark.parametrize(
    "between",
    [["xfer b2 f1"], ["miss + b1 1"]],  # a decrease, and yarn in front of a slipped stitch
)
def test_a_loop_that_makes_way_comes_back_for_a_reason(
    machine: MachineProfile, between: list[str]
) -> None:
    lines = ["in 1", *on_front("+", range(1, 4)), *on_front("-", range(1, 4))]
    lines += ["xfer f1 b1", "xfer f2 b2", *between, "xfer b1 f1", "knit + f1 1", "out 1"]
    lines = [line.replace("xfer b2 f1", "rack -1\nxfer b2 f1\nrack 0") for line in lines]
    assert check_program(program(machine, *lines), machine) == ()


@each_machine
def test_more_carriers_than_there_are(machine: MachineProfile) -> None:
    carrier = machine.carriers.count + 1
    text = program(machine, f"in {carrier}", *on_front("+", range(1, 4), carrier), f"out {carrier}")
    assert subjects(text, machine) == [("carriers", True)]


def test_ten_carriers_in_the_header_of_a_machine_with_six() -> None:
    text = ";!knitout-2\n;;Carriers: 1 2 3 4 5 6 7 8 9 10\nin 1\nknit + f1 1\nout 1"
    remedies = [problem.remedy for problem in check_program(text, KNITERATE)]
    assert "Write ;;Carriers: 1 2 3 4 5 6" in remedies


@each_machine
def test_racking_over_the_limit(machine: MachineProfile) -> None:
    most = machine.racking.most_needles
    lines = ["in 1", "knit + f1 1", f"rack {most + 1:g}", f"rack {-most - 1:g}", "out 1"]
    problems = check_program(program(machine, *lines), machine)
    assert [(p.subject, p.stops) for p in problems] == [("racking", True)] * 2
    assert f"limit of {most:g} needles" in problems[0].problem


@pytest.mark.parametrize(
    ("rack", "machine", "faults"),
    [
        ("0.5", KNITERATE, 0),
        ("0.25", KNITERATE, 0),
        ("0.75", KNITERATE, 1),
        ("0.25", SHIMA, 0),
        ("0.3", SHIMA, 1),
        ("0.5", replace(SHIMA, racking=replace(SHIMA.racking, step_needles=1.0)), 1),
    ],
)
def test_half_racks(rack: str, machine: MachineProfile, faults: int) -> None:
    lines = ["in 1", "knit + f1 1", f"rack {rack}", "rack 0", "out 1"]
    assert subjects(program(machine, *lines), machine) == [("racking", True)] * faults


@each_machine
def test_transfers_at_half_rack(machine: MachineProfile) -> None:
    lines = ["in 1", "knit + f1 1", "rack 0.5", "xfer f1 b1", "rack 0", "out 1"]
    assert ("racking", True) in subjects(program(machine, *lines), machine)


def test_yarn_without_waste_first_comes_from_where_it_is_parked() -> None:
    lines = ["in 1", *on_front("-", range(1, 5)), "out 1"]
    (problem,) = check_program(program(KNITERATE, *lines), KNITERATE)
    assert problem.problem == "carrier 1 comes from the left, but its first pass runs there."
    assert check_program(program(SHIMA, *lines), SHIMA) == ()


@each_machine
@pytest.mark.parametrize("between", ["", "; a comment", "in 1"])
def test_headers_that_are_not_read(machine: MachineProfile, between: str) -> None:
    lines = [between, ";;Position: Left"]
    problems = check_program(program(machine, *lines), machine)
    assert ("header", 5) in [(p.subject, p.line) for p in problems]


@each_machine
@pytest.mark.parametrize("ways", ["tuck and knit", "knit and tuck"])
def test_tuck_and_knit_in_one_pass(machine: MachineProfile, ways: str) -> None:
    first, second = ways.split(" and ")
    lines = [
        "in 1",
        *on_front("+", range(1, 5), operation=first),
        *on_front("+", range(5, 8), operation=second),
        "out 1",
    ]
    expected = [] if machine.tuck_with_knit else [("passes", False)]
    assert subjects(program(machine, *lines), machine) == expected


@each_machine
def test_tuck_and_miss_in_one_pass_is_no_fault(machine: MachineProfile) -> None:
    lines = ["in 1", "tuck + f1 1", "tuck + f3 1", "miss + f4 1", "tuck - f4 1", "out 1"]
    assert check_program(program(machine, *lines), machine) == ()


@each_machine
def test_a_tuck_on_one_bed_goes_with_a_knit_on_the_other(machine: MachineProfile) -> None:
    lines = ["in 1", "knit + f1 1", "tuck + b2 1", "knit + f3 1", "out 1"]
    assert check_program(program(machine, *lines), machine) == ()


@each_machine
def test_long_floats(machine: MachineProfile) -> None:
    longest = machine.longest_float_needles
    lines = ["in 1", "knit + f1 1", f"knit + f{longest + 2} 1", "knit - f1 1", "out 1"]
    assert check_program(program(machine, *lines), machine) == ()
    lines[2] = f"knit + f{longest + 3} 1"
    assert subjects(program(machine, *lines), machine) == [("floats", False)]


@each_machine
@pytest.mark.parametrize(
    ("position", "needles", "faults"),
    [
        ("Keep", (0, 5), 1),
        ("Keep", (1, 1), 0),
        ("Center", (-5, 5), 0),
        ("Center", (0, 1000), 1),
        ("Keep", (1, 1000), 1),
    ],
)
def test_needles_beyond_the_beds(
    machine: MachineProfile, position: str, needles: tuple[int, int], faults: int
) -> None:
    lines = ["in 1", *(f"tuck + f{needle} 1" for needle in needles), "out 1"]
    text = program(machine, *lines, headers=(f";;Position: {position}",))
    stopping = [subject for subject, stops in subjects(text, machine) if stops]
    assert stopping == ["needles"] * faults


@pytest.mark.parametrize(
    ("line", "subject"),
    [
        ("inhook 2", "carriers"),
        ("releasehook 1", "carriers"),
        ("in 1", "carriers"),
        ("out 3", "carriers"),
        ("knit + f5 4", "carriers"),
        ("knit + f5 1 2", "carriers"),
        ("in 2", "carriers"),
        ("rack", "racking"),
        ("rack far", "racking"),
        ("drop g3", "needles"),
    ],
)
def test_other_faults(line: str, subject: str) -> None:
    text = program(KNITERATE, "in 1", "knit + f1 1", line, "out 1")
    assert subject in [name for name, _ in subjects(text, KNITERATE)]


def test_a_single_bed_and_another_machine() -> None:
    single = replace(SHIMA, beds=1)
    assert subjects(program(SHIMA, "in 1", "knit + b1 1", "out 1"), single) == [("beds", True)]
    text = program(SHIMA, "in 1", "knit + f1 1", "out 1").replace("SWG091N2", "Stoll")
    assert subjects(text, SHIMA) == [("header", False)]


def test_a_yarn_that_is_left_in() -> None:
    (problem,) = check_program(program(SHIMA, "in 1", "knit + f1 1"), SHIMA)
    assert "carrier 1 is still in at the end" in str(problem)


@pytest.mark.parametrize(
    "text", ["", "knit", "\ufeff;!knitout-2", "knit + f1", ";;:", "\x00", "xfer f1"]
)
@each_machine
def test_any_text_can_be_checked(machine: MachineProfile, text: str) -> None:
    assert all(problem.line >= 1 for problem in check_program(text, machine))


KINDS = {
    "stitch size is not set": (KNITERATE, ["in 1", "knit + f1 1", "out 1"], "settings"),
    "a stitch number that there is not": (
        KNITERATE,
        ["x-stitch-number 12", "in 1", "knit + f1 1", "out 1"],
        "settings",
    ),
    "the piece comes before the waste yarn": (
        KNITERATE,
        ["in 3", *on_front("+", range(1, 5), 3), "out 3"],
        "carriers",
    ),
    "two yarns on the hook": (
        SHIMA,
        ["inhook 1", "tuck - f2 1", "inhook 2", "tuck - f1 2", "outhook 1", "outhook 2"],
        "carriers",
    ),
    "loops pile up on a needle": (
        KNITERATE,
        ["in 1", *["tuck + f1 1", "tuck - f1 1"] * 3, "out 1"],
        "transfers",
    ),
    "transfers overlap on a needle": (
        KNITERATE,
        [
            "in 1",
            *on_front("+", range(1, 7)),
            *(
                line
                for n in range(1, 6)
                for line in (f"xfer f{n} b{n}", "rack 1", f"xfer b{n} f{n + 1}", "rack 0")
            ),
            "out 1",
        ],
        "transfers",
    ),
    "a split onto a loop": (
        KNITERATE,
        ["in 1", "knit + f1 1", "knit + b1 1", "split - f1 b1 1", "out 1"],
        "transfers",
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_that_other_peoples_programs_have(kind: str) -> None:
    machine, lines, subject = KINDS[kind]
    text = program(machine, *lines)
    if kind == "stitch size is not set":
        text = "\n".join(line for line in text.split("\n") if not line.startswith("x-"))
    problems = check_program(text, machine)
    assert subject in {problem.subject for problem in problems}
    assert all(problem.remedy for problem in problems)
