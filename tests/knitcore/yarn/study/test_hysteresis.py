"""Loops of loading and unloading, and rest sizes that remember."""

from dataclasses import replace

import numpy as np
import pytest

from knitcore import Direction, InputError
from knitcore.yarn.study.hysteresis import History, at_rest, hysteresis, pull, rest_sizes
from tests.knitcore.yarn.solve.test_friction import forces, stockinette, walk

__all__ = ["stockinette"]


@pytest.fixture(scope="module")
def loop(stockinette):
    return hysteresis(stockinette, "course", 0.2, 0.25, points=11)


def test_the_loop_closes_after_the_first_cycle(loop):
    first, _, again, last = loop.legs
    assert [leg.loading for leg in loop.legs] == [True, False, True, False]
    assert loop.closes_within < 0.02
    # the second cycle begins where the first ended, stretched
    assert again.strain[0] == first.strain[0] + loop.legs[1].strain[-1] > 0.005
    assert last.strain[-1] == pytest.approx(again.strain[0], abs=2e-3)


def test_unloading_takes_less_force(loop):
    there, back = loop.legs[2], loop.legs[3]
    known = np.interp(there.strain[2:-1], back.strain[::-1], back.stress_n_per_mm[::-1])
    assert np.all(known < 0.92 * there.stress_n_per_mm[2:-1])
    # the first step back is stiffer than the last one there
    pulling = np.diff(there.stress_n_per_mm[-2:]) / np.diff(there.strain[-2:])
    easing = np.diff(back.stress_n_per_mm[:2]) / np.diff(back.strain[:2])
    assert 1.5 < easing / pulling < 3.0


def test_the_area_of_the_loop_is_the_work_against_friction(loop):
    area = loop.zero.cell_course_mm * loop.zero.cell_wale_mm
    assert loop.lost_per_cycle_n_per_mm * area == pytest.approx(loop.lost_n_mm[2:].sum(), rel=0.02)
    assert 0.05 < loop.lost_share < 0.5
    assert loop.notes == ()


@pytest.mark.slow
def test_a_loop_near_locking_changes_little_with_more_points(stockinette):
    coarse, fine = (
        hysteresis(stockinette, "wale", 0.3, 0.25, points=points, cycles=1) for points in (24, 48)
    )
    top, top_of_fine = (loop.legs[-2].stress_n_per_mm[-1] for loop in (coarse, fine))
    assert top == pytest.approx(top_of_fine, rel=0.03)
    lost = fine.lost_per_cycle_n_per_mm
    assert coarse.lost_per_cycle_n_per_mm == pytest.approx(lost, rel=0.03)


def test_a_loop_of_too_few_points_says_so(stockinette):
    loop = hysteresis(stockinette, "wale", 0.3, 0.25, points=4, cycles=1)
    (note,) = loop.notes
    assert "differ by 26 %: take more points" in note


def test_the_last_cycle_is_one_stretch_there_and_back(loop):
    cycle, (there, back) = loop.last_cycle, loop.legs[-2:]
    assert np.argmax(cycle.strain) == loop.turn == len(there.strain) - 1
    np.testing.assert_array_equal(cycle.strain, [*there.strain, *back.strain[1:]])
    np.testing.assert_array_equal(
        cycle.stress_n_per_mm, [*there.stress_n_per_mm, *back.stress_n_per_mm[1:]]
    )
    assert cycle.energy_n_mm[loop.turn] > cycle.energy_n_mm[-1]


def test_a_pull_is_the_first_leg_of_a_loop(stockinette, loop):
    alone = pull(stockinette, "course", 0.2, 0.25, points=11)
    np.testing.assert_allclose(alone.stress_n_per_mm, loop.legs[0].stress_n_per_mm, rtol=1e-9)
    assert alone.cells[0].state is stockinette.state
    stopped = pull(stockinette, "course", 0.2, 0.25, points=11, max_stress_n_per_mm=0.03)
    beyond = np.flatnonzero(alone.stress_n_per_mm > 0.03)
    assert len(stopped.cells) == beyond[0] + 1


@pytest.mark.slow
def test_a_pull_may_begin_where_other_pulls_have_left_the_fabric(stockinette):
    worn = at_rest(stockinette, "stretched-course", 0.25)
    again = pull(worn, "course", 0.1, 0.25, points=6)
    assert again.strain[0] == 0.0
    assert abs(again.stress_n_per_mm[0]) < 1e-6
    assert worn.cell.cell_course_mm > 1.001 * stockinette.cell_course_mm
    assert again.zero is worn.cell
    assert again.cells[-1].cell_course_mm == pytest.approx(1.1 * worn.cell.cell_course_mm)


@pytest.mark.slow
def test_yarn_that_locks_ends_the_pull_and_turns_the_loop(stockinette):
    short = pull(stockinette, "course", 4.0, 0.25, points=9)
    assert len(short.cells) < 9
    assert any("Stopped between strain" in note for note in short.notes)
    loop = hysteresis(stockinette, "course", 4.0, 0.25, points=9, cycles=2)
    assert loop.legs[0].strain[-1] == pytest.approx(short.strain[-1])
    assert loop.legs[1].strain[-1] < short.strain[-1]
    assert sum("Stopped between strain" in note for note in loop.notes) == 1


def test_a_held_state_is_no_start_of_a_history(stockinette):
    with pytest.raises(InputError, match="its size is held"):
        at_rest(replace(stockinette, force_n=(0.1, 0.0)), "as-knitted", 0.25)


def test_without_friction_nothing_is_lost(stockinette):
    free = hysteresis(stockinette, "course", 0.2, 0.0, points=6, cycles=1)
    assert np.all(free.lost_n_mm == 0.0)
    assert abs(free.lost_share) < 1e-4
    assert free.left_strain == pytest.approx(0.0, abs=1e-4)


def test_the_curve_returns_to_the_point_where_it_turned(stockinette):
    there = np.linspace(0, 0.2, 11)[1:]
    states = walk(stockinette, [*there, *there[-2:4:-1], *there[5:]], 0.25)
    stress = forces(states)
    assert stress[-1] == pytest.approx(stress[len(there) - 1], rel=0.02)
    # the inner loop is a true one: it went down by much more than it misses
    assert stress[len(there) + 4] < 0.7 * stress[-1]


@pytest.mark.slow
def test_the_fabric_rests_where_its_history_left_it(stockinette):
    wide = at_rest(stockinette, History.STRETCHED_COURSE, 0.25).cell
    assert wide.cell_course_mm > 1.005 * stockinette.cell_course_mm
    assert wide.cell_wale_mm < stockinette.cell_wale_mm
    assert np.abs(wide.force_n).max() < 1e-5
    assert at_rest(stockinette, "agitated", 0.25).cell is stockinette


@pytest.mark.slow
def test_every_history_has_its_rest_size(stockinette):
    sizes = {s.history: s for s in rest_sizes(stockinette, 0.25)}
    assert set(sizes) == set(History)
    tall = sizes[History.STRETCHED_WALE]
    assert tall.wale_mm > sizes[History.KNITTED].wale_mm > sizes[History.AGITATED].wale_mm
    assert tall.course_mm < sizes[History.AGITATED].course_mm


def test_a_cycle_count_out_of_range_is_refused(stockinette):
    with pytest.raises(InputError, match="cycles"):
        hysteresis(stockinette, Direction.COURSE, 0.1, 0.2, cycles=0)
    with pytest.raises(InputError, match=r"cycles: 1.5 is not a whole number"):
        hysteresis(stockinette, Direction.COURSE, 0.1, 0.2, cycles=1.5)
    with pytest.raises(InputError, match=r"points: 4.5 is not a whole number"):
        hysteresis(stockinette, Direction.COURSE, 0.1, 0.2, points=4.5)
