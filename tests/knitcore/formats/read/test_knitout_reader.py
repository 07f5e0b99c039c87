"""Programs as other tools write them, small and by hand."""

from collections.abc import Iterator, Sequence

import pytest

from knitcore import InputError
from knitcore.formats.read.chart_files import PieceInFile
from knitcore.formats.read.knitout_reader import knitted_chart

HEAD = [";!knitout-2", ";;Machine: SWG091N2", ";;Carriers: 1 2 3"]


def tucks(carrier: str, width: int, step: int = 1) -> list[str]:
    """An alternate tuck cast-on, leftwards and back."""
    needles = range(step, step * width + 1, step)
    back = list(needles)[-2::-2][::-1]
    return [
        f"inhook {carrier}",
        *(f"tuck - f{n} {carrier}" for n in list(needles)[::-2]),
        *(f"tuck + f{n} {carrier}" for n in back),
        f"releasehook {carrier}",
    ]


def on(beds: str, step: int = 1) -> list[str]:
    """Needles of the beds, ``f`` or ``b``, from left to right."""
    return [f"{bed}{step * (place + 1)}" for place, bed in enumerate(beds)]


def courses(carrier: str, needles: str | list[str], rows: int, *, first: int = 0) -> Iterator[str]:
    """Courses on needles, or on those of some beds; odd ones leftwards."""
    needles = on(needles) if isinstance(needles, str) else needles
    for row in range(first, first + rows):
        sign, order = ("+", needles) if row % 2 else ("-", needles[::-1])
        yield from (f"knit {sign} {needle} {carrier}" for needle in order)


def dropped(beds: str) -> list[str]:
    return [f"drop {bed}{n}" for n, bed in enumerate(beds, 1)]


def read(*lines: str, head: Sequence[str] = HEAD) -> PieceInFile:
    return knitted_chart("\n".join([*head, *lines]) + "\n")


def stockinette(rows: int, width: int = 6) -> list[str]:
    return [*tucks("1", width), *courses("1", "f" * width, rows)]


def test_extensions_headers_and_comments_are_told_and_have_no_effect() -> None:
    head = [
        ";!knitout-2",
        ";;Machine: SWGXYZ",
        ";;X-Loop-Length: 6.2",
        ";;Width: 540",
        ";;Carriers: 1 2 3 4 5 6 7 8 9 10 11 12",
        ";",
        "x-stitch-number 61",
    ]
    body = [*stockinette(3), "x-roller-advance 100", "outhook 1 ; the end"]
    knitted = read(*body, head=head)
    assert knitted.chart.text == "\n".join(["K" * 6] * 3)
    notes = "\n".join(knitted.notes)
    assert "machine SWGXYZ" in notes
    assert "X-Loop-Length (line 3)" in notes
    assert "x-stitch-number (1 line from line 7)" in notes
    assert "Width" not in notes


@pytest.mark.parametrize("ends", ["\r\n", "\r", "\n"])
def test_marks_and_line_ends_of_other_systems(ends: str) -> None:
    program = "\ufeff" + ends.join([*HEAD, *stockinette(2), ""])
    assert knitted_chart(program).chart.text == "KKKKKK\nKKKKKK"
    with pytest.raises(InputError, match="line 7: 'fly'"):
        knitted_chart("\ufeff" + ends.join([*HEAD, "", "", "", "fly f1"]))


def test_needles_below_zero_and_carriers_of_any_name() -> None:
    lines = ["in Yellow", *(f"tuck - f{n} Yellow" for n in (2, 0, -2))]
    lines += [f"tuck + f{n} Yellow" for n in (-1, 1)]
    lines += [f"knit - f{n} Yellow" for n in (2, 1, 0, -1, -2)]
    assert read(*lines, head=[";!knitout-2", ";;Carriers: Yellow"]).chart.text == "KKKKK"


def test_half_gauge() -> None:
    lines = [*tucks("1", 5, step=2), *courses("1", on("fffff", 2), 2)]
    knitted = read(*lines, "xfer f4 b4", "xfer f8 b8", *courses("1", on("fbfbf", 2), 2))
    assert knitted.chart.text == "KPKPK\nKPKPK\nKKKKK\nKKKKK"
    assert "Every second needle knits" in knitted.notes[0]


def test_stitches_of_the_other_bed_lie_between() -> None:
    """A rib cast on and knitted on alternate needles of both beds."""
    beds = "bfbfbf"
    lines = ["in 1", *(f"tuck - {bed}{n} 1" for n, bed in reversed(list(enumerate(beds, 1))))]
    lines += list(courses("1", beds, 3, first=1))
    assert read(*lines).chart.text == "\n".join(["PKPKPK"] * 3)


def test_racked_beds_make_a_wale_of_every_needle() -> None:
    needles = ["f1", "f2", "b2", "b3", "f4", "f5", "b5", "b6"]
    knitted = read("in 1", "rack 0.25", *courses("1", needles, 4))
    assert knitted.chart.text == "\n".join(["KKPPKKPP"] * 3)


def test_the_start_of_a_rib_on_other_needles_is_left_out() -> None:
    width = 8
    lines = [*tucks("1", width), *courses("1", "f" * width, 1), "rack 0.25"]
    needles = [f"{bed}{n}" for n in range(1, width + 1) for bed in "fb"]
    knitted = read(*lines, *courses("1", needles, 13, first=1))
    assert knitted.chart.text == "\n".join(["KP" * width] * 12)
    assert any("knitted on other needles before the piece" in note for note in knitted.notes)


@pytest.mark.parametrize("rounds", [1, 3])
def test_a_tubular_start_belongs_to_the_cast_on(rounds: int) -> None:
    lines = ["in 1", *(f"tuck - {bed}{n} 1" for n, bed in reversed(list(enumerate(RIB, 1))))]
    around = [f"knit + f{n} 1" for n in (2, 4, 6)] + [f"knit - b{n} 1" for n in (5, 3, 1)]
    knitted = read(*lines, *around * rounds, *courses("1", RIB, 4, first=1))
    assert knitted.chart.text == "\n".join(["PKPKPK"] * 4)
    assert "tubular start" in knitted.notes[0]


def test_a_first_course_that_closes_the_cast_on() -> None:
    lines = ["in 1", *(f"tuck - f{n} 1" for n in (4, 3, 2, 1))]
    lines += [f"knit + f{n} 1" for n in (2, 3, 4)]
    knitted = read(*lines, *courses("1", "ffff", 3))
    assert knitted.chart.text == "\n".join(["KKKK"] * 3)
    assert "does not reach needle f1" in knitted.notes[0]


def test_an_edge_slipped_in_every_second_course_is_left_out() -> None:
    lines = tucks("1", 6)
    for row in range(1, 9):
        lines += courses("1", "f" * (6 if row % 2 else 5), 1, first=row)
    knitted = read(*lines)
    assert knitted.chart.text == "\n".join(["K" * 5] * 8)
    assert "slipped" in knitted.notes[0]


RIB = "bfbfbf"


def test_waste_before_a_piece_is_what_it_stands_on() -> None:
    waste = [*tucks("2", 6), *courses("2", "f" * 6, 4), "outhook 2"]
    crossed = [f"xfer f{n} b{n}" for n, bed in enumerate(RIB, 1) if bed == "b"]
    knitted = read(*waste, *crossed, "inhook 1", *courses("1", RIB, 5), *dropped(RIB))
    assert knitted.chart.text == "\n".join(["PKPKPK"] * 5)
    note = "stands on what carrier 2 knits before it (24 stitches, lines 12 to 35)"
    assert note in knitted.notes[0]


def test_waste_of_interlock_may_be_larger_than_the_piece() -> None:
    waste = ["in 2"]
    for row in range(30):
        beds = "fb" * 3 if row % 2 else "bf" * 3
        waste += courses("2", beds, 1, first=row)
    waste += [f"drop b{n}" for n in range(1, 7)]
    knitted = read(*waste, "in 1", *courses("1", "f" * 6, 4))
    assert knitted.chart.text == "\n".join(["KKKKKK"] * 4)
    assert "carrier 2" in knitted.notes[0]


def test_waste_and_a_draw_thread_on_both_sides() -> None:
    lines = [*tucks("2", 6), *courses("2", "f" * 6, 4), "in 3", *courses("3", "f" * 6, 1)]
    lines += ["in 1", *courses("1", "f" * 6, 12), *courses("3", "f" * 6, 1)]
    knitted = read(*lines, *courses("2", "f" * 6, 4))
    assert knitted.chart.rows == 12
    assert len([note for note in knitted.notes if note.startswith("Waste")]) == 4


def test_waste_after_a_piece_hangs_from_it() -> None:
    """More waste than piece, but only the piece makes its pattern."""
    lines = ["in 1", *(f"tuck - {b}{n} 1" for n, b in reversed(list(enumerate(RIB, 1))))]
    lines += [*courses("1", RIB, 4, first=1), "out 1", "in 2", *courses("2", RIB, 6)]
    knitted = read(*lines, *dropped(RIB))
    assert knitted.chart.text == "\n".join(["PKPKPK"] * 4)
    assert "hangs from it" in knitted.notes[0]


def waste(rows: int, *then: str, ended: bool = True) -> list[str]:
    """Plain courses of carrier 2, which begin a program."""
    return [*tucks("2", 6), *courses("2", "f" * 6, rows), *["outhook 2"] * ended, *then]


CHAIN = [
    line
    for n in range(1, 6)
    for line in (f"xfer f{n} b{n}", "rack 1", f"xfer b{n} f{n + 1}", "rack 0", f"knit + f{n + 1} 1")
]
CHAIN += ["knit - f6 1", "knit + f6 1"] * 2
NARROWED = ["xfer f6 b6", "rack -1", "xfer b6 f5", "rack 0", *courses("1", "f" * 5, 2, first=1)]


@pytest.mark.parametrize(
    ("lines", "text"),
    [
        ([*waste(24), "in 1", *courses("1", "f" * 6, 15), *CHAIN], ["K" * 6] * 15),
        (
            [*waste(12, "in 3", *courses("3", "f" * 6, 1), "in 1", ended=False),
             *courses("1", "f" * 6, 4, first=1), *courses("3", "f" * 6, 1, first=1),
             *courses("2", "f" * 6, 12)],
            ["K" * 6] * 4,
        ),
        ([*waste(8), *tucks("1", 6), *courses("1", "f" * 6, 3)], ["K" * 6] * 3),
        (
            [*waste(5), "in 1", *courses("1", "f" * 6, 1), *NARROWED],
            ["K" * 6] * 3,
        ),
    ],
    ids=["bound off", "between draw threads", "with its own cast-on", "shaped"],
)  # fmt: skip
def test_a_piece_may_be_smaller_than_its_plain_waste(lines: list[str], text: list[str]) -> None:
    knitted = read(*lines)
    assert knitted.chart.text == "\n".join(text)
    assert any(note.startswith("Waste: ") and "carrier 2" in note for note in knitted.notes)


@pytest.mark.parametrize("tuck", [False, True])
@pytest.mark.parametrize("tag", [0, 3])
def test_a_bind_off_that_begins_with_a_stitch(tuck: bool, tag: int) -> None:
    lines = stockinette(4)
    for n in range(6, 1, -1):
        lines += [f"knit - f{n} 1", f"xfer f{n} b{n}", "rack -1", f"xfer b{n} f{n - 1}", "rack 0"]
        lines += [f"tuck + b{n} 1"] * tuck
    lines += ["knit - f1 1", *["knit + f1 1", "knit - f1 1"][:tag], "outhook 1", "drop f1"]
    assert read(*lines).chart.text == "\n".join(["K" * 6] * 4)


def around_needles(carrier: str, rows: int) -> list[str]:
    """Waste on both beds in turn, of which the back loops are dropped."""
    lines = [f"in {carrier}"]
    for row in range(rows):
        lines += courses(carrier, "fb" * 3 if row % 2 else "bf" * 3, 1, first=row)
    return [*lines, *(f"drop b{n}" for n in range(1, 7))]


@pytest.mark.parametrize("thread", [[], ["in 3", *courses("3", "f" * 6, 1)]])
def test_yarn_that_is_waste_before_a_piece_is_waste_after_it(thread: list[str]) -> None:
    lines = [*around_needles("2", 10), *thread, "in 1", *courses("1", "f" * 6, 6, first=1)]
    knitted = read(*lines, *courses("2", "f" * 6, 10, first=1))
    assert knitted.chart.text == "\n".join(["KKKKKK"] * 6)
    assert any("what carrier 2 knits after the piece" in note for note in knitted.notes)


def test_waste_after_purls_has_no_pattern_of_its_own() -> None:
    lines = stockinette(4)
    to_back, to_front = ([f"xfer {a}{n} {b}{n}" for n in range(1, 7)] for a, b in ("fb", "bf"))
    lines += [*to_back, *courses("1", "b" * 6, 2), *to_front, *courses("1", "f" * 6, 2)]
    lines += [*to_back, *courses("1", "b" * 6, 2), *to_front, "in 2", *courses("2", "f" * 6, 12)]
    assert read(*lines).chart.repeat_cut().key == "P/P/K/K/P/P/K/K/K/K"


def test_blocks_of_colour_in_a_rib_are_stripes() -> None:
    lines = ["in 1", *(f"tuck - {b}{n} 1" for n, b in reversed(list(enumerate(RIB, 1))))]
    lines += [*courses("1", RIB, 4, first=1), "out 1", "in 2", *courses("2", RIB, 4, first=1)]
    lines += ["out 2", "in 3", *courses("3", RIB, 4, first=1)]
    assert read(*lines).piece.yarn_of[:, 0].tolist() == [0] * 4 + [1] * 4 + [2] * 4


def test_plain_courses_of_a_yarn_around_a_patterned_piece_are_waste() -> None:
    crossed = [f"xfer f{n} b{n}" for n, bed in enumerate(RIB, 1) if bed == "b"]
    lines = [*waste(12, ended=False), *crossed, "in 1", *courses("1", RIB, 6)]
    lines += [f"xfer b{n} f{n}" for n, bed in enumerate(RIB, 1) if bed == "b"]
    knitted = read(*lines, *courses("2", "f" * 6, 12))
    assert knitted.chart.text == "\n".join(["PKPKPK"] * 6)


def beside_thread(before: int, after: int) -> list[str]:
    """Plain courses of carrier 2, one of carrier 3, and plain courses of carrier 1."""
    lines = [*waste(before), "in 3", *courses("3", "f" * 6, 1, first=before), "out 3", "in 1"]
    return [*lines, *courses("1", "f" * 6, after, first=before + 1)]


def test_a_draw_thread_parts_waste_from_a_larger_piece() -> None:
    assert read(*beside_thread(6, 8)).chart.rows == 8


def test_a_piece_smaller_than_what_lies_before_its_draw_thread_is_a_question() -> None:
    with pytest.raises(InputError, match=r"carrier 3 knits one course \(line 134\)") as refused:
        read(*beside_thread(20, 6))
    assert "; carrier 1 knits #efe9dd wool" in refused.value.remedy
    answered = read("; carrier 1 knits #efe9dd wool", *beside_thread(20, 6))
    assert answered.chart.rows == 6


def test_a_note_says_where_only_size_tells_waste_from_the_piece() -> None:
    knitted = read(*waste(12), "in 1", *courses("1", "f" * 6, 4))
    assert knitted.notes[0].startswith("Waste, by its size alone: what carrier 1 knits after")


def test_a_thin_stripe_does_not_end_the_piece() -> None:
    lines = [*stockinette(9), "in 3", *courses("3", "f" * 6, 2, first=1)]
    knitted = read(*lines, *courses("1", "f" * 6, 9, first=1))
    assert knitted.piece.yarn_of[:, 0].tolist() == [0] * 9 + [1] * 2 + [0] * 9


def test_stripes_are_yarns_of_the_piece() -> None:
    lines = [*tucks("1", 6), *courses("1", "f" * 6, 2), "inhook 3", *courses("3", "f" * 6, 2)]
    lines += [*courses("1", "f" * 6, 2), *courses("3", "f" * 6, 2), "outhook 1", "outhook 3"]
    knitted = read(*lines)
    assert [yarn.name for yarn in knitted.piece.yarns] == ["carrier 1", "carrier 3"]
    assert knitted.piece.yarn_of[:, 0].tolist() == [0, 0, 1, 1, 0, 0, 1, 1]
    assert "carriers 1, 3" in knitted.notes[0]


def test_colours_of_carriers_are_taken() -> None:
    head = [*HEAD, "x-vis-color #ff0000 1", "x-vis-color #00ff00 3"]
    lines = [*tucks("1", 6), *courses("1", "f" * 6, 2), "in 3", *courses("3", "f" * 6, 2)]
    assert [y.colour for y in read(*lines, head=head).piece.yarns] == ["#ff0000", "#00ff00"]


def test_stranded_colours_are_read_without_their_floats() -> None:
    lines = [*tucks("1", 6), *courses("1", "f" * 6, 1), "in 2"]
    lines += [f"knit - f{n} 2" for n in (6, 4, 2)] + [f"knit + f{n} 1" for n in (1, 3, 5)]
    knitted = read(*lines)
    assert knitted.piece.yarn_of[1].tolist() == [0, 1, 0, 1, 0, 1]
    assert "float" in knitted.notes[-1]


def test_transfers_and_racks_that_return() -> None:
    lines = stockinette(2)
    lines += ["xfer f3 b3", "rack 1", "rack 0", "xfer b3 f3", "rack -2", "rack 0"]
    assert read(*lines, *courses("1", "f" * 6, 2)).chart.rows == 4


RIGHTWARDS = [f"knit + f{n} 1" for n in range(1, 7)]


def leftwards(*without: int) -> list[str]:
    """A course of six needles without those in question."""
    return [f"knit - f{n} 1" for n in range(6, 0, -1) if n not in without]


CROSSING = ["xfer f3 b3", "xfer f4 b4", "rack 1", "xfer b3 f4", "rack -1", "xfer b4 f3", "rack 0"]
CROSSING += leftwards()


@pytest.mark.parametrize(
    ("then", "says"),
    [
        (
            ["knit - f6 1", "knit - f5 1", "tuck - f4 1", *leftwards(4, 5, 6), *RIGHTWARDS],
            r"course 3, needle f4 \(line 26\): a tuck",
        ),
        ([*leftwards(4), *RIGHTWARDS], "course 3, needle f4 .*: a missed"),
        (
            ["xfer f3 b3", "rack 1", "xfer b3 f4", "rack 0", *leftwards()],
            r"course 3, needle f[34] .*: a lace",
        ),
        (CROSSING, r"course 3, needle f4 .*: a cable"),
        (["split - f4 b4 1", *leftwards(4)], r"needle f4 \(line 24\): a split"),
        (["drop f4", *leftwards(4)], "needle f4 .*: a dropped"),
        ([*leftwards(1, 2), *(f"knit + f{n} 1" for n in range(3, 7)), *leftwards()], "short row"),
        (
            [
                f"knit {'+' if row % 2 else '-'} {'b' if row % 2 else 'f'}{n} 1"
                for row in range(6)
                for n in (range(1, 7) if row % 2 else range(6, 0, -1))
            ],
            "both beds",
        ),
    ],
    ids=["tuck", "miss", "lace", "cable", "split", "drop", "short row", "tube"],
)
def test_other_kinds_of_stitch_are_refused_by_place(then: list[str], says: str) -> None:
    with pytest.raises(InputError, match=says) as refused:
        read(*stockinette(2), *then)
    assert "shaped at the edges" in refused.value.remedy


def test_interlock_is_refused() -> None:
    lines = ["in 3"]
    for row in range(8):
        lines += courses("3", "bf" * 4 if row % 2 else "fb" * 4, 1, first=row)
    with pytest.raises(InputError, match=r"course 1, .*interlock"):
        read(*lines)


def test_two_pieces_are_refused() -> None:
    other = [line.replace(" f", " f10") for line in [*tucks("2", 6), *courses("2", "f" * 6, 4)]]
    with pytest.raises(InputError, match="not joined"):
        read(*stockinette(4), *other)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("knit * f1 1", "line 4: .* not a direction"),
        ("knit + q1 1", "line 4: 'q1' is not a needle"),
        ("knit + f1 1", "line 4: carrier 1 is not in"),
        ("knit +", "line 4: an operand is missing"),
        ("rack left", "line 4: .* not a number"),
        ("xfer f1 b2", "line 4: f1 and b2 do not face each other at rack 0"),
        ("out 1", "line 4: carrier 1 is not in"),
    ],
)
def test_mistakes_are_named_by_line(line: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read(line)
