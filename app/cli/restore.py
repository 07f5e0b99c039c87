"""``knitcore restore``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option, user_settings


@click.command("restore")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False, exists=True))
@json_option
def command(file: Path, as_json: bool) -> None:
    """Read the backup FILE into the empty data folder or database of the settings."""
    from app.results.own_materials import FOLDER
    from app.store.backup import restore
    from app.store.database import Database

    settings = user_settings()
    database = Database(settings.store_url)
    try:
        report = restore(database, file, settings.folder / FOLDER)
    finally:
        database.close()
    counts = ", ".join(f"{count} {name}" for name, count in report.tables.items())
    emit(report, f"{report.file}: {counts}", as_json=as_json)
