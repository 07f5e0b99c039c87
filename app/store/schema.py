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


def migrate(database: Database) -> None:
    """Bring the schema to this program's version; does nothing if it is there already.

    Raises
    ------
    InputError
        If the database was written by a newer program.
    StoreError
        If the database cannot be reached.
    """
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    found = revision(database)
    known = {script.revision for script in ScriptDirectory.from_config(config).walk_revisions()}
    if found is not None and found not in known:
        raise InputError(
            "database_url",
            f"the database has schema {found}, which this program does not know.",
            "Use the newer program that wrote it, or restore a backup.",
        )

    def upgrade(connection: object) -> None:
        config.attributes["connection"] = connection
        command.upgrade(config, "head")

    database.write(upgrade)


def revision(database: Database) -> str | None:
    """The schema's version, or None for an empty database."""
    with database.read() as connection:
        return MigrationContext.configure(connection).get_current_revision()
