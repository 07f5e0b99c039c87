import pytest
from hypothesis import given

from knitcore import InputError, StitchChart
from knitcore.chart.row_sides import Side
from knitcore.garment.piece import MAIN_YARN
from knitcore.garment.worked_piece import PieceRow, piece_from_rows, piece_rows
from tests.knitcore.charts import stitch_charts


@given(chart=stitch_charts())
def test_beginning_on_the_other_side_is_working_the_back_of_the_cloth(chart: StitchChart) -> None:
    front, back = piece_rows(chart, first_side=Side.WS), piece_rows(chart.turn_over())
    assert [row.stitches for row in front] == [row.stitches for row in back]


def test_a_right_side_row_is_worked_from_the_right() -> None:
    assert piece_rows(StitchChart.parse("KKP"))[0].stitches == (True, False, False)


def test_rows_of_different_length_are_refused() -> None:
    rows = PieceRow(Side.RS, 0, 0, (True,), (0,)), PieceRow(Side.WS, 0, 0, (True, False), (0, 0))
    with pytest.raises(InputError, match="row 2 has 2"):
        piece_from_rows(rows, [MAIN_YARN])
