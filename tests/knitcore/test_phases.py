from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given

from knitcore import Fabric, StitchChart, quarter_phases
from knitcore.phases import ABOVE, BELOW, LEFT, RIGHT, surroundings
from tests.knitcore.charts import stitch_charts


@pytest.mark.parametrize("fabric", list(Fabric))
@pytest.mark.parametrize("periodic", [False, True])
def test_pure_fabrics_are_pure_up_to_their_edges(fabric: Fabric, periodic: bool) -> None:
    chart = StitchChart.of_fabric(fabric, rows=6, columns=4)
    assert (quarter_phases(chart, periodic=periodic) == fabric.phase).all()


@given(stitch_charts())
def test_turning_over_mirrors_the_phases(chart: StitchChart) -> None:
    for periodic in (False, True):
        np.testing.assert_array_equal(
            quarter_phases(chart.turn_over(), periodic=periodic),
            quarter_phases(chart, periodic=periodic)[:, ::-1],
        )


@given(stitch_charts())
def test_periodic_phases_are_those_of_the_middle_of_a_tiling(chart: StitchChart) -> None:
    middle = quarter_phases(chart.tile(3, 3))[
        2 * chart.rows : 4 * chart.rows, 2 * chart.columns : 4 * chart.columns
    ]
    np.testing.assert_array_equal(quarter_phases(chart, periodic=True), middle)


@given(stitch_charts())
def test_neighbours_agree_on_the_segment_between_them(chart: StitchChart) -> None:
    code = surroundings(chart)
    assert ((code[:, :-1] & RIGHT > 0) == (code[:, 1:] & LEFT > 0)).all()
    assert ((code[:-1] & ABOVE > 0) == (code[1:] & BELOW > 0)).all()


def test_one_purl_in_stockinette() -> None:
    grid = np.zeros((5, 5), dtype=bool)
    grid[2, 2] = True
    code = surroundings(StitchChart(grid))
    assert code[2, 2] == LEFT | RIGHT | BELOW | ABOVE
    assert [code[2, 1], code[2, 3], code[1, 2], code[3, 2]] == [RIGHT, LEFT, ABOVE, BELOW]
    assert np.count_nonzero(code) == 5
