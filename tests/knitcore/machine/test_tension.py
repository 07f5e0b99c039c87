"""The tension of transferred loops: its limits, what users report, and what is done about it."""

from dataclasses import replace

import pytest

from knitcore.base.errors import InputError
from knitcore.machine.profile import profile
from knitcore.machine.program_passes import Link, PulledLink
from knitcore.machine.tension import (
    BREAK_CHANCE,
    BREAK_RISK,
    TAKE_DOWN_N,
    LoopYarn,
    Verdict,
    loop_tension,
    pass_tensions,
    plan_safely,
    plan_tension,
    tightest_of,
)
from knitcore.machine.transfers import LoopMove, Needle, plan_transfers
from knitcore.materials import material

KNITERATE = profile("kniterate")
WOOL = LoopYarn.of(material("glove-wool"), loop_length_mm=10, linear_density_tex=250)
REST = Link(1, False, 1)


def pulled(needles: float, *, across: bool = True, neighbours: int = 3) -> PulledLink:
    beside = (REST,) * neighbours
    return PulledLink(Link(needles, across, 1), beside, beside)


def cable(width: int) -> list[LoopMove]:
    shifts = [0] * 3 + [width] * width + [-width] * width + [0] * 3
    return [
        LoopMove(Needle("f", n), Needle("f", n + shift), layer=shift)
        for n, shift in enumerate(shifts)
    ]


def test_a_straight_transfer_is_free_and_feels_the_take_down_only() -> None:
    tension = loop_tension(pulled(1), WOOL, KNITERATE)
    assert tension.verdict is Verdict.FREE
    assert TAKE_DOWN_N / 2 < tension.tension_n < TAKE_DOWN_N
    assert tension.break_chance == 0


def test_tension_grows_with_the_needles_between_the_hooks() -> None:
    tensions = [loop_tension(pulled(n), WOOL, KNITERATE) for n in range(7)]
    values = [of.tension_n for of in tensions]
    assert values == sorted(values)
    for of in tensions:
        low, high = of.tension_interval_n
        assert low < of.tension_n < high


def test_without_neighbours_the_yarn_stretches_by_what_is_lacking() -> None:
    known = replace(WOOL, friction_interval=(0.25, 0.2500001))
    alone = loop_tension(PulledLink(Link(3, True, 1), (), ()), known, KNITERATE)
    lacking = (alone.needed_mm - alone.own_mm) / (alone.own_mm - 1.9)
    assert alone.stretch == pytest.approx(lacking, rel=0.1)
    assert alone.tension_n == pytest.approx(alone.stretch * WOOL.axial_stiffness_n)


def test_neighbours_lend_less_the_more_friction_holds_their_yarn() -> None:
    smooth = replace(WOOL, friction=0.1, friction_interval=(0.09, 0.11))
    rough = replace(WOOL, friction=0.4, friction_interval=(0.36, 0.44))
    values = [loop_tension(pulled(5), yarn, KNITERATE).tension_n for yarn in (smooth, WOOL, rough)]
    assert values == sorted(values)


def test_yarn_laid_as_a_float_is_there_to_be_used() -> None:
    rested, floated = (
        loop_tension(PulledLink(Link(4, False, laid), (REST,), (REST,)), WOOL, KNITERATE)
        for laid in (1, 4)
    )
    assert rested.verdict is not Verdict.FREE
    assert floated.verdict is Verdict.FREE


@pytest.mark.parametrize(("width", "breaks"), [(1, False), (2, False), (4, True)])
def test_cables_that_users_knit_at_seven_gauge_hold_and_wider_ones_do_not(
    width: int, breaks: bool
) -> None:
    tension = plan_tension(plan_transfers(cable(width), most_rack=4), WOOL, KNITERATE)
    assert tension is not None
    assert (tension.verdict is Verdict.BREAKS) is breaks


def test_racking_beyond_two_needles_is_where_the_risk_begins() -> None:
    """One loop that stays on the other bed while the beds are racked."""
    chances = [loop_tension(pulled(rack + 1), WOOL, KNITERATE).break_chance for rack in range(6)]
    assert chances[:2] == [0, 0]
    assert chances[2] < BREAK_RISK
    assert chances[4] >= BREAK_CHANCE


@pytest.mark.slow
def test_more_yarn_in_the_stitch_lets_a_cable_pass() -> None:
    wide = replace(KNITERATE, racking=replace(KNITERATE.racking, most_needles=4))
    with pytest.raises(InputError, match="loops of") as error:
        plan_safely(cable(4), WOOL, wide)
    enough = float(str(error.value).split("loops of ")[1].split(" mm")[0])
    assert 10 < enough < 20
    longer = replace(WOOL, loop_length_mm=enough + 0.1)
    assert plan_safely(cable(4), longer, wide).tightest is not None


def test_passes_are_saved_where_the_yarn_stands_it_and_staged_where_not() -> None:
    """Both edges move inwards: three passes pull their neighbours three needles apart, four one."""
    shifts = [1, 1, 1] + [0] * 4 + [-1, -1, -1]
    moves = [LoopMove(Needle("f", n), Needle("f", n + shift)) for n, shift in enumerate(shifts)]
    loose = plan_safely(moves, WOOL, KNITERATE)
    short = plan_safely(moves, replace(WOOL, loop_length_mm=7.5), KNITERATE)
    assert len(loose.plan.passes) == 3
    assert not loose.note
    assert len(short.plan.passes) == 4
    assert "instead of 3" in short.note
    assert short.to_dict()["tightest"]["break_chance"] < BREAK_RISK


def test_a_single_bed_is_left_to_the_hand() -> None:
    with pytest.raises(InputError, match="no second bed"):
        plan_safely(cable(1), WOOL, profile("brother"))


def test_a_profile_may_give_the_gap_and_the_take_down() -> None:
    guessed = loop_tension(pulled(3), WOOL, KNITERATE)
    narrow = replace(KNITERATE, bed_gap_mm=2.0)
    assert loop_tension(pulled(3), WOOL, narrow).needed_mm < guessed.needed_mm
    heavy = replace(KNITERATE, take_down_n=1.0)
    assert loop_tension(pulled(0), WOOL, heavy).tension_n == pytest.approx(0.5, rel=0.3)


def test_a_program_names_the_line_of_its_tightest_loop() -> None:
    knits = [f"knit + f{n} 1" for n in range(1, 12)]
    moves = ["xfer f5 b5", "xfer f6 b6", "rack 2", "xfer b5 f7", "rack 0", "xfer b6 f6"]
    passes = pass_tensions("\n".join([*knits, *moves]), WOOL, KNITERATE)
    tightest = tightest_of(passes)
    assert tightest is not None
    assert [step.rack for step in passes] == [0, 2, 0]
    assert (tightest.line, tightest.rack) == (15, 2)
    assert tightest.to_dict()["tightest"]["needles"] == 3


def test_a_yarn_needs_a_loop_length_and_a_weight() -> None:
    acrylic = material("acrylic")
    assert LoopYarn.of(acrylic).loop_length_mm == pytest.approx(13.4, abs=0.1)
    nameless = replace(acrylic, identifier="x", yarn=replace(acrylic.yarn, diameter_mm=None))
    with pytest.raises(InputError, match="tex"):
        LoopYarn.of(nameless)
    unmeasured = {f: replace(r, loop_length_mm=None) for f, r in acrylic.fabrics.items()}
    with pytest.raises(InputError, match="loop length"):
        LoopYarn.of(replace(acrylic, fabrics=unmeasured))
