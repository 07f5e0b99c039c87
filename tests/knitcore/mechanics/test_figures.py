"""The figures of the mechanics pages show what the code computes now."""

import re
import runpy
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[3] / "docs" / "figures"
DRAWINGS = runpy.run_path(str(FOLDER / "draw_mechanics.py"))["FIGURES"]
NUMBER = re.compile(r"-?\d+\.\d")


@pytest.mark.parametrize("name", DRAWINGS)
def test_figures_are_current(name):
    stored, drawn = (FOLDER / name).read_text(encoding="utf-8"), DRAWINGS[name]()
    assert NUMBER.sub("", stored) == NUMBER.sub("", drawn)
    # Coordinates have one decimal: another machine may round the last one otherwise.
    assert [float(n) for n in NUMBER.findall(stored)] == pytest.approx(
        [float(n) for n in NUMBER.findall(drawn)], abs=0.11
    )
