"""Run the real service in a process of its own, and the browser that visits it."""

import contextlib
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx2 as httpx

STARTS_WITHIN_S = 120.0
CHROMIUM = Path("/usr/bin/chromium")
FLAGS = [
    "--no-sandbox",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-compositing",  # the imitated GPU is slow: for WebGL only
    "--disable-gpu-rasterization",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
]
"""Options of Chromium on a machine without a GPU."""
FORCED = "--use-angle=swiftshader"
"""Option that makes it draw every frame whole, by an imitated GPU."""


@dataclass(frozen=True)
class Served:
    """Address and process of a running service."""

    url: str
    pid: int


@contextlib.contextmanager
def serving(folder: Path, **settings: str) -> Iterator[Served]:
    """Run ``knitcore serve`` on a free port until the block ends.

    Parameters
    ----------
    folder : for the service's data and its log.
    settings : of the service, as in ``KNITCORE_WORKERS``, without the prefix and in lower case.

    Raises
    ------
    RuntimeError
        The service does not answer in time; the message holds its log.
    """
    environment = os.environ | {"KNITCORE_DATA_DIR": str(folder / "data")}
    environment |= {f"KNITCORE_{name.upper()}": value for name, value in settings.items()}
    log = folder / "log"
    command = [sys.executable, "-m", "app.cli.main", "serve", "--port", "0"]
    with (
        log.open("w") as errors,
        subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=errors, text=True, env=environment
        ) as process,
    ):
        try:
            assert process.stdout is not None
            words = process.stdout.readline().split()  # the line that prints its address
            url = next((word.rstrip("/") for word in words if word.startswith("http://")), "")
            if not url:
                raise RuntimeError(f"the service does not start: {log.read_text()}")
            _wait_for(url, log)
            yield Served(url, process.pid)
        finally:
            process.terminate()


def _wait_for(url: str, log: Path) -> None:
    """Return once the service answers."""
    deadline = time.monotonic() + STARTS_WITHIN_S
    while time.monotonic() < deadline:
        with contextlib.suppress(httpx.TransportError):
            httpx.get(f"{url}/healthz")
            return
        time.sleep(0.05)
    raise RuntimeError(f"the service does not answer: {log.read_text()}")
