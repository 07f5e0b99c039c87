"""Programs of any stitches: knitted on the virtual machine, and read back with their order."""

import contextlib
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore.base.errors import InputError
from knitcore.chart.stitch_kinds import STITCHES
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.knitout_reader import knitted_chart, knitted_stitches, verified
from knitcore.garment.piece import Piece
from knitcore.machine.profile import profile
from knitcore.machine.program import Finish
from knitcore.machine.program_check import check_program
from knitcore.machine.setting import setting_of
from knitcore.machine.stitch_program import stitch_program
from knitcore.machine.tension import BREAK_RISK, pass_tensions, tightest_of
from knitcore.materials import material
from tests.knitcore.machine.second_machine import verified_twice
from tests.knitcore.symbol_charts import EVERY, chart_with, symbol_charts

WIDEST = 4
MACHINE_MADE = [
    place
    for place in EVERY
    if STITCHES[place].width <= WIDEST and not any(s.turn for s in STITCHES[place].sites)
]


@settings(max_examples=10)
@given(st.sampled_from(MACHINE_MADE), st.sampled_from(Finish))
def test_every_stitch_is_read_back(place: int, finish: Finish) -> None:
    chart = chart_with(place)
    if not chart.is_plain:
        assert knitted_stitches(verified_twice(chart, finish=finish).text).content == chart


@settings(max_examples=8)
@given(symbol_charts(most_rows=3, most_columns=5, turned=False))
def test_programs_knit_their_charts(chart: SymbolChart) -> None:
    with contextlib.suppress(InputError):  # more loops than a hook holds, or no way for them
        program = stitch_program(chart)
        read = knitted_stitches(program.text).content
        assert isinstance(read, SymbolChart) or chart.is_plain
        assert read == chart if isinstance(read, SymbolChart) else read.chart == chart.plain


@pytest.mark.parametrize("lace", ["KO/KKK\\OK;KKKKKKKKK", "PO)PPP(OP;PPPPPPPPP"])
def test_yarn_overs_cost_no_pass_where_a_bed_cannot_tuck_and_knit(lace: str) -> None:
    machine = replace(profile("kniterate"), waste_passes=4)
    made = verified_twice(SymbolChart.parse(lace), machine=machine)
    assert made.tuck_passes == 0
    assert check_program(made.text, machine) == ()


def test_tucks_beside_knits_cost_passes_that_are_named() -> None:
    made = verified_twice(SymbolChart.parse("KTKT;KKKK"), machine=profile("kniterate"))
    assert made.tuck_passes == 6
    assert made.notes == ("Tucks beside knits take 6 passes more: a bed does one of both.",)


CABLES = SymbolChart.parse("PKKKKPPKKKKP;P[2/2L]PP[2/2R]P;PKKKKPPKKKKP;PKKKKPPKKKKP")


def test_the_row_before_a_tight_cable_is_knitted_looser() -> None:
    machine = profile("kniterate")
    setting = setting_of(Piece.plain(CABLES.plain), machine, material("glove-wool"))
    number, yarn, looser = setting.number, setting.yarn, setting.looser
    with pytest.raises(InputError, match="would break"):
        stitch_program(CABLES, machine=machine, stitch_number=number, yarn=yarn)
    made = verified_twice(CABLES, machine=machine, stitch_number=number, yarn=yarn, looser=looser)
    assert made.spared == (
        "Stitch number 9 in course 2 gives the loops the yarn for the transfers after it."
    )
    course = made.text[made.text.index("; course 2") :]
    settings = [line for line in course.splitlines() if line.startswith("x-stitch-number")]
    assert settings[:2] == ["x-stitch-number 9", f"x-stitch-number {number:g}"]
    assert yarn is not None
    assert 9 in looser
    tightest = tightest_of(pass_tensions(made.text, yarn, machine, looser))
    assert tightest is not None
    assert tightest.tightest is not None
    assert tightest.tightest.break_chance < BREAK_RISK


BY_HAND = """;!knitout-2
;;Carriers: 1 2 3
in 1
{cast_on}
knit + f1 1
knit + f2 1
knit + f3 1
knit + f4 1
{moves}
{row}
knit + f1 1
knit + f2 1
knit + f3 1
knit + f4 1
out 1
"""
CAST_ON = "\n".join(f"tuck - f{n} 1" for n in (4, 3, 2, 1))
ALL = "\n".join(f"knit - f{n} 1" for n in (4, 3, 2, 1))
TO_BACK = "xfer f2 b2\nxfer f3 b3\n"


@pytest.mark.parametrize(
    ("moves", "row", "face"),
    [
        (f"{TO_BACK}rack 1\nxfer b2 f3\nrack -1\nxfer b3 f2\nrack 0", ALL, "K[1/1R]K"),
        (f"{TO_BACK}rack -1\nxfer b3 f2\nrack 1\nxfer b2 f3\nrack 0", ALL, "K[1/1L]K"),
        (
            "xfer f2 b2\nrack 1\nxfer b2 f3\nrack 0",
            "knit - f4 1\nknit - f3 1\ntuck - f2 1\nknit - f1 1",
            "KO\\K",
        ),
        ("", "knit - f4 1\ntuck - f3 1\nknit - f2 1\nknit - f1 1", "KKTK"),
        ("", "knit - f4 1\nmiss - f3 1\nknit - f2 1\nknit - f1 1", "KKVK"),
        ("xfer f3 b3", "knit - f4 1\nmiss - b3 1\nknit - f2 1\nknit - f1 1\nxfer b3 f3", "KKvK"),
    ],
)
def test_programs_of_other_hands(moves: str, row: str, face: str) -> None:
    program = BY_HAND.format(cast_on=CAST_ON, moves=moves, row=row)
    chart = knitted_stitches(program).content
    assert str(chart) == f"KKKK\n{face}\nKKKK"
    with pytest.raises(InputError, match="Charts hold knits and purls"):
        knitted_chart(program)


@pytest.mark.parametrize(
    ("text", "machine", "message"),
    [
        ("BK", "swg091n2", "row 1, stitch 1 is twisted, which no machine does"),
        ("[3/3R];KKKKKK", "kniterate", "row 2, stitches 1 to 6: Kniterate"),
        ("KKK;^OO", "kniterate", "row 1, stitch 1 is worked through 6 loops; a hook holds 3"),
        ("TK;TK;TK;KK", "swg091n2", "row 4, stitch 1 holds 4 loops; a hook holds 3"),
    ],
)
def test_what_a_machine_cannot_do_is_refused_by_row(text: str, machine: str, message: str) -> None:
    with pytest.raises(InputError) as refusal:
        verified(SymbolChart.parse(text), machine=profile(machine))
    assert message in str(refusal.value)


def test_like_cables_of_a_row_go_together() -> None:
    row, plain = "P[2/2R]P" * 4, "PKKKKP" * 4
    program = verified_twice(SymbolChart.parse(f"{row};{plain}"))
    assert program.text.count("\nrack") < 2 * 4
