"""Names of needles."""

import pytest

from knitcore.machine.home.needle_places import needle_name, needle_words


@pytest.mark.parametrize("width", [1, 2, 7, 200])
def test_needles_are_counted_from_the_middle(width: int) -> None:
    names = [needle_name(place, width) for place in range(width)]
    assert len(set(names)) == width
    assert names[(width - 1) // 2] == "L1"
    assert len([name for name in names if name[0] == "L"]) - width / 2 in (0, 0.5)


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ([3], "L1"),
        ([2, 3, 4], "L2–R1"),
        ([0, 2], "L4 and L2"),
        ([0, 2, 5], "L4, L2 and R2"),
        ([0, 2, 4, 6], "every 2nd needle from L4 to R3"),
        ([0, 1, 2, 4, 5, 6], "L4–L2 and R1–R3"),
    ],
)
def test_needles_in_words(places: list[int], words: str) -> None:
    assert needle_words(places, 8) == words


def test_blocks_at_equal_distances_are_said_together() -> None:
    places = [place for place in range(16) if place % 4 < 2]
    assert needle_words(places, 16) == "2 of every 4 needles from L8 to R6"
