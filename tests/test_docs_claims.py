"""The threat model names a test for every claim; they must exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "threat-model.md").read_text()
NAMED = sorted(set(re.findall(r"`(test_\w+\.py)::(test_\w+)`", PAGE)))


@pytest.mark.parametrize(("file", "test"), NAMED)
def test_a_named_test_exists(file: str, test: str) -> None:
    named = [path.read_text() for path in (ROOT / "tests").rglob(file)]
    assert any(re.search(rf"^def {test}\(", text, re.MULTILINE) for text in named)


def test_every_threat_has_a_test() -> None:
    lines = [line for line in PAGE.splitlines() if line.startswith("| ")]
    rows = [line for line in lines if not line.endswith("| test |")]  # heads of the tables
    assert len(rows) > 15
    assert [row for row in rows if "::test_" not in row] == []
