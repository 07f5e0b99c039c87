"""What commands share: the chart argument, the material option and the two ways of printing."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click
from pydantic import BaseModel

from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.garment.piece import Piece
from knitcore.patterns import patterns

if TYPE_CHECKING:
    from app.settings import Settings
    from app.store.database import Database

json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")


def resolve_chart(chart: str, size: str | None) -> StitchChart:
    """The chart that CHART and --size name: a file, or a fabric or a pattern of a size.

    Raises
    ------
    InputError
        If it is none, or the size is missing or malformed.
    """
    if Path(chart).suffix:
        from knitcore.formats.chart_files import read_chart  # a fabric needs no readers

        if size is not None:
            raise InputError(
                "size", "goes with the name of a fabric, not with a file.", "Leave --size out."
            )
        return read_chart(chart)
    named = {str(fabric): StitchChart.of_fabric(fabric) for fabric in Fabric}
    if chart.lower() not in named:
        named |= {pattern.identifier: pattern.chart for pattern in patterns()}
    if chart.lower() not in named:
        names = ", ".join(named)
        raise InputError(
            "chart",
            f"{chart!r} is neither a file nor a fabric.",
            f"Name a .txt, .png or .json file, or one of {names} with --size.",
        )
    if size is None:
        raise InputError("size", f"{chart} needs a size.", "Add --size COLUMNSxROWS.")
    match = re.fullmatch(r"(\d{1,6})[x×](\d{1,6})", size.strip().lower())
    if match is None:
        raise InputError("size", f"{size!r} is not a size.", "Write COLUMNSxROWS, such as 31x20.")
    return named[chart.lower()].resized(rows=int(match[2]), columns=int(match[1]))


def resolve_piece(chart: str, size: str | None) -> Piece:
    """As :func:`resolve_chart`, with the outline of a file that has one."""
    stitches = resolve_chart(chart, size)
    if not Path(chart).suffix:
        return Piece.plain(stitches)
    from knitcore.formats.chart_files import read_piece

    return read_piece(chart)


def user_settings() -> Settings:
    """The settings of the environment and of the user's file.

    Raises
    ------
    InputError
        If they cannot be read.
    """
    from pydantic_settings import SettingsError

    from app.settings import Settings

    try:
        return Settings()
    except SettingsError as error:
        raise InputError(
            "settings", f"{error}.", 'Write a list as JSON, such as ["knit.example"].'
        ) from error


@contextlib.contextmanager
def open_database(settings: Settings, *, migrated: bool = True) -> Iterator[Database]:
    """The database of the settings, brought up to date."""
    from app.store.database import Database
    from app.store.schema import migrate

    with contextlib.closing(Database(settings.store_url)) as database:
        if migrated:
            migrate(database)
        yield database


def user_data_dir() -> Path:
    """The data folder of the settings."""
    return user_settings().folder


def emit(result: BaseModel, text: str, *, as_json: bool) -> None:
    """Print a result as one JSON object, or as text for people."""
    click.echo(result.model_dump_json() if as_json else text)
