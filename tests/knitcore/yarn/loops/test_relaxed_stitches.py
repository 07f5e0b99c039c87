"""Repeats of any stitches at rest."""

from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
from hypothesis import given, settings

from knitcore.base.errors import ConvergenceError, InputError
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.relaxed_stitches import RelaxedStitches, StitchHistory, relax_stitches
from knitcore.yarn.loops.stitch_energy import YarnPerAct
from knitcore.yarn.solve.clasps import cell_is_knitted
from knitcore.yarn.study.relax import relax
from tests.knitcore.symbol_charts import symbol_charts
from tests.knitcore.yarn.random_charts import ACRYLIC, LOOP_MM


def at_rest(
    text: str, history: str = StitchHistory.AGITATED, per_act: YarnPerAct | None = None
) -> RelaxedStitches:
    chart = SymbolChart.parse(text)
    return relax_stitches(chart, ACRYLIC, LOOP_MM, history=history, per_act=per_act)


def sizes(cell: RelaxedStitches) -> tuple[float, float]:
    return cell.cell_course_mm, cell.cell_wale_mm


def test_plain_stitches_come_to_rest_as_on_their_own_path() -> None:
    cell = at_rest("K")
    plain = relax(SymbolChart.parse("K").plain, ACRYLIC, LOOP_MM, branch="free")
    assert np.allclose(sizes(cell), (plain.cell_course_mm, plain.cell_wale_mm), rtol=2e-3)
    assert np.isclose(cell.energy_n_mm, plain.energy_n_mm, rtol=2e-3)
    assert cell.converged
    assert cell.friction is None


@pytest.mark.slow
def test_mirror_images_rest_alike(tmp_path: Path) -> None:
    left, right = (at_rest(text, StitchHistory.BLOCKED) for text in ("O/;KK", "\\O;KK"))
    assert np.allclose(sizes(left), sizes(right), rtol=1e-2)
    assert (left.crossings, left.layered) == (16, 2)
    assert np.isclose(left.hole_share, right.hole_share, rtol=5e-2)
    assert left.eyelet_mm2 is not None
    assert not left.folded
    right.write(tmp_path / "mesh.vtu")
    assert len(meshio.read(tmp_path / "mesh.vtu").points) == right.centre_lines[..., 0].size


@pytest.mark.slow
def test_blocked_cloth_rests_flatter_than_agitated_cloth() -> None:
    blocked, agitated = (at_rest("O/;KK", of) for of in ("blocked", "agitated"))
    assert blocked.thickness_mm < agitated.thickness_mm
    assert np.prod(sizes(blocked)) > np.prod(sizes(agitated))


def test_stitches_without_yarn_overs_have_no_eyelets() -> None:
    assert at_rest("VK;KK").eyelet_mm2 is None


@pytest.mark.slow
def test_slipped_stitches_and_twists_draw_the_cloth_in() -> None:
    plain = at_rest("K")
    slipped, twisted = at_rest("VK;KK"), at_rest("B")
    assert slipped.cell_wale_mm < 0.9 * plain.cell_wale_mm
    assert twisted.cell_course_mm < 0.95 * plain.cell_course_mm


def test_a_large_repeat_is_refused() -> None:
    with pytest.raises(InputError, match="36"):
        at_rest("O/KKKKKK;KKKKKKKK;KKKKKKKK;KKKKKKKK;KKKKKKKK")


@pytest.mark.slow
def test_yarn_that_locks_is_refused_with_a_remedy() -> None:
    with pytest.raises(ConvergenceError, match="plain row between"):
        at_rest("[1/1R];[1/1L]", per_act=YarnPerAct(crossing=0.3))


@pytest.mark.slow
@pytest.mark.parametrize("text", ["[2/2L];KKKK;KKKK;KKKK", "//OO;KKKK", "O^OK;KKKK"])
def test_cables_and_wide_lace_come_to_rest(text: str) -> None:
    assert at_rest(text, StitchHistory.BLOCKED).converged


@pytest.mark.slow
def test_the_row_below_a_crossing_that_locks_gets_more_yarn() -> None:
    rest = at_rest("[3/3R];KKKKKK", StitchHistory.BLOCKED)
    below, crossed = rest.loop_lengths_mm / LOOP_MM
    assert 1.0 < below < 1.5
    assert crossed == pytest.approx(1.0)
    assert f"{below:.0%}" in rest.notes[0]
    assert cell_is_knitted(rest.state.cell.cell, rest.state.cell.state)


def test_two_repeats_rest_like_one() -> None:
    chart = SymbolChart.parse("VK;KK")
    once, twice = (relax_stitches(of, ACRYLIC, LOOP_MM) for of in (chart, chart.tile(4, 8)))
    assert sizes(twice) == sizes(once)
    assert twice.pattern == once.pattern
    assert SymbolChart.parse("VKV;KKK").repeat() == SymbolChart.parse("VKV;KKK")


@pytest.mark.slow
@settings(max_examples=5)
@given(chart=symbol_charts(most_rows=2, most_columns=4, drawn=True))
def test_what_passes_through_what_stays(chart: SymbolChart) -> None:
    """The yarn at rest is knotted as in the first shape, which has all crossings of the chart."""
    try:
        rest = relax_stitches(chart, ACRYLIC, LOOP_MM)
    except ConvergenceError:  # of random charts some lock; the message has the remedy
        return
    cell = rest.state.cell
    assert cell_is_knitted(cell.cell, cell.state)
    other = replace(cell.cell, code=tuple(1.01 * part + 0.1 for part in cell.cell.code or ()))
    assert not cell_is_knitted(other, cell.state)
    assert rest.min_distance_mm > 2.0 * ACRYLIC.core_radius_mm
