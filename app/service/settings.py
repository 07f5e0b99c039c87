"""Settings, from the environment (``KNITCORE_…``) and from a TOML file (``KNITCORE_CONFIG``)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from difflib import get_close_matches
from functools import cached_property
from ipaddress import ip_address
from pathlib import Path
from typing import Literal

from pydantic import Field, IPvAnyNetwork, SecretStr, field_validator
from pydantic_settings import (
    BaseSettings,
    PydanticBaseSettingsSource,
    SecretsSettingsSource,
    SettingsConfigDict,
    TomlConfigSettingsSource,
)

from knitcore.base.errors import InputError

from .memory import machine_bytes

SECRETS = Path("/run/secrets")
"""Folder in which container engines put secrets."""
OTHERS = ("CONFIG", "SECRETS_DIR", "STUDY_DATA", "WORKER_NICENESS")
OF_TESTS = ("KILLS", "OUTAGE_S", "SCHEMA_EXAMPLES", "HOSTILE_FILES", "SOAK_S")
"""Variables of the environment that are no settings."""


class Settings(BaseSettings):
    """Settings of the service."""

    model_config = SettingsConfigDict(env_prefix="KNITCORE_", frozen=True)

    host: str = Field("127.0.0.1", description="Address to listen on.")
    port: int = Field(8737, ge=0, le=65535, description="Port to listen on; 0 takes a free one.")
    token: SecretStr | None = Field(
        None, description="Token that every request must carry; required beyond loopback."
    )
    require_login: bool = Field(
        False, description="Require of every user a token of their own (`knitcore token create`)."
    )
    requests_per_s: float = Field(
        50.0, gt=0, description="Requests per second of one user, where a login is required."
    )
    allowed_hosts: tuple[str, ...] = Field(
        (), description="Host names that a browser may use for this service beyond loopback."
    )
    trusted_proxies: tuple[IPvAnyNetwork, ...] = Field(
        (),
        description="Addresses or networks of proxies whose headers about the client are trusted "
        "(X-Forwarded-For, X-Forwarded-Proto).",
    )
    data_dir: Path = Field(
        default_factory=lambda: (
            Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share") / "knitcore"
        ),
        description="Folder where designs and results are kept.",
    )
    database_url: SecretStr | None = Field(
        None, description="postgresql+psycopg://…; an SQLite file in the data folder otherwise."
    )
    database_password: SecretStr | None = Field(
        None, description="Password of the database, where its URL has none."
    )
    log_format: Literal["text", "json"] = Field(
        "text", description="Log lines for people, or one JSON object per line."
    )
    workers: int = Field(
        max(2, min(4, (os.cpu_count() or 2) - 1)),
        ge=1,
        description="Processes for heavy work; one is kept free of background jobs.",
    )
    scheduler: str | None = Field(
        None,
        pattern=r"^(tcp|tls)://\S+:\d+$",
        description="Dask scheduler that does the heavy work instead, such as tcp://host:8786.",
    )
    job_timeout_s: float = Field(120.0, gt=0, description="Longest run of one computation.")
    background_timeout_s: float = Field(
        1800.0, gt=0, description="Longest run of one job in the background."
    )
    worker_memory_bytes: int = Field(
        default_factory=lambda: max(4_000_000_000, machine_bytes() // 2),
        ge=500_000_000,
        description="Largest memory of a process for heavy work; half of the machine's by default.",
    )
    worker_priority: Literal["idle", "low"] = Field(
        "idle",
        description="Computations use only idle time (idle, Linux only), or about a tenth of a "
        "busy core (low).",
    )
    results_max_bytes: int = Field(
        1_000_000_000, ge=0, description="Largest disk space for stored results of jobs."
    )
    process_name: str = Field(
        "main",
        min_length=1,
        max_length=80,
        description="Name of this process, if several share a database; jobs are stored under it.",
    )
    max_body_bytes: int = Field(32_000_000, gt=0, description="Largest request body.")
    max_viewers: int = Field(64, ge=1, description="3D views kept open at once.")
    viewer_idle_s: float = Field(
        300.0, gt=0, description="Seconds after which an unwatched view closes."
    )

    @field_validator("data_dir", mode="before")
    @classmethod
    def _is_given(cls, folder: object) -> object:
        if folder == "":  # it would be the present folder
            raise ValueError("is empty; name a folder, or leave it out")
        return folder

    @field_validator("data_dir")
    @classmethod
    def _has_home(cls, folder: Path) -> Path:
        try:
            return folder.expanduser()
        except RuntimeError:
            raise ValueError(f"{folder} begins with a user who is not known here") from None

    @field_validator("database_url")
    @classmethod
    def _is_url(cls, url: SecretStr | None) -> SecretStr | None:
        if url is not None:
            from sqlalchemy import make_url  # a command without a database is spared it
            from sqlalchemy.exc import ArgumentError

            try:
                make_url(url.get_secret_value())
            except (ArgumentError, ValueError):
                raise ValueError(
                    "not a URL; write @, :, / and % of a password as %40, %3A, %2F and %25"
                ) from None
        return url

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """Given values come first, then the environment, then secrets, then the file.

        Raises
        ------
        InputError
            If the file that KNITCORE_CONFIG names does not exist, cannot be read or is not TOML; or
            there is no folder that KNITCORE_SECRETS_DIR names.
        """
        first = init_settings, env_settings, *_secrets(settings_cls)
        named = os.environ.get("KNITCORE_CONFIG")
        if named is None:
            return first
        file = Path(named)
        try:
            if file.is_file():
                return *first, TomlConfigSettingsSource(settings_cls, file)
            problem = f"there is no file {file}."
        except OSError as error:
            problem = f"{file} cannot be read ({error.strerror})."
        except ValueError:
            problem = f"{file} is not a TOML file."
        raise InputError("KNITCORE_CONFIG", problem, "Name a file with lines: port = 8737")

    @cached_property
    def is_loopback(self) -> bool:
        """True if the service can only be reached from this machine."""
        if self.host == "localhost":
            return True
        try:
            return ip_address(self.host).is_loopback
        except ValueError:
            return False

    @property
    def asks_for_login(self) -> bool:
        """True if requests need a token or a session."""
        return self.token is not None or self.require_login

    @property
    def folder(self) -> Path:
        """The data folder."""
        return self.data_dir

    @property
    def store_url(self) -> str:
        """The database's URL.

        Raises
        ------
        InputError
            If its database is not supported.
        """
        if self.database_url is None:
            return f"sqlite:///{self.folder / 'knitcore.sqlite3'}"
        url = self.database_url.get_secret_value()
        if not url.startswith(("postgresql+psycopg://", "sqlite:///")):
            raise InputError(
                "database_url",
                "names a database that is not supported.",
                "Use postgresql+psycopg://user:password@host/name, or leave it out.",
            )
        if self.database_password is None:
            return url
        from sqlalchemy import make_url  # a command without a database is spared it

        known = make_url(url).set(password=self.database_password.get_secret_value())
        return known.render_as_string(hide_password=False)

    def make_folder(self) -> None:
        """Make the data folder if the database is a file in it.

        Raises
        ------
        InputError
            If it cannot be made.
        """
        if self.database_url is not None:
            return
        try:
            self.folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError as error:
            raise InputError(
                "data_dir",
                f"{self.folder} cannot be created ({error.strerror}).",
                "Set KNITCORE_DATA_DIR to a folder that can be written.",
            ) from error

    def check(self) -> Settings:
        """The settings themselves, if they are safe to serve with.

        Raises
        ------
        InputError
            If a variable of the environment is not a setting, or the service would listen beyond
            loopback without a token.
        """
        check_names(os.environ)
        if not self.is_loopback and not self.asks_for_login:
            raise InputError(
                "token",
                f"listening on {self.host} would open the service to other machines unprotected.",
                "Set KNITCORE_TOKEN to a long random text, or KNITCORE_REQUIRE_LOGIN=true and make "
                "tokens with `knitcore token create`, or listen on 127.0.0.1.",
            )
        if self.token is not None and len(self.token.get_secret_value().strip()) < 16:
            raise InputError("token", "is too short.", "Use at least 16 characters.")
        return self


def _secrets(settings: type[BaseSettings]) -> tuple[SecretsSettingsSource, ...]:
    """Files that are named after settings, such as ``knitcore_token``: secrets of a container."""
    named = os.environ.get("KNITCORE_SECRETS_DIR")
    folder = Path(named or SECRETS)
    if folder.is_dir():
        return (SecretsSettingsSource(settings, secrets_dir=folder),)
    if named:
        raise InputError(
            "KNITCORE_SECRETS_DIR", f"{folder} is not a folder.", "Name a folder that exists."
        )
    return ()


def check_names(environment: Mapping[str, str]) -> None:
    """Refuse a misspelt variable: without its login, a service would be open. Refuse an empty one:
    an empty folder would be the present one."""
    names = (*Settings.model_fields, *OTHERS, *OF_TESTS)
    known = {f"KNITCORE_{name.upper()}" for name in names}
    for name in sorted(environment):
        if name.upper().startswith("KNITCORE_") and name.upper() not in known:
            near = get_close_matches(name.upper(), known, 1)
            raise InputError(
                name,
                "is not a setting.",
                f"Did you mean {near[0]}?" if near else "Leave it out; docs/serving.md has all.",
            )
        if name.upper() in known and not environment[name].strip():
            raise InputError(name, "is empty.", "Give it a value, or leave it out.")
