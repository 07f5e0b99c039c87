"""``knitcore backup``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option, user_settings


@click.command("backup")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False))
@json_option
def command(file: Path, as_json: bool) -> None:
    """Write designs, versions, links, users and own materials to FILE; the service may run."""
    from app.results.own_materials import FOLDER
    from app.store.backup import back_up
    from app.store.database import Database
    from app.store.schema import migrate

    settings = user_settings()
    database = Database(settings.store_url)
    try:
        migrate(database)
        report = back_up(database, file, settings.folder / FOLDER)
    finally:
        database.close()
    counts = ", ".join(f"{count} {name}" for name, count in report.tables.items())
    emit(report, f"{report.file}: {counts}", as_json=as_json)
