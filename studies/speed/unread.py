"""Clients that do not read: memory of the service, and how long another user waits meanwhile.

Two hundred and forty connections of Mallory ask for one stored result of 11.6 MB and read nothing
of it; those beyond her limit are refused. Alice lists designs all the while. Every figure is
printed with its target; the exit code is 1 if one is missed.

    python -m studies.speed.unread
"""

import gzip
import os
import random
import socket
import sys
import tempfile
import time
from contextlib import ExitStack, closing
from pathlib import Path

import numpy as np

from app.service.jobs.document import JobState
from app.service.jobs.store import JobStore
from app.service.store.database import Database
from app.service.store.schema import migrate
from app.service.web.sessions import Tokens
from scripts.serving import Service
from studies.speed.service import Figures, resident_mb

CONNECTIONS = 240
RESULT_BYTES = 11_600_000
SECONDS = 20.0
MORE_MB, WAIT_MS = 100.0, 250.0


def stored_result(folder: Path) -> tuple[str, dict[str, str]]:
    """Put a done job of Mallory's into a new database; returns its id, and tokens by user."""
    (folder / "data").mkdir()
    digits = "".join(random.Random(1).choices("0123456789", k=RESULT_BYTES - 2))
    with closing(Database(f"sqlite:///{folder / 'data' / 'knitcore.sqlite3'}")) as database:
        migrate(database)
        store = JobStore(database, "main")
        job = store.add("mallory", "relax", "{}", "key", JobState.WAITING).id
        store.finish(job, "relax", "key", gzip.compress(f'"{digits}"'.encode(), 1))
        tokens = {name: Tokens(database).create(name).token for name in ("alice", "mallory")}
    return job, tokens


def main() -> int:
    figures = Figures()
    with tempfile.TemporaryDirectory() as name, ExitStack() as stack:
        job, tokens = stored_result(Path(name))
        service = Service(Path(name), require_login="true")
        client = stack.enter_context(service.running())
        client.headers["Authorization"] = f"Bearer {tokens['alice']}"
        address = client.base_url.host, client.base_url.port or 80
        client.get("/api/v1/designs?limit=1").raise_for_status()
        before_mb = most_mb = resident_mb(service.pid)
        head = (
            f"GET /api/v1/jobs/{job}/result HTTP/1.1\r\nHost: 127.0.0.1\r\n"
            f"Authorization: Bearer {tokens['mallory']}\r\n\r\n"
        ).encode()
        for _ in range(CONNECTIONS):
            unread = stack.enter_context(socket.create_connection(address))
            unread.sendall(head)
        waits_ms, until = [], time.monotonic() + SECONDS
        while time.monotonic() < until:
            began = time.perf_counter()
            client.get("/api/v1/designs?limit=1").raise_for_status()
            waits_ms.append(1000 * (time.perf_counter() - began))
            most_mb = max(most_mb, resident_mb(service.pid))
            time.sleep(0.05)
        print(f"load of the machine {os.getloadavg()[0]:.1f}, at rest {before_mb:.0f} MB")
        figures.report("more memory, 240 unread results", most_mb - before_mb, "MB", MORE_MB)
        figures.report("another user's list, median", float(np.median(waits_ms)), "ms", WAIT_MS)
        figures.report("another user's list, worst", max(waits_ms), "ms", WAIT_MS)
    return bool(figures.missed)


if __name__ == "__main__":
    sys.exit(main())
