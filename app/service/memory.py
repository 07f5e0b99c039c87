"""Memory of the machine, and the return of unused memory to the system."""

import ctypes
import gc
import os

M_MMAP_THRESHOLD = -3
"""Parameter of ``mallopt``, from glibc's malloc.h."""
LARGE_BYTES = 1_000_000


def machine_bytes() -> int:
    """Memory of this machine."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def keep_no_large_blocks() -> None:
    """Have the memory of results and uploads returned when they are freed; call before the start.

    glibc would otherwise keep such blocks for reuse once it has seen one freed.
    """
    adjust = getattr(ctypes.CDLL(None), "mallopt", None)
    if adjust is not None:
        adjust(M_MMAP_THRESHOLD, LARGE_BYTES)


def freeze_loaded_objects() -> None:
    """Exclude existing objects, which stay, from garbage collection; call after the start."""
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
