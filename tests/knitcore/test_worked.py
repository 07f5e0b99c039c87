from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from knitcore import InputError, StitchChart
from knitcore.worked import Construction, Side, WorkedRow, WorkedRows, as_worked, face_grid
from tests.knitcore.charts import stitch_charts


@given(
    chart=stitch_charts(),
    construction=st.sampled_from(Construction),
    first_side=st.sampled_from(Side),
)
def test_worked_rows_make_their_chart(
    chart: StitchChart, construction: Construction, first_side: Side
) -> None:
    assert face_grid(as_worked(chart, construction, first_side=first_side)) == chart


@given(chart=stitch_charts())
def test_beginning_on_the_other_side_is_working_the_back_of_the_cloth(chart: StitchChart) -> None:
    front, back = as_worked(chart, first_side=Side.WS), as_worked(chart.turn_over())
    assert [row.purls for row in front.rows] == [row.purls for row in back.rows]


def test_flat_garter_is_knit_every_row() -> None:
    rows = as_worked(StitchChart.of_fabric("garter", rows=5, columns=4)).rows
    assert all(row.purls == (False,) * 4 for row in rows)


def test_flat_stockinette_is_knitted_and_purled_in_turn() -> None:
    rows = as_worked(StitchChart.of_fabric("stockinette", rows=3, columns=2)).rows
    assert rows == (
        WorkedRow(Side.RS, (False, False)),
        WorkedRow(Side.WS, (True, True)),
        WorkedRow(Side.RS, (False, False)),
    )


def test_a_right_side_row_is_worked_from_the_right() -> None:
    assert as_worked(StitchChart.parse("KKP")).rows[0].purls == (True, False, False)


def test_rows_of_different_length_are_refused() -> None:
    rows = (WorkedRow(Side.RS, (True,)), WorkedRow(Side.WS, (True, False)))
    with pytest.raises(InputError, match="row 2 has 2"):
        face_grid(WorkedRows(Construction.FLAT, Side.RS, rows))
