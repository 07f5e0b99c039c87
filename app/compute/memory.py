"""Memory that nobody uses any more goes back to the system."""

from __future__ import annotations

import ctypes
import gc

M_MMAP_THRESHOLD = -3
"""Of glibc's malloc.h."""
LARGE_BYTES = 1_000_000


def keep_no_large_blocks() -> None:
    """Before the start: results and uploads go back to the system when they are let go of.

    glibc would keep such blocks for later once it has seen one freed, each between smaller ones.
    """
    adjust = getattr(ctypes.CDLL(None), "mallopt", None)
    if adjust is not None:
        adjust(M_MMAP_THRESHOLD, LARGE_BYTES)


def settle() -> None:
    """After the start: what there is now stays, so collecting need not look at it again."""
    gc.collect()
    gc.freeze()


def give_back() -> None:
    """Collect what refers to itself in circles, and return free pages.

    A closed 3D view is such a circle, and its threads leave half-empty arenas behind that the C
    library would keep for later.
    """
    gc.collect()
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc has it
    if trim is not None:
        trim(0)
