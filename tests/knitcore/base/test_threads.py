"""Two functions side by side."""

import pytest

from knitcore.base.threads import side_by_side


def test_results_come_in_order() -> None:
    assert side_by_side(lambda: 1, lambda: 2) == [1, 2]


@pytest.mark.parametrize("bad", [0, 1])
def test_exceptions_of_a_function_are_raised(bad: int) -> None:
    def work(number: int) -> int:
        return 1 // (number - bad)

    with pytest.raises(ZeroDivisionError):
        side_by_side(lambda: work(0), lambda: work(1))
