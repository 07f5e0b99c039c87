"""``knitcore backup`` and ``knitcore restore``."""

from __future__ import annotations

from pathlib import Path

import click

from .common import emit, json_option, open_database, user_settings


@click.command("backup")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False))
@json_option
def backup(file: Path, as_json: bool) -> None:
    """Write designs, links, users and own materials to FILE.

    Earlier versions of designs are kept with them. The service may run meanwhile.
    """
    from ..service.results.own_materials import FOLDER
    from ..service.store.backup import back_up

    settings = user_settings()
    with open_database(settings) as database:
        report = back_up(database, file, settings.folder / FOLDER)
    emit(report, report.text, as_json=as_json)


@click.command("restore")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False, exists=True))
@json_option
def restore(file: Path, as_json: bool) -> None:
    """Read the backup FILE into an empty data folder.

    The settings name the folder, or the database.
    """
    from ..service.results.own_materials import FOLDER
    from ..service.store import backup as store

    settings = user_settings()
    with open_database(settings, migrated=False) as database:
        report = store.restore(database, file, settings.folder / FOLDER)
    emit(report, report.text, as_json=as_json)
