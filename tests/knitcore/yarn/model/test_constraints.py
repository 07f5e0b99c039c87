"""Sizes, stitch lengths and the plane that a relaxation may hold; cells that are refused."""

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.cell import mirrored_cell, plain_cell
from knitcore.yarn.model.constraints import Surroundings, foot_rows, independent, plane_rows
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.whole_chart import relax_whole
from tests.knitcore.yarn.relaxed import relaxed

YARN = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.30)
LENGTH = 11.28


def at_length(text, **options):
    return relax(StitchChart.parse(text), YARN, LENGTH, **options)


def _lengths(repeat):
    """Length of yarn of every stitch of the cell, measured on the curve."""
    energy = repeat.energy
    curve = energy.curve(repeat.state)
    speed = np.linalg.norm(curve[:, 1], axis=1)
    per_stitch = speed.reshape(repeat.cell.stitches, -1).sum(axis=1) / repeat.cell.grid.samples
    return per_stitch.reshape(repeat.cell.rows, repeat.cell.wales)


def test_prescribed_sizes_are_reached_and_their_forces_balance_the_energy():
    free = at_length("K")
    wide = at_length("K", cell_course_mm=3.2)
    assert wide.cell_course_mm == pytest.approx(3.2, abs=1e-9)
    assert wide.energy_n_mm > free.energy_n_mm
    assert wide.force_n[0] > 0.0
    assert wide.force_n[1] == pytest.approx(0.0, abs=1e-6)
    both = at_length("K", cell_course_mm=3.2, cell_wale_mm=1.9)
    assert (both.cell_course_mm, both.cell_wale_mm) == pytest.approx((3.2, 1.9), abs=1e-9)
    assert both.energy_n_mm > wide.energy_n_mm
    assert both.force_n[1] < 0.0  # it is pressed together
    near = at_length("K", cell_course_mm=3.2, cell_wale_mm=1.902)
    slope = (near.energy_n_mm - both.energy_n_mm) / 0.002
    assert slope == pytest.approx(both.force_n[1], rel=0.02)


@pytest.mark.slow
def test_every_stitch_may_have_a_length_of_its_own():
    lengths = [[11.28, 12.0], [11.5, 11.0]]
    repeat = relax(StitchChart.parse("KK\nKP"), YARN, lengths)
    np.testing.assert_allclose(_lengths(repeat), lengths, rtol=1e-6)
    # the marks between stitches stay at the lowest points of the feet
    assert np.abs(repeat.energy.held @ repeat.state).max() < 1e-9
    assert repeat.converged


@pytest.mark.slow
def test_equal_stitch_lengths_are_one_loop_length():
    single = at_length("KP")
    table = relax(StitchChart.parse("KP"), YARN, np.full((1, 2), LENGTH))
    assert table.energy_n_mm == single.energy_n_mm
    assert table.cell.stitches == single.cell.stitches


def test_a_fabric_laid_flat_is_wider_and_thinner_than_a_folded_one():
    folded = at_length("KKPP", branch="mirrored")
    flat = at_length("KKPP", flat=True)
    assert np.ptp(flat.centre_lines[..., 2]) < 0.7 * np.ptp(folded.centre_lines[..., 2])
    assert flat.cell_course_mm > 1.2 * folded.cell_course_mm
    assert flat.energy_n_mm > folded.energy_n_mm  # something presses it
    stockinette = at_length("K", flat=True)
    assert stockinette.energy_n_mm == pytest.approx(at_length("K").energy_n_mm, rel=1e-6)


@pytest.mark.slow
def test_yarn_does_not_slide_out_of_a_plane():
    rib = StitchChart.parse("KP")
    folded = relax(rib, YARN, LENGTH)
    flat = relax(rib, YARN, LENGTH, flat=True)
    free = relax(rib, YARN, LENGTH, flat=True, branch="free")
    whole = relax_whole(rib.tile(4, 2), YARN, LENGTH, flat=True)
    assert flat.energy_n_mm > 1.2 * folded.energy_n_mm
    assert free.energy_n_mm == pytest.approx(flat.energy_n_mm, rel=0.02)
    assert whole.energy_n_mm == pytest.approx(flat.energy_n_mm, rel=0.02)


@pytest.mark.parametrize(("yarn", "rows"), [("acrylic", 4), ("cotton", 4), ("cotton", 8)])
@pytest.mark.slow
def test_rib_of_any_height_stays_as_flat_as_its_repeat(yarn, rows):
    """Its rows do not tip to the front and to the back in turn."""
    entry, rib = sample(yarn, "rib"), StitchChart.parse("KP")
    flat = relaxed(rib, entry, flat=True)
    whole = relax_whole(rib.tile(rows, 2), entry.yarn, entry.loop_length_mm, flat=True)
    assert whole.minimum
    assert whole.energy_n_mm == pytest.approx(flat.energy_n_mm, rel=0.02)
    assert np.ptp(whole.centre_lines[..., 2]) < 1.15 * np.ptp(flat.centre_lines[..., 2])


def test_like_surroundings_are_those_of_an_exchanged_or_mirrored_chart():
    around = Surroundings.of(plain_cell(StitchChart.parse("KKPP"), SplineGrid(16, 3)))
    assert len(np.unique(around.kind)) == 1
    assert around.side.tolist() == [[1.0, 1.0, -1.0, -1.0]]
    assert around.hand[0, 0] == -around.hand[0, 1] != 0.0
    lone = Surroundings.of(plain_cell(StitchChart.parse("KKKKKKKP"), SplineGrid(16, 3)))
    assert len(np.unique(lone.kind)) == 4  # the purl, those beside it, the next ones, the rest
    assert lone.hand[0, 7] == lone.hand[0, 3] == 0.0


def test_what_stitches_do_alike_is_no_difference_of_posture():
    cell = plain_cell(StitchChart.parse("KP\nKP"), SplineGrid(16, 3))
    around = Surroundings.of(cell)
    tips = np.array([[0.3], [-0.3], [0.3], [-0.3]])
    assert not around.alike(tips, np.zeros((4, 1))).any()
    assert around.alike(tips[::-1] * [[1.0], [1.0], [-1.0], [-1.0]], np.zeros((4, 1))).any()
    assert around.alike(tips, np.ones((4, 1))).any()


def test_rules_that_symmetry_keeps_are_left_out():
    grid = SplineGrid(16, 3)
    assert len(foot_rows(mirrored_cell(StitchChart.parse("K"), grid))) == 0
    assert len(plane_rows(mirrored_cell(StitchChart.parse("K"), grid))) == 0
    whole = plain_cell(StitchChart.parse("KP\nPK"), grid)
    assert len(foot_rows(whole)) == 4
    assert len(plane_rows(whole)) == 3  # less the plane itself
    state = start_state(whole, 12.0, 0.6)
    np.testing.assert_allclose(foot_rows(whole) @ state, 0.0, atol=1e-9)


def test_spare_rows_are_dropped():
    rows = np.array([[1.0, 0.0, 1.0], [2.0, 0.0, 2.0], [0.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    np.testing.assert_array_equal(independent(rows), rows[[0, 3]])
