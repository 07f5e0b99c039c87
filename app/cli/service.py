"""Commands of those who run the service: ``doctor``, ``warm-up``, ``token``, ``backup``,
``restore``."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click
from pydantic import BaseModel, ValidationError

from knitcore.base.errors import InputError

from ..requests.base import first_fault
from .common import emit, json_option, open_database, user_settings

if TYPE_CHECKING:
    from ..service.web.sessions import Tokens


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


@contextlib.contextmanager
def _tokens() -> Iterator[Tokens]:
    from ..service.web.sessions import Tokens

    with open_database(user_settings()) as database:
        yield Tokens(database)


@click.group("token")
def token() -> None:
    """Create, list and revoke access tokens."""


@token.command("create")
@click.argument("user")
@click.option("--label", default="", help="What it is for.")
@click.option(
    "--days",
    type=click.FloatRange(min=0, min_open=True),
    help="Days after which it expires; never by default.",
)
@json_option
def create(user: str, label: str, days: float | None, as_json: bool) -> None:
    """Make a token of USER; it is shown this once."""
    with _tokens() as tokens:
        made = tokens.create(user, label, days)
    emit(made, f"{made.token}\n(id {made.id}; it is not shown again)", as_json=as_json)


@token.command("list")
@json_option
def list_(as_json: bool) -> None:
    """List all tokens, without their secrets."""
    with _tokens() as tokens:
        listed = tokens.all()
    lines = [
        f"{t.id}  {t.user:20} {t.created_at:%Y-%m-%d}  "
        f"{'revoked' if t.revoked_at else 'open'}  {t.label}"
        for t in listed.tokens
    ]
    emit(listed, "\n".join(lines), as_json=as_json)


@token.command("revoke")
@click.argument("identifier", metavar="ID")
@json_option
def revoke(identifier: str, as_json: bool) -> None:
    """Close the token ID; it stops working within seconds."""
    with _tokens() as tokens:
        tokens.revoke(identifier)
        closed = next(each for each in tokens.all().tokens if each.id == identifier)
    if as_json:
        emit(closed, "", as_json=True)


@click.command("backup")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False))
@json_option
def backup(file: Path, as_json: bool) -> None:
    """Write designs, links, users and own materials to FILE.

    Earlier versions of designs are kept with them. The service may run meanwhile.
    """
    from ..service.store.backup import back_up

    with open_database(user_settings()) as database:
        report = back_up(database, file)
    emit(report, report.text, as_json=as_json)


@click.command("restore")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False, exists=True))
@json_option
def restore(file: Path, as_json: bool) -> None:
    """Read the backup FILE into an empty data folder.

    The settings name the folder, or the database.
    """
    from ..service.store import backup as store

    settings = user_settings()
    with open_database(settings, migrated=False) as database:
        report = store.restore(database, file)
    emit(report, report.text, as_json=as_json)
