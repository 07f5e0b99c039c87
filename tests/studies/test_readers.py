"""Files that are as awkward as they can be take time as their bytes, not as their square."""

import pytest

from studies.speed.readers import CASES, ENOUGH_S, growth

MOST = 3.0
"""Time of twice the file over that of the file: linear is 2, quadratic 4."""


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_twice_the_file_takes_about_twice_as_long(name: str) -> None:
    """Once of two doublings, at once or again: a machine that does much else disturbs either."""
    assert any(grows_little(name, runs) for runs in (1, 3))


def grows_little(name: str, runs: int) -> bool:
    """True if the time of a case is short, or grows with the file and no faster."""
    _, (once, twice, four_times) = growth(CASES[name], runs)
    return four_times < ENOUGH_S or min(twice / once, four_times / twice) < MOST
