import pytest
from hypothesis import given

from knitcore import InputError, StitchChart
from knitcore.chart.repeats import known_larger_repeats, primitive_repeats, repeats_up_to
from tests.knitcore.charts import stitch_charts


@pytest.mark.parametrize(
    ("rows", "columns", "stitches", "count"), [(3, 3, 16, 36), (4, 4, 8, 53), (4, 4, 16, 1479)]
)
def test_numbers_of_repeats(rows: int, columns: int, stitches: int, count: int) -> None:
    """Counted independently in the composite study: 36, 53 and 1,479."""
    repeats = repeats_up_to(rows, columns, stitches=stitches)
    assert len(repeats) == count
    assert len(set(repeats)) == count


def test_the_four_fabrics_are_the_smallest_repeats() -> None:
    fabrics = [StitchChart.of_fabric(f, 2, 2) for f in ("stockinette", "garter", "rib", "seed")]
    canonical = [fabric.canonical() for fabric in fabrics]
    assert len(set(canonical)) == 4
    assert set(canonical) < set(repeats_up_to(2, 2))


@given(chart=stitch_charts(most=4))
def test_every_chart_is_a_repeat_of_the_list(chart: StitchChart) -> None:
    assert chart.canonical() in repeats_up_to(4, 4)


def test_the_larger_ones_are_new_and_fit_8_x_8() -> None:
    larger = known_larger_repeats()
    assert len(larger) == len(set(larger)) > 20
    assert not set(larger) & set(repeats_up_to(4, 4))
    assert all(max(chart.purl.shape) <= 8 for chart in larger)


def test_too_many_stitches_are_refused() -> None:
    with pytest.raises(InputError, match="cannot be enumerated"):
        primitive_repeats(5, 4)
