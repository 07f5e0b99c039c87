"""``knitcore doctor`` and ``knitcore warm-up``, which are about this machine."""

from __future__ import annotations

import sys

import click
from pydantic import BaseModel, ValidationError

from knitcore.base.errors import InputError

from ..requests.base import first_fault
from .common import emit, json_option, user_settings


@click.command("doctor")
@json_option
def doctor(as_json: bool) -> None:
    """Check everything that the service needs.

    The exit code is 1 if a check fails.
    """
    from ..service.doctor import Check, Checks, examine

    try:
        report = examine(user_settings())
    except (InputError, ValidationError) as error:
        problem = f"{first_fault(error)}." if isinstance(error, ValidationError) else str(error)
        remedy = "Compare the environment and the file of KNITCORE_CONFIG with docs/serving.md."
        report = Checks(checks=[Check(name="settings", ok=False, problem=problem, remedy=remedy)])
    lines = [
        f"{'ok  ' if check.ok else 'FAIL'}  {check.name}"
        + (f": {check.note}" if check.note else "")
        + ("" if check.ok else f": {check.problem} {check.remedy}")
        for check in report.checks
    ]
    emit(report, "\n".join(lines), as_json=as_json)
    sys.exit(1 if report.failed else 0)


class Compiled(BaseModel):
    """Parts of the library whose solvers were compiled."""

    parts: list[str]


@click.command("warm-up")
@json_option
def warm_up(as_json: bool) -> None:
    """Compile all solvers for this processor now.

    Otherwise each is compiled when it is first needed.
    """
    from knitcore.warm_up import TASKS
    from knitcore.warm_up import warm_up as compile_parts

    click.echo(f"Compiling kernels for this processor in {len(TASKS)} parts …", err=True)
    parts: list[str] = []
    for part in compile_parts():
        parts.append(part)
        click.echo(f"{len(parts)} of {len(TASKS)}: {part}", err=True)
    if as_json:
        emit(Compiled(parts=parts), "", as_json=True)
