"""The real service in a process of its own, for tests that stop or kill it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import httpx2 as httpx


class Service:
    """``knitcore serve`` on a free port with its data in ``folder``."""

    def __init__(self, folder: Path, **settings: str) -> None:
        self.folder = folder
        self.environment = os.environ | {
            "KNITCORE_DATA_DIR": str(folder / "data"),
            "KNITCORE_WORKERS": "1",
            **{f"KNITCORE_{name.upper()}": value for name, value in settings.items()},
        }
        self.log = folder / "log"
        self.url = ""
        self._process: subprocess.Popen[str] | None = None

    def start(self) -> httpx.Client:
        """Start it and wait until it answers; returns a client of it."""
        with self.log.open("a") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "app.cli.main", "serve", "--port", "0"],
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                env=self.environment,
            )
        assert self._process.stdout is not None
        line = self._process.stdout.readline()
        assert "http://" in line, self.log.read_text()
        self.url = line.split()[3].rstrip("/")
        client = httpx.Client(base_url=self.url, timeout=60.0)
        deadline = time.monotonic() + 120
        while time.monotonic() < deadline:
            try:
                client.get("/healthz")
            except httpx.TransportError:
                time.sleep(0.05)
            else:
                return client
        raise AssertionError("the service does not answer: " + self.log.read_text())

    @property
    def pid(self) -> int:
        assert self._process is not None
        return self._process.pid

    def kill(self) -> None:
        """As if the power had failed."""
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
