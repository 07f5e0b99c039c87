"""Colours of yarns, and those that the page and the 3D view share."""

import re
from pathlib import Path

import numpy as np
import pytest

from app.drawing.colours import (
    BATLOW,
    FABRIC_COLOURS,
    UNDYED,
    VIK,
    diverging,
    fabric_mix,
    named_colour,
    rgb,
    sequential,
)
from app.drawing.stitch_colours import Palette

FRONTEND = Path(__file__).resolve().parents[3] / "frontend"


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


def test_the_default_palette_is_the_page_s_light_theme() -> None:
    styles = (FRONTEND / "styles" / "tokens.css").read_text(encoding="utf-8")
    for fabric, colour in FABRIC_COLOURS.items():
        assert f"--{fabric.value}: light-dark(#{colour}, " in styles


def test_the_page_sends_the_colours_of_its_theme() -> None:
    """A dark page has a 3D view in its own colours, and nobody keeps a second list of them."""
    fabrics = (FRONTEND / "grid" / "segments.js").read_text(encoding="utf-8")
    declared = re.search(r"const FABRICS = .*?\[(.*?)\]", fabrics)
    assert declared is not None
    assert set(re.findall(r"\w+", declared[1])) == set(Palette.model_fields) - {"yarn"}
    view = (FRONTEND / "panels" / "fabric" / "fabricview.js").read_text(encoding="utf-8")
    assert "{ written: palette } = readPalette()" in view


def test_colours_follow_their_maps() -> None:
    low, high = sequential([1.0, 100.0], 1.0, 100.0)
    middle = sequential([10.0], 1.0, 100.0, log=True)[0]
    assert low.tolist() == [0x01, 0x19, 0x59]
    assert high.tolist() == [0xFA, 0xCC, 0xFA]
    np.testing.assert_array_equal(middle, sequential([50.5], 1.0, 100.0)[0])
    assert diverging([0.0], 1.0)[0].tolist() == [0xEC, 0xE5, 0xE0]
    assert fabric_mix(np.eye(4))[0].tolist() == [0x3F, 0x74, 0xB5]


@pytest.mark.parametrize(("name", "stops"), [("BATLOW", BATLOW), ("VIK", VIK)])
def test_maps_have_the_same_stops(name: str, stops: str) -> None:
    script = (FRONTEND / "state" / "colormaps.js").read_text(encoding="utf-8")
    declared = script[script.index(f"const {name} =") :]
    declared = declared[: declared.index(";")]
    assert re.findall(r"\b[0-9a-f]{6}\b", declared) == stops.split()
