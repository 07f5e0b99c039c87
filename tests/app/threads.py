"""Threads of this process."""

import threading

POOLS = ("asyncio_", "AnyIO worker", "service_", "drawing_", "pictures_", "QueueFeeder")


def threads_of_no_pool() -> list[str]:
    """Their names. Pools grow as they are used, and the busier the machine the more."""
    return [t.name for t in threading.enumerate() if not t.name.startswith(POOLS)]
