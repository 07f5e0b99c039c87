"""The command line in tests."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from app.cli.main import main
from knitcore.base.compiled import COMPILING


def run(*arguments: str | float | Path) -> Any:
    """The one JSON object that a command prints, and nothing else."""
    result = CliRunner().invoke(main, [*map(str, arguments), "--json"])
    assert result.exit_code == 0, result.output
    assert result.stderr.replace(f"{COMPILING}\n", "") == ""
    return json.loads(result.stdout)
