"""Databases for tests: a fresh SQLite file, and a real PostgreSQL where it is installed."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

PROGRAMS = sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)


def postgres_programs() -> Path | None:
    """Folder with initdb and pg_ctl, or None."""
    if PROGRAMS:
        return PROGRAMS[0]
    found = shutil.which("pg_ctl")
    return Path(found).parent if found else None


@contextlib.contextmanager
def postgres(folder: Path) -> Iterator[str]:
    """A PostgreSQL of our own that listens on a socket in ``folder``; yields its URL."""
    programs = postgres_programs()
    assert programs is not None
    as_user: list[str] = []
    if os.geteuid() == 0:  # PostgreSQL refuses to run as root
        shutil.chown(folder, "postgres")
        as_user = ["runuser", "-u", "postgres", "--"]
    data = folder / "data"
    options = f"-c listen_addresses='' -c unix_socket_directories={folder} -c fsync=off"

    def run(*command: str) -> None:
        subprocess.run(
            [*as_user, *command],
            check=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            cwd="/",
        )

    run(str(programs / "initdb"), "-D", str(data), "-A", "trust", "-U", "knit", "-N")
    start = ["-w", "-o", options, "-l", str(folder / "log"), "start"]
    run(str(programs / "pg_ctl"), "-D", str(data), *start)
    try:
        yield f"postgresql+psycopg://knit@/postgres?host={folder}"
    finally:
        run(str(programs / "pg_ctl"), "-D", str(data), "-m", "immediate", "stop")
