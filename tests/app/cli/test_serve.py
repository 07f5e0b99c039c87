"""The service as a process: it starts, tells its address, answers and stops."""

import contextlib
import http.client
import json
import signal
import socket
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator
from pathlib import Path

import httpx2
import pytest

from tests.app.running import knitcore, python, wait_until

FASTER = """
import uvicorn
from app.cli.main import main

class Config(uvicorn.Config):
    def __init__(self, *given, timeout_keep_alive=5, **more):
        super().__init__(*given, timeout_keep_alive=timeout_keep_alive / 10, **more)

uvicorn.Config = Config
main(["serve", "--port", "0", "--json"])
"""
"""The service, whose patience with a silent connection ends ten times as soon."""


def test_it_starts_on_a_free_port_and_stops_on_request() -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", _as_main(FASTER)], stdout=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        url = json.loads(process.stdout.readline())["url"]
        assert url.startswith("http://127.0.0.1:")
        assert httpx2.get(f"{url}healthz", timeout=120).json()["status"] == "ok"
        kept = http.client.HTTPConnection(url.removeprefix("http://").rstrip("/"), timeout=120)
        kept.connect()
        kept.auto_open = False
        for pause_s in (0.0, 0.6):  # clients keep a connection for 5 s without a word
            time.sleep(pause_s)
            kept.request("GET", "/healthz")
            assert json.loads(kept.getresponse().read())["status"] == "ok"
        kept.close()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=120) == 0
    finally:
        process.kill()
        process.communicate()


@pytest.mark.slow
def test_killed_it_leaves_no_worker_behind() -> None:
    code = (
        "import os, asyncio; from tests.app import jobs\n"
        "from app.service.compute.compute import Compute\n"
        "from app.service.compute.processes import processes\n"
        "async def never(): return False\n"
        "pool = Compute(processes(1), timeout_s=60)\n"
        "print(asyncio.run(pool.run(never, jobs.process_id)), flush=True)\n"
        "os.kill(os.getpid(), 9)\n"
    )
    worker = Path(f"/proc/{int(python('-c', _as_main(code), check=False).stdout)}")
    wait_until(lambda: not worker.exists())


@pytest.mark.slow
def test_killed_while_modules_are_loaded_it_leaves_no_process_behind() -> None:
    code = (
        "import os; from multiprocessing import forkserver\n"
        "from app.service.compute.processes import load, processes\n"
        "processes(1); load(); forkserver.ensure_running(); os.kill(os.getpid(), 9)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", _as_main(code)], start_new_session=True)
    assert process.wait(60) == -signal.SIGKILL
    wait_until(lambda: process.pid not in _sessions())


def _as_main(code: str) -> str:
    return f"if __name__ == '__main__':\n{textwrap.indent(code, '    ')}"


def _sessions() -> Iterator[int]:
    """The leaders of the sessions of all processes."""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            yield int(stat.read_text().rpartition(")")[2].split()[3])


def test_a_port_in_use_is_reported() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        result = knitcore("serve", "--port", port)
    assert result.returncode == 2, result.stderr
    for words in ("cannot be used", "open that address in a browser", "--port 0"):
        assert words in result.stderr
