"""Whole charts of any stitches, held spread."""

from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from knitcore.base.errors import CancelledError, InputError
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.solve.clasps import cell_is_knitted
from knitcore.yarn.solve.rounds import WholeShape
from knitcore.yarn.study import whole_stitches
from knitcore.yarn.study.whole_stitches import RelaxedStitchChart, relax_whole_stitches
from tests.knitcore.yarn.random_charts import ACRYLIC, LOOP_MM

LACE = "KKKK\nKO/K"
CHARTS = [
    "KKKKKK;KO/\\OK;KKKKKK;KKKKKK",
    "PKKKKP;P[2/2R]P;PKKKKP;PKKKKP",
    "KVKK;KKKK;PKKT;KPPK",
    "BKPb;KKKK;PKKP;KBbK",
]
OTHER = WholeShape(np.zeros((3, 24, 3)), np.ones(2), np.zeros((3, 2)), 0.1)


@lru_cache
def relaxed(text: str) -> RelaxedStitchChart:
    """A chart relaxed as a whole."""
    return relax_whole_stitches(SymbolChart.parse(text), ACRYLIC, LOOP_MM)


def sizes(whole: RelaxedStitchChart) -> tuple[float, float]:
    return whole.cell_course_mm, whole.cell_wale_mm


@pytest.mark.slow
@pytest.mark.parametrize("text", CHARTS)
def test_every_crossing_of_a_whole_chart_is_kept(text: str) -> None:
    whole = relaxed(text)
    assert whole.converged
    assert not whole.folded
    assert whole.crossings >= 3 * whole.cell.stitches
    assert whole.cell.code is not None
    assert cell_is_knitted(whole.cell, whole.state)
    assert whole.min_distance_mm > 2.0 * ACRYLIC.core_radius_mm
    assert len(whole.centre_lines) == whole.stitches.rows


def test_images_of_a_chart_have_one_shape() -> None:
    chart = SymbolChart.parse(LACE)
    here, mirrored, turned = (relaxed(of.text) for of in (chart, chart.mirror(), chart.turn_over()))
    assert sizes(here) == sizes(mirrored) == sizes(turned)
    reflected = here.centre_lines[:, ::-1] * (-1.0, 1.0, 1.0)
    gap = mirrored.centre_lines - reflected
    assert np.abs(gap - gap[:, :1]).max() < 1e-9
    assert here.eyelet_mm2 == mirrored.eyelet_mm2 is not None
    assert here.largest_force_n < 1e-3


@pytest.mark.slow
def test_a_chart_of_two_repeats_is_no_stiffer_than_one() -> None:
    once, twice = (relaxed(SymbolChart.parse(LACE).tile(1, k).text) for k in (1, 2))
    assert np.allclose(sizes(once), sizes(twice), rtol=0.05)
    assert twice.crossings == 2 * once.crossings


def test_the_pull_is_even_in_the_end() -> None:
    whole = relaxed(LACE)
    energy = whole.energy
    assert np.abs(whole.force_n).max() < 1e-5
    curve = energy.curve(whole.state)
    pairs, start = energy.pairs(curve, whole.state, 2.0 * ACRYLIC.radius_mm)
    slope = energy.derivatives(whole.state, curve, pairs, start, whole.tension_n, hessian=False)
    course, wale = slope.gradient[-2:] / whole.cell.stitches
    assert np.allclose(
        (course / wale, course),
        (sizes(whole)[1] / sizes(whole)[0], 0.03 * sizes(whole)[1]),
        rtol=1e-3,
    )


@pytest.mark.slow
def test_windows_lead_where_one_factor_does(monkeypatch: pytest.MonkeyPatch) -> None:
    chart = SymbolChart.parse("K" * 18 + ";KKO/KKK\\OKKKKKO/KK")
    at_once = relax_whole_stitches(chart, ACRYLIC, LOOP_MM)
    for most in ("MAX_STITCHES_AT_ONCE", "_FEW"):
        monkeypatch.setattr(whole_stitches, most, 10)
    shapes: list[WholeShape] = []
    in_windows = relax_whole_stitches(chart, ACRYLIC, LOOP_MM, tolerance=0.01, kept=shapes.append)
    assert in_windows.converged
    assert np.allclose(sizes(in_windows), sizes(at_once), rtol=0.05)
    assert in_windows.crossings == at_once.crossings
    assert [shape.drawn_in for shape in shapes] == sorted(shape.drawn_in for shape in shapes)


def test_a_stopped_chart_goes_on() -> None:
    shapes: list[WholeShape] = []
    shares: list[float] = []
    chart = SymbolChart.parse(LACE)

    def stop() -> bool:
        return len(shapes) > 3

    with pytest.raises(CancelledError):
        relax_whole_stitches(
            chart, ACRYLIC, LOOP_MM, kept=shapes.append, cancelled=stop,
            progress=lambda done, total: shares.append(done / total),
        )  # fmt: skip
    assert shares == sorted(shares)
    assert 0.0 < shapes[-1].drawn_in < 1.0
    rest = relax_whole_stitches(chart, ACRYLIC, LOOP_MM, resume=shapes[-1])
    assert np.allclose(sizes(rest), sizes(relaxed(LACE)), rtol=0.02)


@pytest.mark.parametrize(
    ("text", "options", "problem"),
    [
        (LACE, {"tolerance": 0.5}, "tolerance"),
        (LACE, {"rounds": 1}, "rounds"),
        (LACE, {"resume": OTHER}, "another chart"),
        (LACE, {"loop_length_mm": 1.0}, "loop"),
        (";".join(["KO/" * 30] * 45), {}, "4050"),
    ],
)
def test_wrong_input_is_refused(text: str, options: dict[str, Any], problem: str) -> None:
    with pytest.raises(InputError, match=problem):
        relax_whole_stitches(
            SymbolChart.parse(text), ACRYLIC, **{"loop_length_mm": LOOP_MM} | options
        )
