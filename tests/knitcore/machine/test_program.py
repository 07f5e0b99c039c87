import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from knitcore import Fabric, InputError, StitchChart
from knitcore.formats.read.knitout_reader import KnitoutMismatchError, knitted_chart, verified
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.program import Finish, knitout_program
from tests.knitcore.charts import stitch_charts
from tests.knitcore.pieces import pieces


@settings(max_examples=8)
@given(chart=stitch_charts(most=7))
@pytest.mark.parametrize("finish", list(Finish))
def test_the_machine_knits_the_chart(finish: Finish, chart: StitchChart) -> None:
    assert knitted_chart(verified(chart, finish=finish).text).chart == chart


@settings(max_examples=40)
@given(piece=pieces(most_rows=6, most_columns=8), finish=st.sampled_from(Finish))
@pytest.mark.slow
def test_the_machine_knits_outlines_and_colours(piece: Piece, finish: Finish) -> None:
    try:
        program = verified(piece, finish=finish)
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
    program = verified(Piece(chart, yarns, yarn_of))
    assert program.carriers == 3
    assert "; carrier 1 knits #0000ff blue\n" in program.text
    assert program.text.count("inhook") == 4  # and waste
    assert program.transfers == 0


def test_too_many_blocks_of_colour_are_refused() -> None:
    yarn_of = np.arange(12)[None, :] % 2
    chart = ShapedChart.rectangle(StitchChart.of_fabric("stockinette", rows=1, columns=12))
    with pytest.raises(InputError, match="blocks of colour to 12"):
        knitout_program(Piece(chart, (MAIN_YARN, PieceYarn("blue", "#0000ff")), yarn_of))


def test_single_steps_are_decreases_and_larger_ones_are_bound_off() -> None:
    outline = "....xxxx....\n.xxxxxxxxxx.\nxxxxxxxxxxxx"
    text = "\n".join(["K" * 12] * 3)
    program = verified(Piece.plain(ShapedChart.parse(text, outline)))
    assert program.transfers == 0
    assert program.shaping_transfers == 2 * (2 + 6)
    assert "rack 1" in program.text
    assert "rack -1" in program.text


@pytest.mark.parametrize(
    ("fabric", "transfers"), list(zip(Fabric, (0, 18, 0, 18), strict=True)), ids=list(Fabric)
)
def test_transfers_only_where_the_kind_changes_in_a_wale(fabric: Fabric, transfers: int) -> None:
    program = knitout_program(StitchChart.of_fabric(fabric, rows=4, columns=6))
    assert program.transfers == transfers
    assert program.text.count("xfer") == transfers


def test_32_x_32_is_exported_and_verified() -> None:
    chart = StitchChart(np.random.default_rng(1).random((32, 32)) < 0.5)
    assert verified(chart).text.count("\nknit") == 32 * 32 + 6 * 32


def test_a_chart_that_is_not_knitted_is_never_exported(monkeypatch: pytest.MonkeyPatch) -> None:
    other = knitout_program(StitchChart.parse("KP\nPP"))
    monkeypatch.setattr(
        "knitcore.formats.read.knitout_reader.knitout_program", lambda *_, **__: other
    )
    with pytest.raises(KnitoutMismatchError, match="another chart"):
        verified(StitchChart.parse("KP\nPK"))


def test_a_chart_wider_than_the_machine_is_refused() -> None:
    remedy = "needles.*2 pieces of 16; turned by a quarter it is 2 columns"
    with pytest.raises(InputError, match=remedy):
        knitout_program(StitchChart.of_fabric("rib", rows=2, columns=31), needles=30)


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
        (changed("tuck - f2 1\n", ""), r"course 1, needle f2 \(line 17\): a loop begun"),
        (changed("f2 1\n", "f3 1\n", "; course 2\n"), "course 2, needle f2 .*: a missed stitch"),
        (changed("outhook 1", "outhook 0"), "carrier 0 is not in"),
        ("x" * 5_000_000, "too long"),
    ],
    ids=["empty", "no instruction", "carrier not in", "gap", "miss", "no such carrier", "long"],
)
def test_programs_that_cannot_be_read(program: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        knitted_chart(program)
