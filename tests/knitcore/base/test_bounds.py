import math

import numpy as np
import pytest

from knitcore import InputError
from knitcore.base.bounds import check_count, check_linear_density, check_positive, check_range


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_positive_numbers_are_finite_and_above_zero(value: float) -> None:
    check_positive("width_mm", 1e-9, "mm")
    with pytest.raises(InputError, match=r"is not a width. Give a number above 0 mm"):
        check_positive("width_mm", value, "mm", "a width")


def test_the_largest_number_is_named() -> None:
    check_positive("mmhg", 300, most=300)
    with pytest.raises(InputError, match=r"301 mmHg is not positive. Give above 0 to 300 mmHg."):
        check_positive("mmhg", 301, "mmHg", most=300)


@pytest.mark.parametrize("value", [-0.7, 1.1, math.nan, -math.inf])
def test_a_range_has_both_its_ends(value: float) -> None:
    check_range("ease", -0.6, -0.6, 1)
    check_range("ease", 1, -0.6, 1)
    with pytest.raises(InputError, match=r"not in range. Give -0.6 to 1.$"):
        check_range("ease", value, -0.6, 1)


@pytest.mark.parametrize("value", [2.5, 2.0, math.nan])
def test_a_count_is_a_whole_number(value: float) -> None:
    check_count("rounds", np.int64(2), 2, 200)
    with pytest.raises(InputError, match=r"is not a whole number. Give 2 to 200.$"):
        check_count("rounds", value, 2, 200)
    with pytest.raises(InputError, match=r"1 is not in range. Give 2 to 200.$"):
        check_count("rounds", 1, 2, 200)


def test_a_linear_density_in_tex_is_refused_with_the_unit() -> None:
    check_linear_density(0.5)
    with pytest.raises(InputError, match=r"tex divided by 1000"):
        check_linear_density(500)
