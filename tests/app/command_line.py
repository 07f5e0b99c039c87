"""The command line in tests."""

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner, Result

from app.cli.main import main
from knitcore.base.compiled import COMPILING

Argument = str | float | Path


def printed(*arguments: Argument) -> Result:
    """Run a command that succeeds."""
    result = CliRunner().invoke(main, list(map(str, arguments)))
    assert result.exit_code == 0, result.output
    return result


def run(*arguments: Argument) -> Any:
    """The one JSON object that a command prints, and nothing else."""
    result = printed(*arguments, "--json")
    assert result.stderr.replace(f"{COMPILING}\n", "") == ""
    return json.loads(result.stdout)


def refused(*arguments: Argument) -> str:
    """Words on stderr of a command that refuses its arguments, and prints nothing else."""
    result = CliRunner().invoke(main, list(map(str, arguments)))
    assert (result.exit_code, result.stdout) == (2, "")
    return result.stderr
