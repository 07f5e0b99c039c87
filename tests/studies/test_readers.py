"""Files that are as awkward as they can be take time as their bytes, not as their square."""

import pytest

from studies.speed.readers import CASES, ENOUGH_S, growth

MOST = 10.0
"""Time of four times the file over that of the file: linear is 4, quadratic 16."""


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_four_times_the_file_takes_about_four_times_as_long(name: str) -> None:
    _, (once, _, four_times) = growth(CASES[name])
    assert four_times < ENOUGH_S or four_times < MOST * once
