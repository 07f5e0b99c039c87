"""Fifty users paint at once, then open views: a bounded load on loopback, from a second process.

Each user has a design of 100 x 100 stitches and paints a stroke of ten stitches five times a
second: it is durable when it is acknowledged, and the answer holds the map of the changed stitches.
Stretch tests, predictions and shapes are computed at the same time in every other slice, so that
other load on the machine affects slices with and without them alike. Then as many 3D views as one
user may have are opened and dropped ten times. Every figure is printed with its target; the exit
code is 1 if one is missed. Each slice is printed with the time the disk alone takes to keep 4 kB:
the pauses of a shared disk are in every stroke's time.

    python -m studies.speed.service

``SECONDS=600`` in the environment paints for ten minutes, ``FOLDER=/dev/shm`` leaves the disk out,
and ``P95_MS=25`` sets the target of a quiet machine.
"""

import asyncio
import contextlib
import os
import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

import httpx2 as httpx
import numpy as np
import viser
import websockets

from app.service.limits.user_limits import USER_LIMITS
from scripts.serving import Service

USERS = int(os.environ.get("USERS", "50"))
STROKES_PER_S = 5.0
SIDE = 100
SECONDS = float(os.environ.get("SECONDS", "20"))
FOLDER = os.environ.get("FOLDER")
P95_MS = float(os.environ.get("P95_MS", "250"))
SLICE_S = 15.0
PROBE_S = 0.1
WARM_UP_S, WARM_UP_TESTS, WARM_UP_SLICES = 10.0, 7, 12
"""Stretch tests that fill the memory of recent results (`app/service/compute/answers.py`)."""
VIEWS, ROUNDS = USER_LIMITS.views, int(os.environ.get("ROUNDS", "10"))
JOBS = "/api/v1/jobs"
PATIENCE_S = 300.0
"""For computations, whose workers stand back behind everything else."""
Ended = list[tuple[str, str]]
"""Kinds of computations and how they ended."""


@dataclass
class Figures:
    """Measured figures with their targets."""

    missed: list[str] = field(default_factory=list)

    def report(self, name: str, value: float, unit: str, most: float) -> None:
        reached = value <= most
        if not reached:
            self.missed.append(name)
        mark = "pass" if reached else "FAIL"
        ratio = f", {value / most:.0%} of it" if most else ""
        print(f"{mark}  {name:58} {value:8.2f} {unit:3} (at most {most:g}{ratio})", flush=True)


@dataclass
class Painter:
    """A user who paints, with the answers received."""

    design: str
    rng: random.Random
    acknowledged: int = 1
    waits_s: list[float] = field(default_factory=list)
    errors: int = 0
    chart: list[bytearray] = field(init=False)

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

    async def lost(self, client: httpx.AsyncClient) -> bool:
        """Tell whether the service has another chart than was painted."""
        stored = (await client.get(f"/api/v1/designs/{self.design}")).json()
        drawn = "\n".join(line.decode() for line in self.chart)
        return bool(stored["document"]["chart"] != drawn or stored["revision"] != self.acknowledged)


def resident_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def cpu_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def held(pid: int) -> tuple[int, int]:
    """Threads and file handles of a process."""
    threads, handles = (len(os.listdir(f"/proc/{pid}/{what}")) for what in ("task", "fd"))
    return threads, handles


async def disk_pauses(until: float) -> list[float]:
    """Times the disk takes to keep 4 kB, ms, measured a few times a second."""

    def keep(file: IO[bytes]) -> float:
        file.seek(0)
        file.write(bytes(4096))
        start = time.perf_counter()
        os.fdatasync(file.fileno())
        return 1000 * (time.perf_counter() - start)

    waits = []
    with tempfile.TemporaryFile(dir=FOLDER, buffering=0) as file:
        while time.perf_counter() < until:
            waits.append(await asyncio.to_thread(keep, file))
            await asyncio.sleep(PROBE_S)
    return waits


async def paint_all(
    client: httpx.AsyncClient, painters: list[Painter], name: str, seconds: float, pid: int
) -> list[float]:
    """All users paint for a while; returns how long each stroke took, ms."""
    for painter in painters:
        painter.waits_s.clear()
    cpu, own, start = cpu_s(pid), time.process_time(), time.perf_counter()
    async with asyncio.TaskGroup() as tasks:
        pauses = tasks.create_task(disk_pauses(start + seconds))
        for painter in painters:
            tasks.create_task(painter.paint(client, start + seconds))
    disk = pauses.result()
    spent = time.perf_counter() - start
    ms = [1000 * wait for painter in painters for wait in painter.waits_s]
    used = cpu_s(pid) - cpu
    print(
        f"      {percentiles(name, ms)}; service {1000 * used / len(ms):.2f} ms of CPU a stroke, "
        f"{100 * used / spent:.0f} % of a core, {resident_mb(pid):.0f} MB; "
        f"load generator {100 * (time.process_time() - own) / spent:.0f} %; "
        f"load of the machine {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores; "
        f"the disk alone p95 {np.percentile(disk, 95):.1f} most {max(disk):.0f} ms",
        flush=True,
    )
    return ms


def percentiles(name: str, ms: list[float]) -> str:
    p50, p95, p99 = np.percentile(ms, [50, 95, 99])
    return f"{name}: {len(ms)} strokes, p50 {p50:.1f} p95 {p95:.1f} p99 {p99:.1f} ms"


async def stretch_tests(client: httpx.AsyncClient, ended: Ended) -> None:
    for number in range(1000):  # each a little further, so that no answer is known
        wish = {"chart": {"fabric": "garter", "columns": SIDE, "rows": SIDE}, "steps": 20}
        wish |= {"material": "acrylic", "direction": "wale", "strain": 0.5 + number / 1e4}
        job = await client.post(JOBS, json={"kind": "stretch", "request": wish})
        address = job.headers["location"]
        try:
            while (state := (await client.get(address)).json()["state"]) in ("waiting", "running"):
                await asyncio.sleep(0.5)
            ended.append(("stretch test", state))
        finally:
            await client.delete(address)


async def predictions(client: httpx.AsyncClient, ended: Ended) -> None:
    rng = random.Random(7)
    while True:  # of charts that a page asks about, and now and then of a large one
        side = 400 if rng.random() < 0.1 else SIDE
        chart = "\n".join("".join(rng.choices("KP", k=side)) for _ in range(side))
        wish = {"chart": chart, "material": "acrylic"}
        ended.append(("prediction", await _outcome(client, "predict", wish)))
        await asyncio.sleep(0.2)


async def shapes(client: httpx.AsyncClient, ended: Ended) -> None:
    for number in range(1000):
        wish = {"material": "acrylic", "strain": 0.2 + number / 1e5, "across": 12}
        wish |= {"width": [0.9] * 16}
        ended.append(("shape", await _outcome(client, "shape", wish)))
        await asyncio.sleep(1.0)


async def _outcome(client: httpx.AsyncClient, name: str, wish: object) -> str:
    """Done, also if the service was too busy and said so."""
    answer = await client.post(f"/api/v1/{name}", json=wish, timeout=PATIENCE_S)
    return "done" if answer.status_code in (200, 503) else f"{answer.status_code}"


@contextlib.asynccontextmanager
async def computing(client: httpx.AsyncClient) -> AsyncIterator[Ended]:
    """Stretch tests, predictions and shapes are asked for all the time; yields how they ended."""
    ended: Ended = []
    kinds = stretch_tests, predictions, shapes
    tasks = [asyncio.create_task(kind(client, ended)) for kind in kinds]
    try:
        yield ended
    finally:
        for task in tasks:
            task.cancel()
        for outcome in await asyncio.gather(*tasks, return_exceptions=True):
            if not isinstance(outcome, asyncio.CancelledError):
                raise RuntimeError("a kind of computation ended early") from outcome


async def painting(client: httpx.AsyncClient, pid: int, figures: Figures) -> None:
    body = {"name": "bench", "material": "acrylic", "chart": "\n".join(["K" * SIDE] * SIDE)}
    made = [await client.post("/api/v1/designs", json=body) for _ in range(USERS)]
    painters = [Painter(m.json()["id"], random.Random(n)) for n, m in enumerate(made)]
    alone, beside = f"{USERS} users", "beside computations"
    ended: Ended = []
    async with computing(client) as known:
        for _ in range(WARM_UP_SLICES):
            await paint_all(client, painters, "warm-up", WARM_UP_S, pid)
            if len([kind for kind, _ in known if kind == "stretch test"]) >= WARM_UP_TESTS:
                break
    warm = resident_mb(pid)
    waits: dict[str, list[float]] = {alone: [], beside: []}
    pairs = max(1, round(SECONDS / (2 * SLICE_S)))
    for _ in range(pairs):
        length = SECONDS / (2 * pairs)
        waits[alone] += await paint_all(client, painters, alone, length, pid)
        async with computing(client) as states:
            waits[beside] += await paint_all(client, painters, beside, length, pid)
        ended += states
    lost = sum([await painter.lost(client) for painter in painters])
    for name, ms in waits.items():
        print("in all", percentiles(name, ms))
    p95 = {name: float(np.percentile(ms, 95)) for name, ms in waits.items()}
    figures.report(f"p95 of {USERS} users' strokes", p95[alone], "ms", P95_MS)
    figures.report("p95 beside computations", p95[beside], "ms", P95_MS)
    figures.report("… compared with p95 alone", 100 * (p95[beside] / p95[alone] - 1), "%", 50)
    figures.report("strokes that were refused", sum(p.errors for p in painters), "", 0)
    figures.report("designs with a lost edit", lost, "", 0)
    failed = len([state for _, state in ended if state != "done"])
    counts = Counter(kind for kind, _ in ended)
    print("      computed: " + ", ".join(f"{n} {kind}s" for kind, n in counts.items()))
    figures.report(f"computations that failed, of {len(ended)}", failed, "", 0)
    grown = 100 * (resident_mb(pid) / warm - 1)
    figures.report(f"memory after {SECONDS:g} s of painting, from {warm:.0f} MB", grown, "%", 5)


async def look(client: httpx.AsyncClient, service: Service, number: int) -> None:
    """Open all views, wait until each is drawn, go away, and wait until they are closed."""
    address = service.url.replace("http", "ws")
    chart = {"fabric": "rib", "columns": 16, "rows": 16}
    sockets = []
    for view in range(VIEWS):
        name = f"view-{number}-{view}"
        body = {"chart": chart, "material": "acrylic"}
        (await client.put(f"/api/v1/views/{name}", json=body)).raise_for_status()
        protocol = [websockets.Subprotocol(f"viser-v{viser.__version__}")]
        sockets.append(await websockets.connect(f"{address}/view/{name}", subprotocols=protocol))
    for socket in sockets:
        await socket.recv()
        await socket.close()
    deadline = time.monotonic() + 60
    while "knitcore_views_open 0.0" not in (await client.get("/metrics")).text:
        if time.monotonic() > deadline:
            raise TimeoutError("views are still open")
        await asyncio.sleep(0.2)
    before = (0, 0)
    while (now := held(service.pid)) != before:
        before = now
        await asyncio.sleep(2.0)


async def looking(client: httpx.AsyncClient, service: Service, figures: Figures) -> None:
    for number in (-1, 0):  # modules loaded for the first views stay loaded
        await look(client, service, number)
    threads, handles = held(service.pid)
    memory = resident_mb(service.pid)
    rounds = []
    for number in range(1, ROUNDS + 1):
        await look(client, service, number)
        now = held(service.pid)
        rounds.append(now)
        print(
            f"      views round {number}: {now[0]} threads, {now[1]} handles, "
            f"{resident_mb(service.pid):.1f} MB",
            flush=True,
        )
    what = f"{VIEWS} views opened and dropped {ROUNDS} times"
    left = np.min(rounds[-3:], axis=0)  # a pool with one more thread at one moment is not a leak
    figures.report(f"threads more after {what}", left[0] - threads, "", 0)
    figures.report(f"handles more after {what}", left[1] - handles, "", 0)
    grown = 100 * (resident_mb(service.pid) / memory - 1)
    figures.report(f"memory after {what}, from {memory:.0f} MB", grown, "%", 2)


async def main() -> int:
    figures = Figures()
    limits = httpx.Limits(max_connections=USERS + 10, max_keepalive_connections=USERS + 10)
    with (
        tempfile.TemporaryDirectory(prefix="knit-bench-", dir=FOLDER) as folder,
        Service(Path(folder), workers="2", viewer_idle_s="1") as service,
    ):
        async with httpx.AsyncClient(base_url=service.url, timeout=60.0, limits=limits) as client:
            await asyncio.sleep(5.0)  # workers load
            await painting(client, service.pid, figures)
            await looking(client, service, figures)
    print("missed: " + ", ".join(figures.missed) if figures.missed else "every target is reached")
    return bool(figures.missed)


if __name__ == "__main__":
    sys.exit(asyncio.run(main()))
