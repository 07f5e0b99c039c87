"""Kill -9 while designs are edited: what was acknowledged is there afterwards.

KNITCORE_KILLS=50 makes it fifty kills instead of a few (``make test-kill``).
"""

from __future__ import annotations

import os
import random
import sqlite3
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path

import httpx2 as httpx
import pytest

from tests.app.service import Service

KILLS = int(os.environ.get("KNITCORE_KILLS", "2"))
SIDE = 40
PAINTERS = 4


@dataclass
class Painter:
    """Somebody who paints one stitch after the other and notes what was acknowledged."""

    design: str
    rng: random.Random
    states: dict[int, list[str]] = field(default_factory=lambda: {1: ["K" * SIDE] * SIDE})
    acknowledged: int = 1

    def paint_until(self, url: str, stop: threading.Event) -> None:
        with httpx.Client(base_url=url, timeout=60.0) as client:
            while not stop.is_set():
                row, column = self.rng.randrange(SIDE), self.rng.randrange(SIDE)
                kind = self.rng.choice("KP")
                chart = list(self.states[self.acknowledged])
                line = chart[SIDE - 1 - row]
                chart[SIDE - 1 - row] = line[:column] + kind + line[column + 1 :]
                self.states[self.acknowledged + 1] = chart
                run = {"row": row, "column": column, "stitches": kind}
                try:
                    answer = client.post(
                        f"/api/v1/designs/{self.design}/strokes",
                        json={"rows": SIDE, "columns": SIDE, "runs": [run]},
                    )
                except httpx.TransportError:
                    return  # killed: this stroke may be kept or not
                assert answer.status_code == 200, answer.text
                self.acknowledged += 1
                assert answer.json()["revision"] == self.acknowledged

    def check(self, client: httpx.Client) -> None:
        found = client.get(f"/api/v1/designs/{self.design}").json()
        assert found["revision"] in (self.acknowledged, self.acknowledged + 1)
        assert found["document"]["chart"].split("\n") == self.states[found["revision"]]
        self.acknowledged = found["revision"]


@pytest.mark.slow
@pytest.mark.timeout(600 + 60 * KILLS)
def test_no_acknowledged_edit_is_lost(tmp_path: Path) -> None:
    service = Service(tmp_path)
    rng = random.Random(2024)  # noqa: S311
    client = service.start()
    body = {"name": "x", "material": "acrylic", "chart": "\n".join(["K" * SIDE] * SIDE)}
    painters = [
        Painter(client.post("/api/v1/designs", json=body).json()["id"], random.Random(n))  # noqa: S311
        for n in range(PAINTERS)
    ]
    strokes = 0
    try:
        for _ in range(KILLS):
            before = sum(p.acknowledged for p in painters)
            stop = threading.Event()
            threads = [
                threading.Thread(target=p.paint_until, args=(service.url, stop)) for p in painters
            ]
            for thread in threads:
                thread.start()
            deadline = time.monotonic() + 60
            while sum(p.acknowledged for p in painters) < before + PAINTERS:
                assert time.monotonic() < deadline
                time.sleep(0.01)
            time.sleep(rng.uniform(0.0, 0.5))
            service.kill()
            stop.set()
            for thread in threads:
                thread.join()
            client.close()
            with sqlite3.connect(tmp_path / "data" / "knitcore.sqlite3") as connection:
                assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
            connection.close()
            client = service.start()
            for painter in painters:
                painter.check(client)
            strokes += sum(p.acknowledged for p in painters) - before
    finally:
        client.close()
        service.kill()
    assert strokes >= PAINTERS * KILLS
    print(f"{KILLS} kills, {strokes} strokes kept, none lost")  # noqa: T201 - for make test-kill
