"""Minimisation: where it ends is a minimum."""

import numpy as np
import pytest

from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.cell import mirrored_cell, plain_cell
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.energy import CellEnergy
from knitcore.yarn.model.paper_samples import sample
from knitcore.yarn.model.spline import SplineGrid
from knitcore.yarn.model.start_shape import start_state
from knitcore.yarn.solve.systems import DenseSystem
from knitcore.yarn.solve.topology import Trajectory
from tests.knitcore.yarn.relaxed import grown


def test_a_saddle_is_left_for_the_minimum_below_it():
    # the first shape of a 3x3 welt has a symmetry that its ridges lose: the way there leads
    # through a saddle of .19801 N·mm a stitch
    entry = sample("acrylic", "stockinette")
    cell = mirrored_cell(StitchChart.parse("P\nP\nP\nK\nK\nK"), SplineGrid(16, 3))
    minimum = grown(cell, entry.yarn, entry.loop_length_mm, tolerance=1e-6)
    assert minimum.converged
    assert minimum.stable
    assert minimum.terms.energy / cell.stitches == pytest.approx(0.19784, rel=2e-4)


def test_a_mended_step_does_not_stretch_the_yarn():
    entry = sample("acrylic", "stockinette")
    cell = plain_cell(StitchChart.parse("KP\nKK"), SplineGrid(16, 3))
    energy = CellEnergy(cell, entry.yarn, np.full(2, entry.loop_length_mm), Convention.PUBLISHED)
    path = Trajectory(energy, start_state(cell, entry.loop_length_mm, 0.6), pair_cap=0.3)
    slope = path.slope(np.zeros(2), hessian=True)
    system = DenseSystem(slope, energy.penalty, np.ones(cell.unknowns, bool))
    assert system.factorise(1e3)
    before = path.here.terms.excess_mm
    step, _ = system.solve(slope, before, np.zeros(0))
    straight = path.certified(step)
    mended = path.certified(step, lambda excess: system.mending(slope.lengths, excess))

    def missed(taken):
        return np.abs(taken.to.terms.excess_mm - (1.0 - taken.fraction) * before).max()

    assert straight.fraction > 0.1
    assert missed(mended) < 0.2 * missed(straight)
