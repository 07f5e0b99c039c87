"""Fifty people paint at once: a bounded load on loopback, from a second process.

Each of them has a design of 100 x 100 stitches, and five times a second paints a stroke of ten
stitches: it is durable when it is acknowledged, and the answer holds the map of what changed.
Half of the time a stretch test runs beside them. Then 20 designs' views are opened and dropped.

    make bench-service                     (SECONDS=1200 for ten minutes of each kind)
"""

from __future__ import annotations

import asyncio
import os
import random
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import httpx2 as httpx
import numpy as np
import websockets

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.app.service import Service

USERS = int(os.environ.get("USERS", "50"))
STROKES_PER_S = 5.0
SIDE = 100
SECONDS = float(os.environ.get("SECONDS", "20"))
VIEWS, ROUNDS = 20, int(os.environ.get("ROUNDS", "3"))


@dataclass
class Painter:
    """Somebody who paints, and what they saw."""

    design: str
    rng: random.Random
    chart: list[bytearray] = field(default_factory=lambda: [bytearray(b"K" * SIDE)] * SIDE)
    acknowledged: int = 1
    waits_s: list[float] = field(default_factory=list)
    errors: int = 0

    def __post_init__(self) -> None:
        self.chart = [bytearray(b"K" * SIDE) for _ in range(SIDE)]

    async def paint(self, client: httpx.AsyncClient, until: float) -> None:
        due = time.perf_counter() + self.rng.random() / STROKES_PER_S
        while due < until:
            await asyncio.sleep(max(0.0, due - time.perf_counter()))
            row, column = self.rng.randrange(SIDE), self.rng.randrange(SIDE - 10)
            stitches = "".join(self.rng.choices("KP", k=10))
            run = {"row": row, "column": column, "stitches": stitches}
            body = {"rows": SIDE, "columns": SIDE, "runs": [run]}
            answer = await client.post(f"/api/v1/designs/{self.design}/strokes", json=body)
            # from when the stroke was due: a late load generator must not flatter the service
            self.waits_s.append(time.perf_counter() - due)
            if answer.status_code == 200:
                self.acknowledged = answer.json()["revision"]
                self.chart[SIDE - 1 - row][column : column + 10] = stitches.encode()
            else:
                self.errors += 1
            due += 1 / STROKES_PER_S


def resident_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def cpu_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def handles(pid: int) -> tuple[int, int]:
    return len(list(Path(f"/proc/{pid}/task").iterdir())), len(
        list(Path(f"/proc/{pid}/fd").iterdir())
    )


def told(name: str, waits_s: list[float]) -> float:
    ms = 1000 * np.array(waits_s)
    p50, p95, p99 = np.percentile(ms, [50, 95, 99])
    print(f"{name:28} {len(ms):6} strokes  p50 {p50:6.1f}  p95 {p95:6.1f}  p99 {p99:6.1f} ms")
    return float(p95)


async def paint_all(
    client: httpx.AsyncClient, painters: list[Painter], name: str, pid: int
) -> float:
    for painter in painters:
        painter.waits_s.clear()
    cpu, own, start = cpu_s(pid), time.process_time(), time.perf_counter()
    await asyncio.gather(*(p.paint(client, start + SECONDS / 2) for p in painters))
    spent = time.perf_counter() - start
    p95 = told(name, [w for p in painters for w in p.waits_s])
    print(
        f"{'':28} service {100 * (cpu_s(pid) - cpu) / spent:.0f} % of a core, "
        f"load generator {100 * (time.process_time() - own) / spent:.0f} %, "
        f"machine's load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores"
    )
    return p95


async def painting(client: httpx.AsyncClient, service: Service) -> None:
    body = {"name": "bench", "material": "acrylic", "chart": "\n".join(["K" * SIDE] * SIDE)}
    made = [await client.post("/api/v1/designs", json=body) for _ in range(USERS)]
    painters = [Painter(m.json()["id"], random.Random(n)) for n, m in enumerate(made)]
    await paint_all(client, painters, "warm-up", service.pid)
    warm = resident_mb(service.pid)
    alone = await paint_all(client, painters, f"{USERS} users paint", service.pid)
    wish = {"chart": {"fabric": "garter", "columns": 150, "rows": 150}, "material": "acrylic"}
    wish |= {"direction": "wale", "strain": 0.5, "steps": 60}
    job = (await client.post("/api/v1/jobs", json={"kind": "stretch", "request": wish})).json()
    beside = await paint_all(client, painters, "… beside a stretch test", service.pid)
    state = (await client.get(f"/api/v1/jobs/{job['id']}")).json()["state"]
    await client.delete(f"/api/v1/jobs/{job['id']}")
    lost = 0
    for painter in painters:
        found = (await client.get(f"/api/v1/designs/{painter.design}")).json()
        drawn = "\n".join(line.decode() for line in painter.chart)
        lost += found["document"]["chart"] != drawn or found["revision"] != painter.acknowledged
    grown = 100 * (resident_mb(service.pid) / warm - 1)
    print(f"errors {sum(p.errors for p in painters)}, designs with a lost edit {lost}")
    print(f"stretch test {state}; p95 beside it {100 * (beside / alone - 1):+.0f} %")
    print(f"memory {warm:.0f} MB, {grown:+.1f} % after the warm-up")


async def looking(client: httpx.AsyncClient, service: Service) -> None:
    chart = {"fabric": "rib", "columns": 16, "rows": 16}
    address = service.url.replace("http", "ws")
    for number in range(ROUNDS + 1):
        sockets = []
        for view in range(VIEWS):
            name = f"view-{number}-{view}"
            body = {"chart": chart, "material": "acrylic"}
            (await client.put(f"/api/v1/views/{name}", json=body)).raise_for_status()
            import viser

            sockets.append(
                await websockets.connect(
                    f"{address}/view/{name}", subprotocols=[f"viser-v{viser.__version__}"]
                )
            )
        for socket in sockets:
            await socket.recv()
        open_threads, open_handles = handles(service.pid)
        for socket in sockets:
            await socket.close()
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline:
            await asyncio.sleep(0.2)
            numbers = (await client.get("/metrics")).text
            if "knitcore_views_open 0.0" in numbers:
                break
        await asyncio.sleep(1.0)
        threads, files = handles(service.pid)
        print(
            f"views round {number}: open {open_threads} threads {open_handles} handles, "
            f"dropped {threads} threads {files} handles {resident_mb(service.pid):.0f} MB"
        )


async def main() -> None:
    with tempfile.TemporaryDirectory(prefix="knit-bench-") as folder:
        service = Service(Path(folder), workers="2", viewer_idle_s="1")
        service.start().close()
        limits = httpx.Limits(max_connections=USERS + 10, max_keepalive_connections=USERS + 10)
        try:
            async with httpx.AsyncClient(
                base_url=service.url, timeout=60.0, limits=limits
            ) as client:
                await asyncio.sleep(5.0)  # workers load
                await painting(client, service)
                await looking(client, service)
        finally:
            service.kill()


if __name__ == "__main__":
    asyncio.run(main())
