# ruff: noqa: N999 - a command's module bears its name
"""``knitcore import``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option
from app.operations.imports import import_path


@click.command("import")
@click.argument("file", type=click.Path(path_type=Path))
@json_option
def command(file: Path, as_json: bool) -> None:
    """Read the chart in FILE: K/P text, written rows, PNG, knitout or a design."""
    result = import_path(file)
    emit(result, result.chart, as_json=as_json)
