import numpy as np
import pytest
from hypothesis import given
from numpy.typing import NDArray

from knitcore import Fabric, StitchChart, quarter_phases
from knitcore.chart.phases import (
    ABOVE,
    BELOW,
    LEFT,
    QUARTERS_OF_CODE,
    RIGHT,
    pure_fabric,
    reference_fabric,
    surroundings,
)
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
def test_phases_of_a_repeat_are_those_of_the_middle_of_a_tiling(chart: StitchChart) -> None:
    rows = slice(2 * chart.rows, 4 * chart.rows)
    columns = slice(2 * chart.columns, 4 * chart.columns)
    repeat = quarter_phases(chart, periodic=True)
    np.testing.assert_array_equal(repeat, quarter_phases(chart.tile(3, 3))[rows, columns])


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


def test_the_quarters_of_a_stitch_take_the_segments_that_they_touch() -> None:
    assert QUARTERS_OF_CODE.shape == (16, 2, 2)
    for code in range(16):
        for up, wale in enumerate((BELOW, ABOVE)):
            for right, course in enumerate((LEFT, RIGHT)):
                expected = 2 * bool(code & course) + bool(code & wale)
                assert QUARTERS_OF_CODE[code, up, right] == expected


OUTLINE = np.array([[1, 1, 1, 1], [1, 1, 1, 1], [0, 1, 1, 0], [0, 1, 1, 0]], dtype=bool)


@pytest.mark.parametrize("outline", [OUTLINE, OUTLINE[::-1], OUTLINE.T, OUTLINE.T[:, ::-1]])
@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_is_pure_up_to_its_outline(
    fabric: Fabric, outline: NDArray[np.bool_]
) -> None:
    chart = StitchChart.of_fabric(fabric, *outline.shape)
    other = StitchChart(np.where(outline, chart.purl, ~chart.purl))  # what is outside is not there
    codes, phases = (of(other, stitch=outline) for of in (surroundings, quarter_phases))
    np.testing.assert_array_equal(codes[outline], surroundings(chart)[outline])
    quarters = np.kron(outline, np.ones((2, 2), dtype=bool))
    assert (phases[quarters] == fabric.phase).all()


def test_a_segment_that_is_not_there_is_like_the_one_on_the_other_side() -> None:
    lone = np.array([[1, 1], [1, 0]], dtype=bool)  # an L of three stitches
    codes = surroundings(StitchChart.parse("KK/PK"), stitch=lone)
    assert codes[0].tolist() == [LEFT | RIGHT | BELOW | ABOVE, LEFT | RIGHT]
    assert codes[1, 0] == BELOW | ABOVE


@pytest.mark.parametrize("fabric", list(Fabric))
def test_a_pure_fabric_is_recognised_however_it_is_cut(fabric: Fabric) -> None:
    chart = StitchChart.of_fabric(fabric, rows=5, columns=7)
    assert pure_fabric(chart) is pure_fabric(chart.turn_over()) is fabric
    assert pure_fabric(StitchChart.parse("KKKP")) is None


@pytest.mark.parametrize(
    ("repeat", "reference"),
    [
        ("K", Fabric.STOCKINETTE),
        ("K/P", Fabric.GARTER),
        ("KKP", Fabric.RIB),
        ("K/K/P", Fabric.GARTER),
        ("KKK/KPK/KKK", Fabric.SEED),
    ],
)
def test_the_reference_has_odd_segments_where_the_repeat_has_any(
    repeat: str, reference: Fabric
) -> None:
    assert reference_fabric(StitchChart.parse(repeat)) is reference
