"""The page checks designs itself (`frontend/design/design.js`): with the library's limits."""

import re
from pathlib import Path

from knitcore.formats.designs import design_file as design
from knitcore.formats.designs import layout

SCRIPT = Path(__file__).resolve().parents[4] / "frontend" / "design" / "design.js"


def test_the_page_has_the_librarys_limits() -> None:
    script = SCRIPT.read_text(encoding="utf-8")
    limits = dict(re.findall(r"^export const (MAX_\w+) = ([\d_]+);", script, re.MULTILINE))
    assert {name: int(value) for name, value in limits.items()} == {
        "MAX_ITEMS": layout.MAX_ITEMS,
        "MAX_MOTIF": layout.MAX_MOTIF,
    }
    assert f'export const FORMAT = "{design.FORMAT}";' in script
    assert f"version: {design.VERSION}," in script
