"""Stretching on splines: forces against energies, agreement with the rest state, refusals."""

import numpy as np
import pytest

from knitcore import Direction, InputError, StitchChart
from knitcore.yarn.library.law_of_stretches import fit_sweeps
from knitcore.yarn.library.store import stored_stitch
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.sweep import find_jumps, sweep
from tests.knitcore.yarn.relaxed import relaxed


@pytest.fixture(scope="module")
def zero():
    return relaxed("K", sample("cotton", "stockinette"), grid=SplineGrid(16, 5), branch="mirrored")


@pytest.mark.parametrize("direction", list(Direction))
def test_force_is_the_derivative_of_the_energy(zero, direction):
    curve = sweep(zero, direction, 0.2, points=41)
    assert curve.converged
    assert curve.jumps == ()
    size = np.array([cell.cell_mm(direction) for cell in curve.cells])
    force = curve.stress_n_per_mm * zero.cell_mm(direction.other)
    by_energy = np.gradient(curve.energy_n_mm, size)
    np.testing.assert_allclose(force[2:-2], by_energy[2:-2], rtol=2e-2, atol=1e-3)
    work = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(size))
    assert work == pytest.approx(curve.energy_n_mm[-1] - curve.energy_n_mm[0], rel=5e-3)


def test_strain_begins_at_rest_and_the_fabric_narrows(zero):
    curve = sweep(zero, "course", 0.3, points=7)
    assert curve.strain[0] == pytest.approx(0.0, abs=1e-9)
    assert curve.strain[-1] == pytest.approx(0.3, abs=1e-9)
    assert curve.stress_n_per_mm[0] == pytest.approx(0.0, abs=1e-5)
    assert np.all(np.diff(curve.stress_n_per_mm) > 0)
    assert np.all(np.diff(curve.transverse_strain) < 0)


def test_the_law_of_a_sample_is_near_the_published_simulation(zero):
    """Table 12, cotton stockinette, simulation: Y_x 0.298, Y_y 0.536 N/mm; the freer spline is
    up to 20 % softer."""
    course = sweep(zero, "course", 0.9, points=30, max_stress_n_per_mm=0.35, back=False)
    wale = sweep(zero, "wale", 0.5, points=30, max_stress_n_per_mm=0.35, back=False)
    law = fit_sweeps(course, wale).law
    assert law.modulus_course == pytest.approx(0.298, rel=0.2)
    assert law.modulus_wale == pytest.approx(0.536, rel=0.2)


@pytest.mark.slow
def test_yarn_pulled_straight_ends_the_sweep_with_a_note(zero):
    curve = sweep(zero, "course", 5.0, points=12, back=False)
    assert len(curve.cells) < 12
    assert any("Stopped between strain" in note for note in curve.notes)
    assert max(c.cell_course_mm for c in curve.cells) < 12.28


@pytest.mark.parametrize(
    ("problem", "direction", "strain", "options"),
    [
        *((r"max_strain.*above 0", "course", strain, {}) for strain in (0.0, -0.1, np.nan, np.inf)),
        *(
            ("max_stress_n_per_mm", "course", 0.1, {"max_stress_n_per_mm": stress})
            for stress in (0.0, -0.1, np.nan)
        ),
        (r"points.*2 to 1000", "course", 0.1, {"points": 1}),
        ("Use course, wale", "across", 0.1, {}),
    ],
)
def test_impossible_stretches_are_refused(zero, problem, direction, strain, options):
    with pytest.raises(InputError, match=problem):
        sweep(zero, direction, strain, **options)


@pytest.mark.slow
def test_a_stretch_that_buckles_jumps_however_many_points_it_has():
    """Acrylic seed pulled wale-wise leaves the plane (paper, Supplementary Fig. 8): both states
    have the same energy there, so that the work balances."""
    rest = relaxed("KP\nPK", sample("acrylic", "seed"), branch="mirrored")
    curve = sweep(rest, "wale", 1.46, points=61, max_stress_n_per_mm=0.1)
    (after,) = curve.jumps
    assert curve.stress_n_per_mm[after] < 0.7 * curve.stress_n_per_mm[after - 1]
    assert curve.contact_share[after] < curve.contact_share[after - 1]
    thickness = [np.ptp(curve.cells[i].centre_lines[..., 2]) for i in (after - 1, after)]
    assert thickness[1] > thickness[0]
    coarse = sweep(rest, "wale", 1.46, points=25, max_stress_n_per_mm=0.1)
    assert len(coarse.jumps) == 1


def test_a_stretch_in_few_steps_has_no_jump_for_that():
    rest = relaxed("KP", sample("acrylic", "rib"), branch="mirrored")
    assert sweep(rest, "course", 1.0, points=6).jumps == ()


def test_a_held_state_is_refused_as_rest():
    stockinette, grid = sample("cotton", "stockinette"), SplineGrid(12, 4)
    held = relaxed("K", stockinette, cell_course_mm=3.6, grid=grid, branch="mirrored")
    with pytest.raises(InputError, match="its size is held"):
        sweep(held, "wale", 0.1)


@pytest.mark.slow
def test_a_stretch_that_opens_at_another_strain_than_it_folds_jumps_once():
    entry = stored_stitch(StitchChart.parse("KK\nKP"), "cotton")
    rest = relax(entry.chart, entry.yarn, entry.loop_length_mm, branch="mirrored")
    there = sweep(rest, "course", 0.6, points=25, back=False)
    curve = sweep(rest, "course", 0.6, points=25)
    (opens,), (folds,) = there.jumps, curve.jumps
    assert folds < opens
    lower = curve.energy_n_mm < there.energy_n_mm * (1.0 - 1e-3)
    assert np.flatnonzero(lower).tolist() == list(range(folds, opens))


def test_jumps_are_found_where_the_shape_changes_abruptly():
    line = np.linspace(0, 1, 50)
    lines = [
        np.stack([line, np.sin((3 + 0.05 * i + (2 if i > 5 else 0)) * line), 0 * line], 1)[None]
        for i in range(12)
    ]
    assert find_jumps(lines, 3.0) == (6,)
    assert find_jumps(lines[:5], 3.0) == ()
