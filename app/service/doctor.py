"""Checks of an installation, for ``knitcore doctor``, at the start, and for ``/readyz``."""

from __future__ import annotations

import logging
import os
import shutil
from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import BaseModel, Field

from knitcore.base.errors import InputError

from .problems import ServiceError
from .settings import Settings
from .store.database import Database, backend_of, holder
from .store.schema import check_schema

if TYPE_CHECKING:
    from .compute.cluster import Cluster

log = logging.getLogger("knitcore.app")

MIN_FREE_BYTES = 100_000_000


class Check(BaseModel):
    """One check and its result."""

    name: str
    ok: bool
    problem: str | None = Field(None, description="Problem, in words.")
    remedy: str | None = Field(None, description="Remedy, in words.")
    note: str | None = Field(None, description="Further facts, in words.")


class Checks(BaseModel):
    """The results of all checks."""

    checks: list[Check]

    @property
    def failed(self) -> list[Check]:
        """The checks that found a problem."""
        return [check for check in self.checks if not check.ok]


def examine(
    settings: Settings, database: Database | None = None, cluster: Cluster | None = None
) -> Checks:
    """Look at settings, folder, database and cluster; changes nothing.

    Parameters
    ----------
    database, cluster : of the service that asks. Without a database, that of the settings is looked
        through page by page, and the service that has it now is named.
    """
    checks: dict[str, Callable[[], object]] = {
        "settings": settings.check,
        "data folder": partial(check_folder, settings.folder),
        "file modes": partial(_check_modes, settings.folder),
        "free space": partial(_check_space, settings.folder),
        "database": database.check if database else partial(_check_database, settings),
    }
    if settings.scheduler is not None:
        connect = partial(_check_cluster, settings.scheduler)
        checks["cluster"] = cluster.check if cluster else connect
    if database is None:  # a second service would be refused
        checks["service"] = lambda: holder(settings.store_url, settings.process_name)
    return Checks(checks=[_checked(name, check) for name, check in checks.items()])


def _checked(name: str, check: Callable[[], object]) -> Check:
    try:
        note = check()
    except InputError as error:
        return Check(
            name=name, ok=False, problem=f"{error.field}: {error.problem}", remedy=error.remedy
        )
    except ServiceError as error:
        return Check(name=name, ok=False, problem=error.detail, remedy=error.remedy)
    except Exception as error:  # who asks the doctor gets an answer, whatever it is
        log.debug("%s", name, exc_info=True)
        what = f"{type(error).__name__}: {error}".splitlines()[0]
        return Check(name=name, ok=False, problem=f"{what}.", remedy="Report this as a bug.")
    return Check(name=name, ok=True, note=note if isinstance(note, str) else None)


def check_folder(folder: Path) -> None:
    """Refuse a data folder that cannot be written; one that is not there yet can be made.

    Raises
    ------
    InputError
    """
    place = folder
    while not place.exists():
        place = place.parent
    if not place.is_dir() or not os.access(place, os.W_OK | os.X_OK):
        raise InputError(
            "data_dir",
            f"{folder} cannot be written.",
            "Set KNITCORE_DATA_DIR to a folder that this user may write.",
        )


def _check_modes(folder: Path) -> None:
    """Refuse data that other users of the machine can read."""
    if not folder.is_dir() or not folder.stat().st_mode & 0o077:
        return
    for file in sorted(folder.glob("*.sqlite3*")):
        if file.stat().st_mode & 0o077:
            raise InputError(
                "data_dir",
                f"{file} can be read by other users of this machine.",
                f"Run: chmod 700 {folder}",
            )


def _check_space(folder: Path) -> None:
    """Refuse a disk that is about to be full."""
    if not folder.is_dir():
        return
    free = shutil.disk_usage(folder).free
    if free < MIN_FREE_BYTES:
        raise InputError(
            "data_dir",
            f"The disk of the designs has {free / 1e6:.0f} MB left.",
            "Free some space; nothing that was saved is lost.",
        )


def _check_database(settings: Settings) -> None:
    if not backend_of(settings.store_url).check_unopened():
        return  # it is made by the first start
    with closing(Database(settings.store_url)) as database:
        database.check_pages()
        check_schema(database)


def _check_cluster(address: str) -> None:
    """Refuse a cluster that does not answer or has no workers."""
    from .compute.cluster import Cluster  # its library is needed here only

    with closing(Cluster(address)) as cluster:
        cluster.check()
