"""Cost of a start: CPU until the page answers, memory at rest, and CPU of commands.

Files are warm and the database is up to date. CPU is that of a process and those it started, and
the median of several starts. Every figure is printed with its target and their ratio; the exit code
is 1 if one is missed.

    python -m studies.speed.start                    (STARTS=5)
"""

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from scripts.serving import Service
from studies.speed.service import Figures, cpu_s, resident_mb

STARTS = int(os.environ.get("STARTS", "5"))
REST_S = 1.5
COMMANDS = {
    "predict garter --size 5x5 --material acrylic": 0.25,
    "token list": 0.5,
    "doctor": 0.5,
    "materials": 0.5,
    "--help": 0.25,
}
"""Targets in seconds of CPU."""


def tree(pid: int) -> list[int]:
    """A process and all that it started."""
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    children = [int(child) for task in tasks for child in task.read_text().split()]
    return [pid, *(each for child in children for each in tree(child))]


def spent_s(pid: int) -> float:
    return sum(cpu_s(each) for each in tree(pid))


def rest(pid: int) -> None:
    """Wait until a service has loaded what it loads after its start."""
    before = -1.0
    while (now := spent_s(pid)) - before > 0.02 * REST_S:
        before = now
        time.sleep(REST_S)


def serving(folder: Path, figures: Figures) -> None:
    service = Service(folder)
    cpu = []
    for _ in range(STARTS + 1):  # the first one makes the database
        client = service.start()
        assert client.get("/").is_success
        cpu.append(spent_s(service.pid))
        rest(service.pid)
        resident = resident_mb(service.pid)
        body = {"chart": "KP/PK", "material": "acrylic", "direction": "wale", "strain": 0.1}
        assert client.post("/api/v1/stretch", json=body).is_success
        *_, worker = map(resident_mb, tree(service.pid))
        client.close()
        service.stop()
    figures.report("serve, CPU until the page answers", statistics.median(cpu[1:]), "s", 1.5)
    figures.report("… memory at rest", resident, "MB", 200)
    figures.report("… memory of a worker", worker, "MB", 150)


def commands(folder: Path, figures: Figures) -> None:
    environment = os.environ | {"KNITCORE_DATA_DIR": str(folder / "data")}
    for words, target in COMMANDS.items():
        program = [sys.executable, "-m", "app.cli.main", *words.split()]
        cpu = []
        for _ in range(STARTS + 1):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run(program, env=environment, capture_output=True, check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        figures.report(f"{words}, CPU", statistics.median(cpu[1:]), "s", target)


def main() -> int:
    figures = Figures()
    with tempfile.TemporaryDirectory(prefix="knit-bench-") as name:
        serving(Path(name), figures)
        commands(Path(name), figures)
    print("missed: " + ", ".join(figures.missed) if figures.missed else "every target is reached")
    return bool(figures.missed)


if __name__ == "__main__":
    sys.exit(main())
