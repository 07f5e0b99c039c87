"""A Dask cluster as the compose file has it, on loopback."""

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from tests.app.running import wait_until

ROOT = Path(__file__).resolve().parents[2]
SERVICES: dict[str, Any] = yaml.safe_load((ROOT / "compose.yaml").read_text())["services"]


@contextlib.contextmanager
def dask(name: str, folder: Path, *options: str, **changed: str) -> Iterator[None]:
    """Run a service of the compose file, with some of its words changed and options added."""
    program, *words = SERVICES[name]["command"]
    assert program == "dask"
    command = [changed.get(word, word) for word in words]
    with (folder / f"{name}.log").open("w") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "dask", *command, *options],
            env=os.environ | SERVICES[name]["environment"] | {"PYTHONPATH": str(ROOT)},
            stdout=log,
            stderr=log,
        )
    try:
        yield
    finally:
        process.terminate()
        process.wait(60)


@contextlib.contextmanager
def scheduler(folder: Path) -> Iterator[str]:
    """A scheduler without workers; yields its address."""
    file = folder / "scheduler.json"
    options = "--host=127.0.0.1", "--port=0", f"--scheduler-file={file}"
    with dask("scheduler", folder, *options):
        wait_until(lambda: file.exists() and file.read_text())
        yield json.loads(file.read_text())["address"]
