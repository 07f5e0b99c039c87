"""Readings of tables that users give, and sizes that may be in another unit."""

import pytest

from knitcore.measure.table_reading import TableReading, doubt_of_width


@pytest.mark.parametrize(
    ("width_mm", "beside_mm", "answers"),
    [
        (7.0, (70.0,), [70.0, 7.0]),
        (2.755, (70.0,), [69.977, 2.755]),
        (0.07, (), [70.0, 0.07]),
        (2.5, (), [25.0, 63.5, 2.5]),
        (7.0, (35.0,), []),  # a narrow strip beside a wide one
        (25.0, (250.0,), []),
    ],
)
def test_small_sizes_are_doubted_where_another_unit_fits(
    width_mm: float, beside_mm: tuple[float, ...], answers: list[float]
) -> None:
    doubt = doubt_of_width("a.csv", width_mm, beside_mm=beside_mm)
    assert [r.changes["width_mm"] for r in (doubt.readings if doubt else ())] == answers


def test_the_first_reading_comes_before_the_other() -> None:
    mine = TableReading(width_mm=25.0, units={"force_n": "cN"})
    template = TableReading(width_mm=70.0, length_mm=100.0, units={"force_n": "N", "run": ""})
    both = mine.over(template)
    assert (both.width_mm, both.length_mm) == (25.0, 100.0)
    assert both.units == {"force_n": "cN", "run": ""}
    assert both.sure == {"width_mm", "length_mm", "force_n", "run"}
