"""Relaxed sizes that are given."""

import math

import pytest

from knitcore import InputError, RelaxedSize


@pytest.mark.parametrize("size", [0.0, -1.0, 500.1, math.nan, math.inf])
def test_what_is_no_size_is_refused_by_name(size: float) -> None:
    with pytest.raises(InputError) as course:
        RelaxedSize(size, 3.0)
    with pytest.raises(InputError) as wale:
        RelaxedSize(3.0, size)
    assert (course.value.field, wale.value.field) == ("course_mm", "wale_mm")


@pytest.mark.parametrize("count", [0.0, -5.0, math.nan, math.inf])
def test_what_is_no_gauge_is_refused_by_name(count: float) -> None:
    with pytest.raises(InputError) as stitches:
        RelaxedSize.from_gauge(count, 30.0)
    with pytest.raises(InputError) as rows:
        RelaxedSize.from_gauge(30.0, count)
    assert stitches.value.field == "stitches_per_10_cm"
    assert rows.value.field == "rows_per_10_cm"


def test_fine_and_coarse_cloth_is_taken() -> None:
    assert RelaxedSize(0.3, 499.0).wale_mm == 499.0
    assert RelaxedSize.from_gauge(0.5, 400.0) == RelaxedSize(200.0, 0.25)
