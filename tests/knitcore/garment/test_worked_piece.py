import pytest
from hypothesis import given

from knitcore import InputError, StitchChart
from knitcore.chart.row_sides import Construction, Side
from knitcore.garment.piece import MAIN_YARN
from knitcore.garment.worked_piece import PieceRow, piece_from_rows, piece_rows
from tests.knitcore.charts import WAYS_TO_WORK, stitch_charts


@given(chart=stitch_charts(), way=WAYS_TO_WORK)
def test_worked_rows_make_their_chart(chart: StitchChart, way: tuple[Construction, Side]) -> None:
    rows = piece_rows(chart, way[0], first_side=way[1])
    assert piece_from_rows(rows, [MAIN_YARN]).chart == chart


@given(chart=stitch_charts())
def test_beginning_on_the_other_side_is_working_the_back_of_the_cloth(chart: StitchChart) -> None:
    front, back = piece_rows(chart, first_side=Side.WS), piece_rows(chart.turn_over())
    assert [row.purls for row in front] == [row.purls for row in back]


def test_flat_garter_is_knit_every_row() -> None:
    rows = piece_rows(StitchChart.of_fabric("garter", rows=5, columns=4))
    assert all(row.purls == (False,) * 4 for row in rows)


def test_flat_stockinette_is_knitted_and_purled_in_turn() -> None:
    rows = piece_rows(StitchChart.of_fabric("stockinette", rows=3, columns=2))
    assert [(row.side, row.purls) for row in rows] == [
        (Side.RS, (False, False)),
        (Side.WS, (True, True)),
        (Side.RS, (False, False)),
    ]


def test_a_right_side_row_is_worked_from_the_right() -> None:
    assert piece_rows(StitchChart.parse("KKP"))[0].purls == (True, False, False)


def test_rows_of_different_length_are_refused() -> None:
    rows = PieceRow(Side.RS, 0, 0, (True,), (0,)), PieceRow(Side.WS, 0, 0, (True, False), (0, 0))
    with pytest.raises(InputError, match="row 2 has 2"):
        piece_from_rows(rows, [MAIN_YARN])
