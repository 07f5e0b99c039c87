"""News on their way to the event streams that wait for them."""

import asyncio
import contextlib
import threading
from collections.abc import Iterator
from typing import Generic, TypeVar

News = TypeVar("News")


class Listeners(Generic[News]):
    """Passes news about a name on to those who listen to it.

    News come from any thread; listeners wait on the event loop.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._listeners: dict[str, set[tuple[asyncio.AbstractEventLoop, asyncio.Queue[News]]]] = {}

    @contextlib.contextmanager
    def listen(self, name: str) -> Iterator[asyncio.Queue[News]]:
        """A queue of news, for as long as the block runs."""
        listener = (asyncio.get_running_loop(), asyncio.Queue[News](maxsize=0))
        with self._lock:
            self._listeners.setdefault(name, set()).add(listener)
        try:
            yield listener[1]
        finally:
            with self._lock:
                listeners = self._listeners[name]
                listeners.discard(listener)
                if not listeners:
                    del self._listeners[name]

    def tell(self, name: str, news: News) -> None:
        """Pass news on."""
        with self._lock:
            listeners = list(self._listeners.get(name, ()))
        for loop, queue in listeners:
            loop.call_soon_threadsafe(queue.put_nowait, news)

    def count(self, name: str) -> int:
        """Number of listeners to a name."""
        return len(self._listeners.get(name, ()))

    def __len__(self) -> int:
        return len(self._listeners)
