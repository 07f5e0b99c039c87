"""The figures of the mechanics pages show what the code computes now."""

import runpy
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[3] / "docs" / "figures"
DRAWINGS = runpy.run_path(str(FOLDER / "draw_mechanics.py"))["FIGURES"]


@pytest.mark.parametrize("name", DRAWINGS)
def test_figures_are_current(name):
    assert (FOLDER / name).read_text(encoding="utf-8") == DRAWINGS[name]()
