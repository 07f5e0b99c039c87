"""The real service in a process of its own, for tests that stop or kill it."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx2 as httpx
import uvicorn
from fastapi import FastAPI


def wait_until(true: Callable[[], object], patience_s: float = 150.0) -> None:
    """Wait for something, on a machine that may be busy."""
    deadline = time.monotonic() + patience_s
    while not true():
        assert time.monotonic() < deadline
        time.sleep(0.02)


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

        def answers() -> bool:
            with contextlib.suppress(httpx.TransportError):
                return client.get("/healthz").is_success
            return False

        wait_until(answers)
        return client

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


@contextlib.contextmanager
def serving(app: FastAPI) -> Iterator[str]:
    """An application on a real server in a thread; yields its address."""
    server = uvicorn.Server(uvicorn.Config(app, port=0, log_config=None, lifespan="on"))
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            while not server.started:
                assert thread.is_alive()
                time.sleep(0.01)
            yield f"http://127.0.0.1:{listener.getsockname()[1]}"
        finally:
            server.should_exit = True
            thread.join()
