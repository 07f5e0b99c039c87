"""``knitcore doctor``."""

from __future__ import annotations

import sys

import click
from pydantic import ValidationError

from app.cli.common import emit, json_option, user_settings
from app.models.base import first_fault
from knitcore.errors import InputError


@click.command("doctor")
@json_option
def command(as_json: bool) -> None:
    """Check everything the service needs; exit code 1 if a check fails."""
    from app.service.doctor import Check, Checks, examine

    try:
        found = examine(user_settings())
    except (InputError, ValidationError) as error:
        problem = f"{first_fault(error)}." if isinstance(error, ValidationError) else str(error)
        remedy = "Compare the environment and the file of KNITCORE_CONFIG with docs/serving.md."
        found = Checks(checks=[Check(name="settings", ok=False, problem=problem, remedy=remedy)])
    lines = [
        f"{'ok  ' if check.ok else 'FAIL'}  {check.name}"
        + (f": {check.note}" if check.note else "")
        + ("" if check.ok else f": {check.problem} {check.remedy}")
        for check in found.checks
    ]
    emit(found, "\n".join(lines), as_json=as_json)
    sys.exit(1 if found.failed else 0)
