"""``knitcore restore``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option, open_database, user_settings


@click.command("restore")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False, exists=True))
@json_option
def command(file: Path, as_json: bool) -> None:
    """Read the backup FILE into the empty data folder or database of the settings."""
    from app.service.results.own_materials import FOLDER
    from app.service.store.backup import restore

    settings = user_settings()
    with open_database(settings, migrated=False) as database:
        report = restore(database, file, settings.folder / FOLDER)
    emit(report, report.text, as_json=as_json)
