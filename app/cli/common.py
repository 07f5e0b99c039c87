"""Things that commands share: the settings, the database, and ways of printing."""

from __future__ import annotations

import contextlib
import logging
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click
from pydantic import BaseModel

from knitcore.base.errors import InputError

if TYPE_CHECKING:
    from knitcore.materials import Material

    from ..service.results.own_materials import OwnMaterials
    from ..service.settings import Settings
    from ..service.store.database import Database

json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")


def user_settings() -> Settings:
    """The settings of the environment and of the user's file.

    Raises
    ------
    InputError
        If they cannot be read.
    """
    from pydantic_settings import SettingsError

    from ..service.settings import Settings, check_names

    check_names(os.environ)
    try:
        return Settings()
    except SettingsError as error:
        remedy = 'Write a list as JSON, such as ["knit.example"].'
        if isinstance(error.__cause__, UnicodeDecodeError):
            remedy = "Write its file as text in UTF-8."
        raise InputError("settings", f"{error}.", remedy) from error


@contextlib.contextmanager
def open_database(settings: Settings, *, migrated: bool = True) -> Iterator[Database]:
    """The database of the settings, brought up to date."""
    from ..service.store.database import Database
    from ..service.store.schema import migrate

    settings.make_folder()
    with contextlib.closing(Database(settings.store_url)) as database:
        if migrated:
            migrate(database)
        yield database


class UserMaterials:
    """Materials of users in the database of the settings, which is opened when one is needed."""

    def find(self, identifier: str) -> Material:
        """A user's own material."""
        with self._opened() as own:
            return own.find(identifier)

    def listed(self, user: str) -> list[tuple[Material, bool]]:
        """All materials, each with whether it is this user's."""
        with self._opened() as own:
            return own.listed(user)

    @contextlib.contextmanager
    def _opened(self) -> Iterator[OwnMaterials]:
        from ..service.results.own_materials import GivenMaterials
        from ..service.store.database import backend_of
        from ..service.store.material_store import MaterialStore

        settings = user_settings()
        if backend_of(settings.store_url).check_unopened():
            with open_database(settings) as database:
                yield MaterialStore(database)
        else:  # no service has run here yet
            yield GivenMaterials()


def user_data_dir() -> Path:
    """The data folder of the settings."""
    return user_settings().folder


def emit(result: BaseModel, text: str, *, as_json: bool) -> None:
    """Print a result as one JSON object, or as text for people."""
    click.echo(result.model_dump_json() if as_json else text)


class _Compiling(logging.Handler):
    """Says on stderr that kernels are compiled, and has other processes compile some of them."""

    def __init__(self) -> None:
        super().__init__()
        self.others: list[subprocess.Popen[bytes]] = []

    def emit(self, record: logging.LogRecord) -> None:
        click.echo(record.getMessage(), err=True)
        share = [sys.executable, "-m", "knitcore.compile_share", record.__dict__["compiling"]]
        if (os.cpu_count() or 1) > 1:
            self.others = [
                subprocess.Popen(  # noqa: S603 - a module of our own
                    [*share, number], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
                for number in ("0", "1")
            ]


@contextlib.contextmanager
def telling_what_is_compiled() -> Iterator[None]:
    """Report on stderr that kernels are compiled, and compile some of them in other processes."""
    log, handler = logging.getLogger("knitcore.base.compiled"), _Compiling()
    log.setLevel(logging.DEBUG)
    log.addHandler(handler)
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.setLevel(logging.NOTSET)
        for other in handler.others:
            other.kill()
            other.wait()
