"""A Dask scheduler as the compose file has it, on loopback."""

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path

from scripts.composition import dask
from tests.app.running import wait_until


@contextlib.contextmanager
def scheduler(folder: Path) -> Iterator[str]:
    """A scheduler without workers; yields its address."""
    file = folder / "scheduler.json"
    options = "--host=127.0.0.1", "--port=0", f"--scheduler-file={file}"
    with dask("scheduler", folder, {}, *options):
        wait_until(lambda: file.exists() and file.read_text())
        yield json.loads(file.read_text())["address"]
