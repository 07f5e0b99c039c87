"""Every process collects the same tests, whatever the time and the order of sets."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COLLECT = [sys.executable, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider"]


def collected(hash_seed: str) -> list[str]:
    """Names of all tests, as another process sees them."""
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
    listed = subprocess.run(
        COLLECT, cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    return [line for line in listed.stdout.splitlines() if "::" in line]


def test_two_processes_collect_the_same_tests() -> None:
    first = collected("1")
    assert len(first) > 1000
    assert collected("2") == first
