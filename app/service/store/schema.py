"""The schema of the database, brought up to date by its migrations."""

from pathlib import Path

from sqlalchemy import inspect, text

from knitcore.base.errors import InputError

from ..problems import DamagedError
from .database import Database
from .material_store import FOLDER, MaterialStore
from .tables import metadata

MIGRATIONS = Path(__file__).with_name("migrations")
EARLIER = frozenset(f"{number:04}" for number in range(1, 8))
"""Schemas from before the first release, which this program cannot bring up to date."""
LAST_WITH_EARLIER = "5a988aec"
"""The last commit of this program that can."""


def migrate(database: Database, target: str = "head") -> None:
    """Bring the schema to a version, by default this program's; does nothing if it is there.

    An SQLite file is copied first, to one that is named after the new schema.

    Raises
    ------
    InputError
        If the database (or the backup that asks for ``target``) was written by a newer program,
        or by one from before the first release.
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


def prepare(database: Database, data_dir: Path) -> None:
    """Bring the schema up to date, and take over files of users' materials.

    Raises
    ------
    InputError, StoreError
        As :func:`migrate`.
    """
    migrate(database)
    MaterialStore(database).take_over(data_dir / FOLDER)


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
    if too_old := {version, target} & EARLIER:
        raise InputError(
            "database_url",
            f"the designs have schema {too_old.pop()}, from before the first release.",
            f"Start Knitcore at commit {LAST_WITH_EARLIER} on them once, which brings them up to "
            "date.",
        )
    strange = {version, target} - {*versions, None, "head"}
    if strange:
        raise InputError(
            "database_url",
            f"the designs have schema {strange.pop()}, which this program does not know.",
            "Use the newer program that wrote it, or restore a backup.",
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
