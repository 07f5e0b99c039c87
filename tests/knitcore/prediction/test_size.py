"""Relaxed sizes that are given."""

import math

import pytest

from knitcore import RelaxedSize
from tests.knitcore.refusals import refuses


@pytest.mark.parametrize(
    ("make", "field", "values"),
    [
        (lambda size: RelaxedSize(size, 3.0), "course_mm", [500.1]),
        (lambda size: RelaxedSize(3.0, size), "wale_mm", [500.1]),
        (lambda count: RelaxedSize.from_gauge(count, 30.0), "stitches_per_10_cm", []),
        (lambda count: RelaxedSize.from_gauge(30.0, count), "rows_per_10_cm", []),
    ],
)
def test_what_is_no_size_is_refused_by_name(make, field: str, values: list[float]) -> None:
    for value in (*values, 0.0, -1.0, math.nan, math.inf):
        with refuses(field):
            make(value)


def test_fine_and_coarse_cloth_is_taken() -> None:
    assert RelaxedSize(0.3, 499.0).wale_mm == 499.0
    assert RelaxedSize.from_gauge(0.5, 400.0) == RelaxedSize(200.0, 0.25)
