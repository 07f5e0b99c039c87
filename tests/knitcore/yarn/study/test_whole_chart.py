"""Whole charts: windows of a sheet, sweeps and the descent of the whole."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from knitcore import CancelledError, Fabric, InputError, StitchChart
from knitcore.yarn.model import energy, neighbours
from knitcore.yarn.model.cell import plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.neighbours import reaches
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.relaxed_cell import Branch
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.growth import FIRST_OPENING, core_that_fits
from knitcore.yarn.solve.rounds import WholeShape
from knitcore.yarn.solve.topology import clearance_at
from knitcore.yarn.solve.windows import each, row_lengths, touch, window_energy, windows
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.whole_chart import relax_whole
from tests.knitcore.yarn.relaxed import relaxed

SAMPLE = sample("acrylic", Fabric.STOCKINETTE)
ROWS, WALES = 9, 8
AROUND = np.full((2, ROWS, WALES), 2)
OTHER = WholeShape(np.zeros((2, 24, 3)), np.ones(2), np.zeros((2, 2)), 0.1)
BY_COURSE = r"Give one length, or one for every course\.$"
PURL = np.random.default_rng(3).random((ROWS, WALES)) < 0.3
Sheet = tuple[CellEnergy, np.ndarray]


def part_of(sheet, window, missing_mm=None, *, flat=False):
    """A window of a sheet, and its unknowns."""
    whole, state = sheet
    missing = np.zeros(ROWS) if missing_mm is None else missing_mm
    return window_energy(whole, whole.cell.controls(state), state[-2:], window, missing, flat=flat)


@pytest.fixture(scope="module")
def sheet() -> Sheet:
    """A first shape of a chart, with a core that fits into it."""
    cell = plain_cell(StitchChart(PURL), SplineGrid(12, 4))
    lengths = np.full(ROWS, SAMPLE.loop_length_mm)
    energy = CellEnergy(cell, SAMPLE.yarn, lengths, Convention.PUBLISHED)
    state = start_state(cell, SAMPLE.loop_length_mm, 0.8 * SAMPLE.yarn.radius_mm)
    nearest = clearance_at(energy, state).min_distance_mm
    core = core_that_fits(SAMPLE.yarn, nearest, FIRST_OPENING)
    return replace(energy, yarn=replace(SAMPLE.yarn, core_radius_mm=core)), state


def _slope(energy: CellEnergy, state: np.ndarray, tension: np.ndarray) -> np.ndarray:
    curve = energy.curve(state)
    pairs, start = energy.pairs(curve, state, 2.0 * energy.yarn.radius_mm)
    return energy.derivatives(state, curve, pairs, start, tension, hessian=False).gradient


@pytest.mark.parametrize("first", [(0, 0), (2, 3), (8, 7)])
def test_windows_cover_every_stitch_once(first: tuple[int, int]) -> None:
    seen = np.zeros((ROWS, WALES), int)
    for rows, wales in windows(AROUND, 3, first):
        seen[np.ix_(rows.own, wales.own)] += 1
    assert np.all(seen == 1)


def test_a_window_rests_as_far_around_it_as_its_own_strands_reach() -> None:
    around = np.full((2, 20, 20), 2)
    around[0, 4, 4] = 3
    for rows, wales in windows(around, 3, (0, 0)):
        far = [len(extent.stitches) - len(extent.own) for extent in (rows, wales)]
        assert far[0] == (2 * 3 if {4} <= set(rows.own) and {4} <= set(wales.own) else 2 * 2)
        assert far[1] == 2 * 2


def test_pairs_reach_from_row_to_row_and_over_the_edge() -> None:
    # samples 0, 1 of stitch 0; 2, 3 of stitch 1, and so on; two rows of three wales
    pairs = np.array([[0, 6, 0, 0, 1], [1, 5, -1, 0, 1], [8, 2, 0, 2, 1]], np.int32)
    down, across = reaches(pairs, 2, (2, 3))
    assert down.tolist() == [[1, 3, 1], [1, 3, 1]]
    assert across.tolist() == [[1, 1, 1], [1, 1, 1]]


def test_a_window_lists_those_pairs_of_the_sheet_of_which_one_moves(sheet: Sheet) -> None:
    whole, state = sheet
    reach = 2.0 * whole.yarn.radius_mm
    every, _ = whole.pairs(whole.curve(state), state, reach)
    count = whole.cell.grid.samples * WALES
    for rows, wales in windows(AROUND, 3, (7, 2))[:4]:
        part, own = part_of(sheet, (rows, wales))
        pairs, start = part.pairs(part.curve(own), own, reach)
        samples = each(wales.stitches, whole.cell.grid.samples)
        names = (rows.stitches[:, None] * count + samples).ravel()
        listed = {tuple(sorted(pair)) for pair in names[pairs[:, :2]].tolist()}
        moving = set(names[part.moving].tolist())
        assert listed == {tuple(sorted(p)) for p in every[:, :2].tolist() if moving.intersection(p)}
        assert np.array_equal(np.diff(start), np.bincount(pairs[:, 0], minlength=len(names)))


def test_pairs_found_in_two_threads_are_those_found_in_one(
    sheet: Sheet, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, state = sheet
    curve, reach, tension = whole.curve(state), 2.0 * whole.yarn.radius_mm, np.zeros(ROWS)
    pairs, start = whole.pairs(curve, state, reach)
    value = whole.value(state, curve, pairs)
    slope = _slope(whole, state, tension)
    monkeypatch.setattr(neighbours, "_SAMPLES_TO_SHARE", 2)
    monkeypatch.setattr(energy, "PAIRS_TO_SHARE", 2)
    again, begin = whole.pairs(curve, state, reach)
    assert np.array_equal(again, pairs)
    assert np.array_equal(begin, start)
    assert whole.value(state, curve, pairs).contact == pytest.approx(value.contact, rel=1e-12)
    assert np.allclose(_slope(whole, state, tension), slope, rtol=1e-9, atol=1e-12)


def test_windows_that_move_side_by_side_do_not_touch() -> None:
    covering = windows(np.full((2, 40, 20), 2), 8, (0, 0))
    assert not touch(covering[0], covering[7])
    assert touch(covering[0], covering[3])
    assert touch(covering[-1], covering[0])  # over the edge


def test_a_window_has_the_slopes_of_the_sheet(sheet: Sheet) -> None:
    whole, state = sheet
    tension = np.linspace(-1e-3, 2e-3, ROWS)
    gradient = _slope(whole, state, tension)[:-2].reshape(ROWS, -1, 3)
    for rows, wales in windows(AROUND, 3, (7, 2))[:4]:
        part, own = part_of(sheet, (rows, wales))
        slopes = _slope(part, own, tension[rows.own])[:-2]
        places = (wales.stitches[:, None] * 12 + np.arange(12)).ravel()
        expected = gradient[np.ix_(rows.stitches, places)][part.cell.free].ravel()
        assert np.allclose(slopes, expected, rtol=1e-9, atol=1e-12)


def test_the_slopes_of_a_window_are_those_of_its_energy(sheet: Sheet) -> None:
    part, own = part_of(sheet, windows(AROUND, 3, (0, 0))[0], flat=True)
    pulls = np.linspace(0.5e-3, 1e-3, part.constraints)
    curve = part.curve(own)
    pairs, _ = part.pairs(curve, own, 2.5 * part.yarn.radius_mm)
    direction = np.append(np.random.default_rng(1).standard_normal(len(own) - 2), (0.0, 0.0))

    def merit(step: float) -> float:
        moved = own + step * direction
        terms = part.value(moved, part.curve(moved), pairs)
        return terms.energy + terms.spacing + float(pulls @ terms.excess_mm)

    along = (merit(1e-6) - merit(-1e-6)) / 2e-6
    assert along == pytest.approx(float(_slope(part, own, pulls) @ direction), rel=1e-5)


def test_the_lengths_of_windows_add_up_to_those_of_the_courses(sheet: Sheet) -> None:
    whole, state = sheet
    missing = np.linspace(0.0, 0.1, ROWS)
    lengths = row_lengths(whole.cell, whole.curve(state))
    gained = np.zeros(ROWS)
    for window in windows(AROUND, 3, (0, 0)):
        part, own = part_of(sheet, window, missing)
        gained[window[0].own] -= part.excess(own, part.curve(own))
    assert np.allclose(gained, WALES * missing)
    assert lengths.shape == (ROWS,)


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        ({"tolerance": 0.5}, "tolerance"),
        ({"rounds": 1}, "rounds"),
        ({"rounds": 2.5}, "rounds: 2.5 is not a whole number"),
        ({"loop_length_mm": [11.0] * 3}, "3 lengths were given for a repeat of 8 columns x 9 rows"),
        ({"loop_length_mm": np.full((ROWS, WALES), 11.0)}, BY_COURSE),
        ({"resume": OTHER}, "another chart"),
    ],
)
def test_wrong_input_is_refused(options: dict[str, Any], problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        relax_whole(StitchChart(PURL), SAMPLE.yarn, **{"loop_length_mm": 11.0} | options)


@pytest.mark.slow
def test_progress_is_told_of_yarn_without_a_core() -> None:
    shares: list[float] = []
    yarn = YarnModel(0.045, 3e-3, 2.4, 0.74, 0.0)
    relax_whole(
        StitchChart.parse("KP\nKP"), yarn, 11.3, tolerance=0.1,
        progress=lambda done, total: shares.append(done / total),
    )  # fmt: skip
    assert 0.1 <= min(shares) <= max(shares) == pytest.approx(1.0)


@pytest.mark.slow
def test_loop_lengths_repeat_with_the_chart() -> None:
    chart = StitchChart.parse("K\nP").resized(4, 2)
    short, long = 0.98 * SAMPLE.loop_length_mm, SAMPLE.loop_length_mm
    given = [[short, long], [short, long, short, long]]
    two, four = (relax_whole(chart, SAMPLE.yarn, mm, tolerance=0.1, rounds=2) for mm in given)
    assert two.energy_n_mm == four.energy_n_mm
    assert two.loop_lengths_mm.tolist() == given[1]


def test_a_whole_chart_can_be_cancelled() -> None:
    with pytest.raises(CancelledError):
        relax_whole(StitchChart(PURL), SAMPLE.yarn, SAMPLE.loop_length_mm, cancelled=lambda: True)


@pytest.mark.slow
def test_a_whole_chart_of_a_repeat_has_no_mirrors() -> None:
    entry = sample("cotton", "rib")
    repeat = relaxed("KP", entry)
    chart = StitchChart.parse("KPKP\nKPKP\nKPKP\nKPKP")
    whole = relax_whole(chart, entry.yarn, entry.loop_length_mm)
    assert whole.energy_n_mm < 0.95 * repeat.mirrored.energy_n_mm
    assert whole.energy_n_mm == pytest.approx(repeat.energy_n_mm, rel=2e-3)
    # with an odd number of rows, pairs of them cannot repeat
    odd = relax_whole(chart.resized(5, 4), entry.yarn, entry.loop_length_mm)
    assert repeat.energy_n_mm < odd.energy_n_mm < 0.95 * repeat.mirrored.energy_n_mm


@pytest.mark.slow
def test_a_whole_chart_of_stockinette_relaxes_like_one_stitch_and_can_be_resumed() -> None:
    chart = StitchChart(np.zeros((10, 13), bool))
    repeat = relax(StitchChart.parse("K"), SAMPLE.yarn, SAMPLE.loop_length_mm)
    sheets: list[WholeShape] = []
    shares: list[float] = []
    whole = relax_whole(
        chart, SAMPLE.yarn, SAMPLE.loop_length_mm, tolerance=1e-3, kept=sheets.append,
        progress=lambda done, total: shares.append(done / total),
    )  # fmt: skip
    assert whole.converged
    assert whole.branch is Branch.FREE
    assert whole.energy_n_mm == pytest.approx(repeat.energy_n_mm, rel=2e-3)
    assert whole.cell_course_mm == pytest.approx(repeat.cell_course_mm, rel=5e-3)
    assert whole.cell_wale_mm == pytest.approx(repeat.cell_wale_mm, rel=5e-3)
    assert "Forces of up to" in whole.notes[0]
    assert 0.0 <= whole.may_fall == whole.rounds * abs(whole.energy_change)
    assert abs(whole.energy_change) <= 1e-3
    assert whole.size_change <= 1e-2
    assert 0.0 <= min(shares) <= max(shares) <= 1.0
    again = relax_whole(
        chart, SAMPLE.yarn, SAMPLE.loop_length_mm, tolerance=1e-3, resume=sheets[-1]
    )
    assert again.energy_n_mm == pytest.approx(whole.energy_n_mm, rel=1e-6)
