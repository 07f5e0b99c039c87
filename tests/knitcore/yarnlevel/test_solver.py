"""Minimisation: where it ends is a minimum."""

import numpy as np
import pytest

from knitcore.chart import StitchChart
from knitcore.yarnlevel.cell import mirrored_cell
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.growth import Start, grow
from knitcore.yarnlevel.samples import sample
from knitcore.yarnlevel.solver import Options
from knitcore.yarnlevel.spline import SplineGrid


def test_a_saddle_is_left_for_the_minimum_below_it():
    # the first shape of a 3x3 welt has a symmetry that its ridges lose: the way there leads
    # through a saddle of .19801 N·mm a stitch
    entry = sample("acrylic", "stockinette")
    cell = mirrored_cell(StitchChart.parse("P\nP\nP\nK\nK\nK"), SplineGrid(16, 3))
    lengths = np.full(cell.rows, entry.loop_length_mm)
    found = grow(
        cell,
        entry.yarn,
        lengths,
        Convention.PUBLISHED,
        Start("usual"),
        options=Options(tolerance=1e-6),
    )
    assert found.converged
    assert found.stable
    assert found.terms.energy / cell.stitches == pytest.approx(0.19784, rel=2e-4)
