"""Colours of yarns."""

import pytest

from app.drawing.colours import UNDYED, named_colour, rgb


@pytest.mark.parametrize(
    ("name", "colour"),
    [
        ("Pearl cotton 3/2, 1800-13 sapphire, Halcyon Yarn", (31, 74, 168)),
        ("Merino, navy", (0, 0, 128)),
        ("Blue mohair, special celeste", (159, 198, 216)),
        ("Merino 4711", rgb(UNDYED)),
        ("", rgb(UNDYED)),
    ],
)
def test_a_yarn_has_the_colour_of_its_name(name: str, colour: tuple[int, int, int]) -> None:
    assert named_colour(name) == colour
