"""Memory goes back to the system."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
import os
from pathlib import Path
from app.service import memory

def resident_mb():
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

memory.keep_no_large_blocks()
del [bytearray(20_000_000)][0]  # from now on glibc would take such blocks from its heap
before = resident_mb()
large, small = [], []
for _ in range(20):  # each large one between two that stay
    large.append(bytearray(b"k") * 3_000_000)
    small.append(bytearray(b"p") * 50_000)
del large
print(resident_mb() - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="of the C library there")
def test_large_blocks_between_small_ones_are_returned() -> None:
    found = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, check=True)
    assert float(found.stdout) < 5
