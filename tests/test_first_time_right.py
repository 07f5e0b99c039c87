"""Failures that users of other programs report, each by its kind: ours make none of them.

Programs of others that have them are in ``tests/knitcore/machine/test_program_check.py``.
"""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import InputError, StitchChart, material
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.designs.layout import layout_of
from knitcore.formats.read.knitout_reader import knitted_chart
from knitcore.formats.write.export import ExportKind, ExportOptions, export_chart
from knitcore.formats.write.sheets.knit_along import knit_along
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.profile import Dialect, MachineProfile, profiles
from knitcore.machine.program import Finish, knitout_program
from knitcore.machine.program_check import check_program
from knitcore.machine.setting import setting_of
from studies.five_designs import designs
from tests.knitcore.machine.second_machine import verified_twice
from tests.knitcore.pieces import pieces
from tests.knitcore.symbol_charts import symbol_charts

ALL = list(profiles().values())
PROGRAMMED = [machine for machine in ALL if machine.reads_programs]
HOME = [machine for machine in ALL if not machine.reads_programs]
WITHOUT_HOOK = [machine for machine in PROGRAMMED if machine.dialect is Dialect.KNITERATE]
WOOL = material("glove-wool")


def programs(machine: MachineProfile) -> tuple[str, ...]:
    return _programs(machine.identifier)


@cache
def _programs(name: str) -> tuple[str, ...]:
    machine = profiles()[name]
    return tuple(
        knitout_program(
            piece, machine=machine, finish=finish, yarn=setting_of(piece, machine, WOOL).yarn
        ).text
        for piece in designs().values()
        for finish in Finish
    )


def of_each(machines: list[MachineProfile]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("machine", machines, ids=lambda machine: machine.identifier)


@of_each(PROGRAMMED)
def test_no_program_has_a_kind_of_failure_that_is_known(machine: MachineProfile) -> None:
    """Carriers, racking, half racks, waste, headers, settings, passes, floats and transfers."""
    for program in programs(machine):
        assert check_program(program, machine) == ()


@of_each(PROGRAMMED)
def test_a_rib_is_not_transferred_to_and_fro(machine: MachineProfile) -> None:
    rib = knitout_program(designs()["rib"], machine=machine).text
    courses = rib[rib.index("; course 1") :]
    assert "xfer" not in courses


@of_each(PROGRAMMED)
def test_beds_rack_by_whole_needles_within_the_limit(machine: MachineProfile) -> None:
    for program in programs(machine):
        for rack in re.findall(r"^rack (\S+)$", program, re.MULTILINE):
            assert abs(int(rack)) <= machine.racking.most_needles


@of_each(WITHOUT_HOOK)
def test_waste_comes_first_and_headers_stand_at_the_top(machine: MachineProfile) -> None:
    for program in programs(machine):
        lines = program.splitlines()
        headers = [index for index, line in enumerate(lines) if line.startswith(";;")]
        assert headers == list(range(1, len(headers) + 1))
        assert f";;Position: {machine.position}" in lines
        brought = [line.split() for line in lines if re.match(r"in |knit |tuck ", line)]
        assert brought[0] == ["in", str(machine.carriers.waste)]
        first_of_piece = lines.index("; cast-on")
        assert sum(line.startswith("knit") for line in lines[:first_of_piece]) > 1000


@of_each(WITHOUT_HOOK)
def test_stitch_size_roller_and_speed_are_set_for_waste_and_for_the_piece(
    machine: MachineProfile,
) -> None:
    for program in programs(machine):
        waste, piece = program.split("; cast-on")
        for name in ("x-stitch-number", "x-roller-advance", "x-speed-number"):
            assert waste.count(name) >= 2
            assert program.index(name) < program.index("\nin ")
        assert "; course 1" in piece


@of_each(PROGRAMMED)
def test_the_user_is_told_what_to_thread_and_to_take_off(machine: MachineProfile) -> None:
    for piece in designs().values():
        for finish in Finish:
            made = knitout_program(piece, machine=machine, finish=finish)
            words = " ".join(made.steps)
            knitting = re.findall(r"^(?:knit|tuck) . \S+ (\d+)$", made.text, re.MULTILINE)
            threaded = re.findall(r"(?:carrier|;) (\d+) ", made.steps[0])
            assert threaded == sorted(set(knitting))
            assert ("draw thread" in words) == ("; draw thread" in made.text)
            assert ("waste" in words) == (len(threaded) > made.carriers)
            assert ("bound off" in words) == (finish is Finish.BIND_OFF)


@of_each(ALL)
def test_shaping_with_pattern_and_colours_gives_a_file(machine: MachineProfile) -> None:
    """And not a button that does nothing."""
    cut_out = designs()["cut-out"]
    yarn_of = (np.indices(cut_out.chart.purl.shape)[1] > 20).astype(np.intp)
    piece = Piece(cut_out.shaped, (MAIN_YARN, PieceYarn("blue", "#3b6fb6")), yarn_of)
    if machine.reads_programs:
        assert check_program(knitout_program(piece, machine=machine).text, machine) == ()
    else:
        plan = knit_along(piece, machine=machine)
        assert len(plan.rows) == piece.chart.rows
        assert any("blue" in line for row in plan.rows for line in row.words)


@of_each(ALL)
def test_after_a_jam_a_piece_goes_on_at_any_row(machine: MachineProfile) -> None:
    piece = designs()["cut-out"]
    for row in (2, piece.chart.rows // 2, piece.chart.rows):
        if machine.reads_programs:
            program = knitout_program(piece.from_row(row), machine=machine).text
            assert program.count("; course ") == piece.chart.rows - row + 1
        else:
            rows = knit_along(piece, machine=machine, from_row=row).rows
            assert [each.number for each in rows] == list(range(row, piece.chart.rows + 1))


@of_each(PROGRAMMED)
def test_loops_read_from_a_program_are_where_its_transfers_put_them(
    machine: MachineProfile,
) -> None:
    piece = Piece.of(StitchChart.of_fabric("seed", rows=4, columns=12))
    machine = replace(machine, waste_passes=4)
    assert knitted_chart(knitout_program(piece, machine=machine).text).piece == piece


@pytest.mark.parametrize("blocks", [5, 6, 10, 11])
@of_each(PROGRAMMED)
def test_no_carrier_is_used_that_the_machine_lacks(machine: MachineProfile, blocks: int) -> None:
    yarns = (MAIN_YARN, *(PieceYarn(f"yarn {k}", f"#0000{k:02x}") for k in range(1, blocks)))
    chart = ShapedChart.rectangle(StitchChart.of_fabric("stockinette", rows=4, columns=4 * blocks))
    piece = Piece(chart, yarns, np.repeat(np.arange(blocks), 4)[None, :].repeat(4, axis=0))
    if blocks < machine.carriers.count:
        program = knitout_program(piece, machine=machine)
        assert check_program(program.text, machine) == ()
        assert program.carriers == blocks
    else:
        with pytest.raises(InputError, match=f"the machine has {machine.carriers.count}"):
            knitout_program(piece, machine=machine)


@of_each(HOME)
def test_unsupported_colours_are_refused_and_knitted_by_hand(machine: MachineProfile) -> None:
    """Three colours in a row are more than one bed selects; the plan by the row has them."""
    yarns = (MAIN_YARN, PieceYarn("blue", "#3b6fb6"), PieceYarn("red", "#b03a2e"))
    chart = ShapedChart.rectangle(StitchChart.of_fabric("stockinette", rows=4, columns=12))
    piece = Piece(chart, yarns, np.repeat(np.arange(3), 4)[None, :].repeat(4, axis=0))
    assert len(knit_along(piece, machine=machine).rows) == 4
    layout = layout_of(piece).model_copy(update={"machine": machine.identifier})
    options = ExportOptions(layout=layout)
    for kind in (ExportKind.AYAB, ExportKind.PUNCH_CARD):
        try:
            export_chart(piece.chart, kind, WOOL, options)
        except InputError as error:
            assert error.remedy  # noqa: PT017 - either is right


@pytest.mark.slow
@settings(max_examples=12)
@given(
    piece=pieces(most_rows=8, most_columns=10),
    finish=st.sampled_from(Finish),
    yarn=st.sampled_from(("acrylic", "glove-wool", "lace-cashmere", "lace-acrylic")),
)
@of_each(ALL)
def test_any_chart_is_knitted_or_refused_with_what_helps(
    machine: MachineProfile, piece: Piece, finish: Finish, yarn: str
) -> None:
    machine = replace(machine, waste_passes=4)
    try:
        setting = setting_of(piece, machine, material(yarn))
        if machine.reads_programs:
            program = verified_twice(
                piece,
                machine=machine,
                finish=finish,
                stitch_number=setting.number,
                yarn=setting.yarn,
            )
            assert not [p for p in check_program(program.text, machine) if p.stops]
        else:
            knit_along(piece, machine=machine)
            layout = layout_of(piece).model_copy(update={"machine": machine.identifier})
            for kind in (ExportKind.HAND_PLAN, ExportKind.AYAB, ExportKind.PUNCH_CARD):
                export_chart(piece.chart, kind, material(yarn), ExportOptions(layout=layout))
    except InputError as error:
        assert error.remedy  # noqa: PT017 - a refusal with its reason is right


def stitches_are_knitted_or_refused(
    machine: MachineProfile, chart: SymbolChart, finish: Finish
) -> None:
    """And passes are too many only where the user is told so."""
    machine = replace(machine, waste_passes=4)
    setting = setting_of(Piece.plain(chart.plain), machine, WOOL)
    try:
        made = verified_twice(
            chart,
            finish=finish,
            machine=machine,
            stitch_number=setting.number,
            yarn=setting.yarn,
            looser=setting.looser,
        )
    except InputError as refusal:
        assert refusal.remedy  # noqa: PT017 - a refusal with its reason is right
        assert re.search("row [0-9]+, stitch|course [0-9]+", str(refusal))  # noqa: PT017
    else:
        problems = check_program(made.text, machine)
        assert {problem.subject for problem in problems} <= {"passes"}
        assert 2 * sum(problem.times for problem in problems) == made.tuck_passes


@of_each(PROGRAMMED)
@pytest.mark.parametrize(
    "rows",
    ["OK/;KKK", "KO)K;KKKK", "[1/2RPP]KP;KKKKK"],
    ids=["over the cast-on", "beside a decrease", "beside a cable"],
)
def test_lace_and_cables_of_the_first_row_are_knitted_or_refused(
    machine: MachineProfile, rows: str
) -> None:
    """Loops of a cast-on count, and those that stand aside for others may come back."""
    stitches_are_knitted_or_refused(machine, SymbolChart.parse(rows), Finish.WASTE)


@pytest.mark.slow
@settings(max_examples=12)
@given(
    chart=symbol_charts(most_rows=2, most_columns=6, turned=False), finish=st.sampled_from(Finish)
)
@of_each(PROGRAMMED)
def test_any_stitches_are_knitted_or_refused_with_what_helps(
    machine: MachineProfile, chart: SymbolChart, finish: Finish
) -> None:
    stitches_are_knitted_or_refused(machine, chart, finish)
