"""``knitcore backup``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option, open_database, user_settings


@click.command("backup")
@click.argument("file", type=click.Path(path_type=Path, dir_okay=False))
@json_option
def command(file: Path, as_json: bool) -> None:
    """Write designs, versions, links, users and own materials to FILE; the service may run."""
    from app.service.results.own_materials import FOLDER
    from app.service.store.backup import back_up

    settings = user_settings()
    with open_database(settings) as database:
        report = back_up(database, file, settings.folder / FOLDER)
    emit(report, report.text, as_json=as_json)
