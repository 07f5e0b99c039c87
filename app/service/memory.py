"""How much memory there is, and returning what is not used to the system."""

from __future__ import annotations

import ctypes
import gc
import os

M_MMAP_THRESHOLD = -3
"""Of glibc's malloc.h."""
LARGE_BYTES = 1_000_000


def machine_bytes() -> int:
    """Memory of this machine."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def keep_no_large_blocks() -> None:
    """Before the start: have the memory of results and uploads returned when they are freed.

    glibc would otherwise keep such blocks for reuse once it has seen one freed.
    """
    adjust = getattr(ctypes.CDLL(None), "mallopt", None)
    if adjust is not None:
        adjust(M_MMAP_THRESHOLD, LARGE_BYTES)


def freeze_loaded_objects() -> None:
    """After the start: exclude existing objects from garbage collection, since they stay."""
    gc.collect()
    gc.freeze()


def give_back() -> None:
    """Collect reference cycles, and return free pages.

    A closed 3D view is such a cycle, and its threads leave half-empty arenas that the C library
    would keep.
    """
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc has it
    if trim is not None:
        trim(0)
