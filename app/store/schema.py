"""The schema of the database, brought up to date by its migrations."""

from __future__ import annotations

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory

from app.store.database import Database
from knitcore.errors import InputError

MIGRATIONS = Path(__file__).with_name("migrations")


def migrate(database: Database, target: str = "head") -> None:
    """Bring the schema to a version, by default this program's; does nothing if it is there.

    Raises
    ------
    InputError
        If the database (or the backup that asks for ``target``) was written by a newer program.
    StoreError
        If the database cannot be reached.
    """
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    found = revision(database)
    known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
    strange = {found, target} - known - {None, "head"}
    if strange:
        raise InputError(
            "database_url",
            f"the designs have schema {strange.pop()}, which this program does not know.",
            "Use the newer program that wrote it, or restore a backup.",
        )

    def upgrade(connection: object) -> None:
        config.attributes["connection"] = connection
        command.upgrade(config, target)

    database.write(upgrade)


def revision(database: Database) -> str | None:
    """The schema's version, or None for an empty database."""
    with database.read() as connection:
        return MigrationContext.configure(connection).get_current_revision()
