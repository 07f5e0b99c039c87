"""A context for operations on cloth."""

from pathlib import Path

import pytest

from app.context import Context


@pytest.fixture
def context(tmp_path: Path) -> Context:
    return Context(tmp_path)
