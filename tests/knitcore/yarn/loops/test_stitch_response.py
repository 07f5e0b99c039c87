"""Repeats of any stitches, pulled and bent."""

import numpy as np
import pytest

from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.relaxed_stitches import relax_stitches
from knitcore.yarn.loops.stitch_response import bend_stitches, stretch_stitches
from knitcore.yarn.study.bending import bending_response
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.sweep import sweep
from tests.knitcore.refusals import refuses
from tests.knitcore.yarn.random_charts import ACRYLIC, LOOP_MM


def test_plain_stitches_stretch_and_bend_as_on_their_own_path() -> None:
    chart = SymbolChart.parse("K")
    rest = relax_stitches(chart, ACRYLIC, LOOP_MM, history="agitated")
    plain = relax(chart.plain, ACRYLIC, LOOP_MM, branch="free")
    pulled = stretch_stitches(rest, "wale", 0.2, points=3)
    same = sweep(plain, "wale", 0.2, points=3)
    assert np.allclose(pulled.stress_n_per_mm, same.stress_n_per_mm, rtol=0.03, atol=5e-4)
    bent, alike = bend_stitches(rest), bending_response(plain)
    assert bent.course.rigidity_n_mm == pytest.approx(alike.course.rigidity_n_mm, rel=0.05)
    assert bent.wale.moment_n == pytest.approx(alike.wale.moment_n, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("text", ["O/;KK", "VK;KK", "TK;KK", "[1/1R]KK;KKKK"])
def test_stress_rises_with_the_strain_of_any_stitches(text: str) -> None:
    rest = relax_stitches(SymbolChart.parse(text), ACRYLIC, LOOP_MM)
    for direction in ("course", "wale"):
        pulled = stretch_stitches(rest, direction, 0.2, points=5)
        assert pulled.converged
        assert np.all(np.diff(pulled.stress_n_per_mm) > 0.0)
        assert pulled.notes[0] == rest.notes[0]


def test_friction_is_not_bent() -> None:
    rest = relax_stitches(SymbolChart.parse("B"), ACRYLIC, LOOP_MM)
    with refuses("history", "friction"):
        bend_stitches(rest)


def test_a_cloth_that_is_turned_over_curls_the_other_way() -> None:
    face, back = (
        bend_stitches(relax_stitches(SymbolChart.parse(text), ACRYLIC, LOOP_MM, history="agitated"))
        for text in ("B", "b")
    )
    assert face.wale.moment_n == -back.wale.moment_n != 0.0
    assert face.course.rigidity_n_mm == back.course.rigidity_n_mm
