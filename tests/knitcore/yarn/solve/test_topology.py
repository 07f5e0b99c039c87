"""The certificate refuses steps on which yarn would meet yarn."""

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.cell import mirrored_cell, plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.neighbours import pair_distances
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.topology import clearance_at

YARN = YarnModel(0.046, 6e-4, 2.4, 0.74, 0.1)
REACH_RADII = 3.2


def _energy(text, kind, per_span=5):
    cell = kind(StitchChart.parse(text), SplineGrid(16, per_span))
    return CellEnergy(cell, YARN, np.full(cell.rows, 11.3), Convention.PUBLISHED)


@pytest.mark.parametrize(("text", "kind"), [("K", mirrored_cell), ("KP\nKK", plain_cell)])
def test_a_step_through_the_yarn_is_cut_before_it_meets(text, kind):
    """Knits turned into purls by pushing all yarn through the plane cross on the way."""
    energy = _energy(text, kind)
    state = start_state(energy.cell, 11.3, 0.6)
    through = state.copy()
    z = energy.cell.dof[..., 2][energy.cell.sign[..., 2] != 0]
    through[z] *= -1.0
    clearance = clearance_at(energy, state, REACH_RADII)
    allowed, _ = clearance.longest_step(through, energy.curve(through), 1e9)
    assert 0.0 < allowed < 0.5
    fine = _energy(text, kind, per_span=20)
    for fraction in np.linspace(0.0, allowed, 9):
        between = state + fraction * (through - state)
        assert clearance_at(fine, between, REACH_RADII).min_distance_mm > 0.0


def test_small_steps_and_rest_pass():
    energy = _energy("K", mirrored_cell)
    state = start_state(energy.cell, 11.3, 0.6)
    clearance = clearance_at(energy, state, REACH_RADII)
    assert clearance.longest_step(state, energy.curve(state), 1.0)[0] == 1.0
    moved = state + 0.005 * np.random.default_rng(0).standard_normal(len(state))
    assert clearance.longest_step(moved, energy.curve(moved), 1.0)[0] == 1.0


def test_the_cap_on_a_pair_holds():
    energy = _energy("KP\nKK", plain_cell)
    state = start_state(energy.cell, 11.3, 0.6)
    clearance = clearance_at(energy, state, REACH_RADII)
    moved = state + 0.1 * np.random.default_rng(0).standard_normal(len(state))
    fraction, _ = clearance.longest_step(moved, energy.curve(moved), 0.05)
    between = state + fraction * (moved - state)
    moved, by = energy.curve(between) - clearance.curve, tuple(between[-2:] - state[-2:])
    change = pair_distances(moved, by, energy.cell.place, (2, 2), clearance.pairs)
    assert fraction < 1.0
    assert change.max() == pytest.approx(0.05, rel=1e-6)
    after = clearance_at(energy, between, REACH_RADII)
    old = dict(zip(map(tuple, clearance.pairs.tolist()), clearance.distances_mm, strict=True))
    new = dict(zip(map(tuple, after.pairs.tolist()), after.distances_mm, strict=True))
    assert max(abs(new[pair] - old[pair]) for pair in new.keys() & old.keys()) <= 0.05 + 1e-9
