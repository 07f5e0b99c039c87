"""``knitcore token``."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from .common import emit, json_option, open_database, user_settings

if TYPE_CHECKING:
    from ..service.web.tokens import Tokens


@contextlib.contextmanager
def _tokens() -> Iterator[Tokens]:
    from ..service.web.tokens import Tokens

    with open_database(user_settings()) as database:
        yield Tokens(database)


@click.group("token")
def command() -> None:
    """Create, list and revoke access tokens."""


@command.command("create")
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


@command.command("list")
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


@command.command("revoke")
@click.argument("identifier", metavar="ID")
@json_option
def revoke(identifier: str, as_json: bool) -> None:
    """Close the token ID; it stops working within seconds."""
    with _tokens() as tokens:
        tokens.revoke(identifier)
        closed = next(token for token in tokens.all().tokens if token.id == identifier)
    if as_json:
        emit(closed, "", as_json=True)
