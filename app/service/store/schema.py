"""The schema of the database, brought up to date by its migrations."""

from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import inspect

from knitcore.base.errors import InputError

from ..problems import DamagedError
from .database import Database
from .tables import metadata

MIGRATIONS = Path(__file__).with_name("migrations")


def migrate(database: Database, target: str = "head") -> None:
    """Bring the schema to a version, by default this program's; does nothing if it is there.

    An SQLite file is copied first, to one that is named after the new schema.

    Raises
    ------
    InputError
        If the database (or the backup that asks for ``target``) was written by another
        version of this program.
    StoreError
        If the database cannot be reached.
    """
    version = check_schema(database, target)
    config = _config()
    head = ScriptDirectory.from_config(config).get_current_head()
    if version not in (None, head) and target == "head":
        with database.failures():
            database.backend.keep_copy(f"before-{head}")

    def upgrade(connection: object) -> None:
        config.attributes["connection"] = connection
        command.upgrade(config, target)

    database.write(upgrade)


def check_schema(database: Database, target: str = "head") -> str | None:
    """The schema's version, or None for an empty database.

    Raises
    ------
    InputError
        As :func:`migrate`.
    DamagedError
        If a table of this program's schema is missing.
    StoreError
        If the database cannot be reached.
    """
    version = revision(database)
    scripts = ScriptDirectory.from_config(_config())
    strange = {version, target} - {s.revision for s in scripts.walk_revisions()} - {None, "head"}
    if strange:
        raise InputError(
            "database_url",
            f"the designs have schema {strange.pop()}, which this program does not know.",
            "Use the program that wrote it, or restore a backup.",
        )
    if version == scripts.get_current_head():
        with database.read() as connection:
            missing = set(metadata.tables) - set(inspect(connection).get_table_names())
        if missing:
            raise DamagedError(f"The database lacks {', '.join(sorted(missing))}.")
    return version


def _config() -> Config:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.attributes["metadata"] = metadata
    return config


def revision(database: Database) -> str | None:
    """The schema's version, or None for an empty database."""
    with database.read() as connection:
        return MigrationContext.configure(connection).get_current_revision()
