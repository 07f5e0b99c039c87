"""Repeats that knitters know, and random ones, relax in both branches with their clasps intact."""

import numpy as np
import pytest

from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.solve.clasps import cell_is_knitted
from knitcore.yarn.solve.growth import Start
from knitcore.yarn.study.relax import Branch, relax
from knitcore.yarn.study.sweep import sweep

YARN = YarnModel(0.045, 6e-4, 2.4, 0.74, 0.30)
LOOP_MM = 11.28
REPEATS = {
    "2x2 rib": "KKPP",
    "basket": "PPKK\nPPKK\nKKPP\nKKPP",
    "moss": "PK\nPK\nKP\nKP",
    "3x1 rib": "KKKP",
}


def _sound(found):
    assert found.converged
    assert found.min_distance_mm > 2.0 * YARN.core_radius_mm
    assert found.yarn_length_mm == pytest.approx(LOOP_MM, rel=1e-5)
    assert cell_is_knitted(found.cell, found.state)


@pytest.mark.parametrize("name", list(REPEATS))
@pytest.mark.parametrize("branch", [Branch.MIRRORED, Branch.FREE])
def test_known_repeats_relax(name, branch):
    starts = None if branch is Branch.MIRRORED else []  # free: on from the mirrored state
    found = relax(StitchChart.parse(REPEATS[name]), YARN, LOOP_MM, branch=branch, starts=starts)
    _sound(found)
    assert len(found.starts) >= (2 if found.cell.stitches <= 9 else 1)
    if branch is Branch.FREE and name == "2x2 rib":
        assert any("differs from the mirrored one" in note for note in found.notes)


@pytest.mark.parametrize("seed", [1, 2])
def test_random_repeats_relax(seed):
    chart = StitchChart(np.random.default_rng(seed).random((4, 4)) < 0.5)
    _sound(relax(chart, YARN, LOOP_MM, starts=[Start("usual")]))


def test_two_by_two_rib_is_narrower_and_stretchier_than_one_by_one():
    zeros = [
        relax(StitchChart.parse(text), YARN, LOOP_MM, branch="mirrored") for text in ("KP", "KKPP")
    ]
    assert zeros[1].cell_course_mm < 0.95 * zeros[0].cell_course_mm
    strains = []
    for zero in zeros:
        curve = sweep(zero, Direction.COURSE, 3.0, points=13, back=False, max_stress_n_per_mm=0.05)
        assert curve.stress_n_per_mm[-1] > 0.05
        strains.append(float(np.interp(0.05, curve.stress_n_per_mm, curve.strain)))
    assert strains[1] > 1.1 * strains[0]
