"""Run the real service in a process of its own, and the browser that visits it."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Self

import httpx2 as httpx

STARTS_WITHIN_S = 600.0
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


class Service:
    """``knitcore serve`` in a process of its own, on a free port; a context ends with its stop.

    Parameters
    ----------
    folder : for the service's data and its log.
    settings : of the service, as in ``KNITCORE_WORKERS``, without the prefix and in lower case.
    """

    def __init__(self, folder: Path, **settings: str) -> None:
        given = {"data_dir": str(folder / "data")} | settings
        own = {f"KNITCORE_{name.upper()}": value for name, value in given.items()}
        self.environment = os.environ | own
        self.log = folder / "log"
        self.url = ""
        self._process: subprocess.Popen[str] | None = None

    def start(self) -> httpx.Client:
        """Start it and wait until it answers; returns a client of it.

        Raises
        ------
        RuntimeError
            The service does not answer in time; the message holds its log.
        """
        command = [sys.executable, "-m", "app.cli.main", "serve", "--port", "0"]
        with self.log.open("a") as log:
            self._process = subprocess.Popen(
                command, stdout=subprocess.PIPE, stderr=log, text=True, env=self.environment
            )
        assert self._process.stdout is not None
        words = self._process.stdout.readline().split()  # the line that prints its address
        self.url = next((word.rstrip("/") for word in words if word.startswith("http://")), "")
        client = httpx.Client(base_url=self.url, timeout=60.0)
        deadline = time.monotonic() + STARTS_WITHIN_S
        while self.url and time.monotonic() < deadline:
            with contextlib.suppress(httpx.TransportError):
                if client.get("/healthz").is_success:
                    return client
            time.sleep(0.05)
        self.kill()
        raise RuntimeError(f"the service does not answer: {self.log.read_text()}")

    def __enter__(self) -> Self:
        self.start().close()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @contextlib.contextmanager
    def running(self) -> Iterator[httpx.Client]:
        """A client of it; it is killed at the end."""
        client = self.start()
        try:
            yield client
        finally:
            client.close()
            self.kill()

    @property
    def pid(self) -> int:
        """Its process."""
        assert self._process is not None
        return self._process.pid

    def kill(self) -> None:
        """Kill the service, as a power failure would."""
        self._end(signal.SIGKILL)

    def stop(self) -> int:
        """Ask it to stop; returns its exit code."""
        return self._end(signal.SIGTERM)

    def _end(self, how: signal.Signals) -> int:
        process, self._process = self._process, None
        if process is None:
            return 0
        process.send_signal(how)
        code = process.wait(120)
        assert process.stdout is not None
        process.stdout.close()
        return code
