"""The schema of the database, brought up to date by its migrations."""

from pathlib import Path

from sqlalchemy import inspect, text

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
    head = _versions()[-1]
    if version == (head if target == "head" else target):
        return
    if version is not None and target == "head":
        with database.failures():
            database.backend.keep_copy(f"before-{head}")

    def upgrade(connection: object) -> None:
        from alembic import command  # a database that is up to date is spared it
        from alembic.config import Config

        config = Config()
        config.set_main_option("script_location", str(MIGRATIONS))
        config.attributes["metadata"] = metadata
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
    versions = _versions()
    strange = {version, target} - {*versions, None, "head"}
    if strange:
        raise InputError(
            "database_url",
            f"the designs have schema {strange.pop()}, which this program does not know.",
            "Use the program that wrote it, or restore a backup.",
        )
    if version == versions[-1]:
        with database.read() as connection:
            missing = set(metadata.tables) - set(inspect(connection).get_table_names())
        if missing:
            raise DamagedError(f"The database lacks {', '.join(sorted(missing))}.")
    return version


def _versions() -> list[str]:
    """All schemas, the latest last: the files of migrations begin with their names."""
    files = (MIGRATIONS / "versions").glob("[!_]*.py")
    return sorted(file.stem.partition("_")[0] for file in files)


def revision(database: Database) -> str | None:
    """The schema's version, or None for an empty database."""
    with database.read() as connection:
        if not inspect(connection).has_table("alembic_version"):
            return None
        version: str | None = connection.scalar(text("SELECT version_num FROM alembic_version"))
        return version
