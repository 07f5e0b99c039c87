"""Plans for home machines, knitted in thought."""

import numpy as np
import pytest

from knitcore import InputError, StitchChart
from knitcore.base.arrays import Mask
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart
from knitcore.machine.home.hand_plan import MAX_LADDER, hand_plan
from knitcore.machine.home.plan_rows import Act, HandPlan, Task
from knitcore.machine.profile import profile

SHAPED = ShapedChart.parse(
    "KPKKKK\nPPKPPP\nKKPPKP\nKPKKKK\nKKKKKK", "...xx.\n.xxxx.\nxxxxxx\n.xxxx.\nxxxx.."
)


def tasks(plan: HandPlan, act: Act) -> list[Task]:
    return [task for task in plan.tasks if task.act is act]


def knitted(plan: HandPlan, toward: bool) -> tuple[Mask, Mask]:
    """The purls and the stitches of the right side that somebody makes who follows a plan.

    ``toward`` says whether the right side looks at the knitter in row 1.
    """
    places = {name: place for place, name in enumerate(plan.needles)}
    shape = len(plan.rows), plan.width
    seen_knit, stitch = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)
    sides = np.zeros(len(plan.rows), dtype=bool)
    ribber = {plan.rows[0].first + index for index, other in enumerate(plan.rows[0].other) if other}
    for at, row in enumerate(plan.rows):
        toward ^= any(task.act is Act.TURN for task in row.before)
        sides[at] = toward
        here = range(row.first, row.first + len(row.other))
        stitch[at, here] = True
        for task in row.before:
            if task.act is Act.TRANSFER:
                ribber ^= {places[name] for name in task.needles}
        if plan.ribber:
            made = {row.first + index for index, other in enumerate(row.other) if other}
            kept = {place for place in here if at and stitch[at - 1, place]}
            assert ribber & kept == made & kept
            ribber = made
            seen_knit[at, sorted(made)] = True
        for task in row.after:
            assert task.rows is not None
            first, last = task.rows
            assert last == row.number
            for name in task.needles:
                assert not seen_knit[first - 1 : last, places[name]].any()
                seen_knit[first - 1 : last, places[name]] = True
                assert (sides[first - 1 : last] == toward).all()  # no ladder through a turn
    purl = seen_knit != sides[:, None]  # a knit towards the knitter is a purl of a face turned away
    for at, side in enumerate(sides):
        if not side:
            purl[at], stitch[at] = purl[at, ::-1], stitch[at, ::-1]
    return purl & stitch, stitch


def first_side(plan: HandPlan, piece: Piece) -> bool:
    """The side of row 1 that gives its outline and stitches, if only one does."""
    for toward in (False, True):
        purl, stitch = knitted(plan, toward)
        if np.array_equal(stitch, piece.shaped.stitch) and np.array_equal(
            purl, piece.chart.purl & stitch
        ):
            return toward
    raise AssertionError("the plan knits another piece")


@pytest.mark.parametrize("machine", ["brother", "brother-ribber", "silver-reed", "ayab"])
@pytest.mark.parametrize("seed", range(6))
def test_whoever_follows_a_plan_knits_the_chart(machine: str, seed: int) -> None:
    random = np.random.default_rng(seed)
    purl = random.random((14, 9)) < (0.2, 0.8)[seed % 2]
    purl[4:8] = random.random() < 0.5  # rows that are turned where that is quicker
    piece = Piece.plain(StitchChart(purl))
    first_side(hand_plan(piece, profile(machine)), piece)


@pytest.mark.parametrize("machine", ["brother", "brother-ribber"])
@pytest.mark.parametrize("swap", [False, True])
@pytest.mark.parametrize("mirror", [False, True])
def test_shaped_pieces_have_their_edges_on_the_right_needles(
    machine: str, swap: bool, mirror: bool
) -> None:
    chart, stitch = SHAPED.chart, SHAPED.stitch
    if swap:
        chart = chart.swap()
    if mirror:
        chart, stitch = chart.mirror(), stitch[:, ::-1]
    piece = Piece.plain(ShapedChart(chart, stitch))
    plan = hand_plan(piece, profile(machine))
    first_side(plan, piece)
    edges = {name for task in tasks(plan, Act.SHAPE) for name in task.needles}
    outer = [f"{side}{n}" for side, n in (("L", 3), ("R", 3))]
    assert set(outer) & edges


def test_a_rib_is_dropped_in_whole_columns_and_latched_up_once() -> None:
    plan = hand_plan(StitchChart.of_fabric("rib", rows=20, columns=6), profile("brother"))
    (task,) = tasks(plan, Act.REFORM)
    assert task.rows == (1, 20)
    assert len(plan.blocks) == 1
    assert task.words == "Drop the stitches of L3, L1 and R2 down 20 rows and latch up as knits."


def test_long_ladders_are_latched_up_on_the_way() -> None:
    chart = StitchChart.parse("KPKK").resized(3 * MAX_LADDER, 4)
    depths = [t.rows for t in tasks(hand_plan(chart, profile("brother")), Act.REFORM)]
    assert depths == [(1, 30), (31, 60), (61, 90)]


def test_whole_rows_of_purls_are_turned_with_the_garter_bar_where_that_is_quicker() -> None:
    purl = np.zeros((30, 60), dtype=bool)
    purl[10:20] = True
    wide, narrow = (hand_plan(StitchChart(p), profile("brother")) for p in (purl, purl[:, :4]))
    assert [row.number for row in wide.rows if row.before] == [11, 21]
    assert not tasks(wide, Act.REFORM)
    assert not tasks(narrow, Act.TURN)
    # the yarn is at the other side once the work is turned
    assert wide.rows[10].leftwards == wide.rows[9].leftwards


def test_a_yarn_that_has_not_arrived_is_replaced_by_a_strand_as_seldom_as_can_be() -> None:
    """Two stitches are bound off where a row begins, whichever side that is."""
    outline = "xxxx..\nxxxx..\nxxxxxx\nxxxxxx"
    for text in (outline, "\n".join(line[::-1] for line in outline.splitlines())):
        for rows in (text, text.replace("xxxxxx\nxxxxxx", "xxxxxx", 1)):
            chart = "\n".join("KKKKKK" for _ in rows.splitlines())
            plan = hand_plan(Piece.plain(ShapedChart.parse(chart, rows)), profile("brother"))
            (task,) = tasks(plan, Act.SHAPE)
            assert "strand" not in task.words


def test_yarns_are_laid_over_their_needles_as_the_knitter_sees_them() -> None:
    yarn_of = np.array([[0, 0, 0, 1], [0, 0, 0, 1], [1, 1, 1, 1]])
    yarns = (PieceYarn("wool", "#ffffff"), PieceYarn("silk", "#ff0000"))
    chart = StitchChart(np.zeros((3, 4), dtype=bool))
    plan = hand_plan(Piece(ShapedChart.rectangle(chart), yarns, yarn_of), profile("brother"))
    words = [task.words for task in tasks(plan, Act.YARNS)]
    assert words == [
        "Intarsia, from the left: B (silk) on L2; A (wool) on L1–R2.",
        "Yarn B (silk) on L2–R2.",
    ]
    assert [bool(row.before) for row in plan.rows] == [True, False, True]
    assert "Each block has a ball of its own" in plan.opening[-1]
    assert not any("Intarsia" in line for line in hand_plan(chart, profile("brother")).opening)


def test_equal_groups_of_rows_are_written_once() -> None:
    plan = hand_plan(StitchChart.of_fabric("seed", rows=12, columns=14), profile("brother"))
    assert [section.heading for section in plan.sections] == [
        "Row 1, carriage at the right",
        "Row 2, carriage at the left",
        "Rows 3–12: repeat rows 1–2",
    ]
    assert "minutes (re-forming" in plan.text


def test_a_ribber_is_told_where_one_bed_would_be_quicker() -> None:
    spots = StitchChart.parse("/".join(["KKKKKKKKKK"] * 3 + ["KKPPPPPPKK"]).replace("/", "\n"))
    plan = hand_plan(spots.tile(3, 1), profile("brother-ribber"))
    quicker = any(note.startswith("Without the ribber") for note in plan.notes)
    assert quicker == (hand_plan(spots.tile(3, 1), profile("brother")).minutes < plan.minutes)


def test_a_plan_goes_on_at_any_row_with_what_hangs_on_the_needles() -> None:
    chart = StitchChart.of_fabric("seed", rows=6, columns=6)
    for machine in ("brother", "brother-ribber"):
        plan = hand_plan(chart, profile(machine))
        rest = plan.resumed(4)
        assert rest.rows == plan.rows[3:]
        assert rest.minutes < plan.minutes
        assert rest.opening[0].startswith("Hang the 6 stitches of row 3 on ")
        assert rest.opening[0].endswith("The carriage is at the left.")
    assert "main bed L2, R1 and R3, ribber L3, L1 and R2" in rest.opening[0]
    assert plan.resumed(1) is plan
    with pytest.raises(InputError, match="there is no row 7: the piece has 6"):
        plan.resumed(7)


def test_a_plan_that_goes_on_with_a_turn_says_where_the_carriage_is_before_it() -> None:
    purl = np.zeros((30, 60), dtype=bool)
    purl[10:20] = True
    rest = hand_plan(StitchChart(purl), profile("brother")).resumed(11)
    assert "The carriage is at the left" not in rest.opening[0] or not rest.rows[0].leftwards
    assert rest.opening[0].endswith("The carriage is at the left.") == rest.rows[0].leftwards


def test_machines_that_are_not_worked_by_hand_and_beds_that_are_too_narrow_are_refused() -> None:
    chart = StitchChart.of_fabric("rib", rows=4, columns=201)
    with pytest.raises(InputError, match="2 pieces of at most 101"):
        hand_plan(chart, profile("brother"))
    with pytest.raises(InputError, match="not worked by hand"):
        hand_plan(chart, profile("kniterate"))
