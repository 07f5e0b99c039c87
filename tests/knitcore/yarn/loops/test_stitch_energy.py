"""Yarn by acts and pulls on the cloth."""

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.loops.stitch_energy import SpreadEnergy, StitchEnergy, YarnPerAct
from knitcore.yarn.loops.take_down import room_for_yarn
from knitcore.yarn.model.conventions import Convention
from tests.knitcore.yarn.random_charts import ACRYLIC


@pytest.mark.parametrize(
    ("text", "means"),
    [
        ("VK;KK", (1.0, 0.635)),
        ("TK;KK", (1.0, 0.875)),
        ("O/;KK", (1.0, 1.1)),
        ("[1/1R]KK;KKKK", (1.25, 1.0)),
        ("KKKK;[1/1R]KK", (1.0, 1.25)),
    ],
)
def test_rows_take_the_yarn_of_their_acts(text: str, means: tuple[float, float]) -> None:
    per_act = YarnPerAct(yarn_over=1.2, crossing=1.5)
    assert np.allclose(per_act.of_rows(SymbolChart.parse(text).graph), means)


def test_a_pull_is_the_slope_of_the_energy_by_the_sizes() -> None:
    drawn = room_for_yarn(SymbolChart.parse("O/;KK").graph, ACRYLIC, 11.3)
    plain = StitchEnergy(drawn.cell, ACRYLIC, drawn.loop_lengths_mm, Convention.PUBLISHED)
    pulled = StitchEnergy(
        drawn.cell, ACRYLIC, drawn.loop_lengths_mm, Convention.PUBLISHED, pull_n=(0.1, 0.2)
    )
    curve = plain.curve(drawn.state)
    pairs, start = plain.pairs(curve, drawn.state, 2.0 * ACRYLIC.radius_mm)
    at = drawn.state, curve, pairs
    work = plain.value(*at).spacing - pulled.value(*at).spacing
    assert np.isclose(work, 0.1 * drawn.state[-2] + 0.2 * drawn.state[-1])
    tension = np.zeros(plain.constraints)
    slopes = [e.derivatives(*at, start, tension, hessian=False) for e in (plain, pulled)]
    by_size = slopes[0].gradient[-2:] - slopes[1].gradient[-2:]
    assert np.allclose(by_size, (0.1, 0.2))


@pytest.mark.parametrize("sparse", [False, True])
def test_an_even_pull_is_that_of_the_area(sparse: bool) -> None:
    drawn = room_for_yarn(SymbolChart.parse("O/;KK").graph, ACRYLIC, 11.3)
    given = drawn.cell, ACRYLIC, drawn.loop_lengths_mm, Convention.PUBLISHED
    plain, spread = StitchEnergy(*given), SpreadEnergy(*given, spread_n_per_mm=0.03)
    curve = plain.curve(drawn.state)
    pairs, start = plain.pairs(curve, drawn.state, 2.0 * ACRYLIC.radius_mm)
    at = drawn.state, curve, pairs
    course, wale = drawn.state[-2:].tolist()
    work = plain.value(*at).spacing - spread.value(*at).spacing
    assert np.isclose(work, 4 * 0.03 * course * wale)
    tension = np.zeros(plain.constraints)
    free, held = (e.derivatives(*at, start, tension, sparse=sparse) for e in (plain, spread))
    assert np.allclose((free.gradient - held.gradient)[-2:], (0.12 * wale, 0.12 * course))
    if sparse:
        assert free.sparse is not None
        assert held.sparse is not None
        softer = (free.sparse.sizes - held.sparse.sizes)[:, -2:]
    else:
        assert free.hessian is not None
        assert held.hessian is not None
        softer = (free.hessian - held.hessian)[-2:, -2:]
    assert np.allclose(softer, [[0.0, 0.12], [0.12, 0.0]])


def test_yarn_out_of_range_is_refused() -> None:
    with pytest.raises(InputError, match="crossing"):
        YarnPerAct(crossing=0.0)
