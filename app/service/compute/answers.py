"""Answers of operations: from memory, or computed by a worker."""

import asyncio
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from ...context import Context, Supplies
from ...operations.perform import Reply, perform
from ...operations.registry import Operation
from ..results.own_materials import named_in
from ..store.material_store import MaterialStore
from .compute import Compute

MAX_RECENT_BYTES = 32_000_000


class RecentResults:
    """The latest results, which the page may ask for again, by the content of their requests.

    They have a size together; the least recently used are dropped first. Only the event loop uses
    them: a thread would meet its changes halfway.
    """

    def __init__(self, most_bytes: int = MAX_RECENT_BYTES) -> None:
        self._most_bytes = most_bytes
        self._bytes = 0
        self._items: OrderedDict[str, tuple[Any, int]] = OrderedDict()

    def get(self, key: str) -> Any | None:
        """The result with this key, or None if it was never made or is gone."""
        entry = self._items.get(key)
        if entry is None:
            return None
        self._items.move_to_end(key)
        return entry[0]

    def put(self, key: str, result: Any, size_bytes: int) -> None:
        """Keep a result of about this size."""
        self.drop(key)
        self._items[key] = (result, size_bytes)
        self._bytes += size_bytes
        while self._bytes > self._most_bytes and len(self._items) > 1:
            self.drop(next(iter(self._items)))

    def drop(self, key: str) -> None:
        """Forget a result, if it is there."""
        _, size = self._items.pop(key, (None, 0))
        self._bytes -= size


class Answers:
    """Runs operations for requests and jobs.

    Parameters
    ----------
    compute : where the work is done.
    recent : the latest answers, by the request's key.
    data_dir : folder of kept results.
    materials : those of users.
    """

    def __init__(
        self, compute: Compute, recent: RecentResults, data_dir: Path, materials: MaterialStore
    ) -> None:
        self.compute = compute
        self._recent = recent
        self._data_dir = data_dir
        self._materials = materials

    def context(self) -> Context:
        """The context of operations that need no worker."""
        return Context(self._data_dir, own=self._materials)

    async def supplies(self, request: BaseModel | bytes) -> Supplies:
        """Things that a worker gets with a request, or with JSON that it is to decode."""
        sent = request if isinstance(request, bytes) else request.model_dump_json().encode()
        names = named_in(sent)
        documents = await asyncio.to_thread(self._materials.documents, names) if names else {}
        return Supplies(self._data_dir, documents)

    async def can_be_viewed(self, operation: Operation[Any, Any], request: str) -> bool:
        """Return whether the result's data for the 3D view are in memory; True if it has none.

        Parameters
        ----------
        request : JSON of a valid one.
        """
        if not operation.is_viewed:
            return True
        key = await asyncio.to_thread(
            lambda: operation.key(operation.request.model_validate_json(request))
        )
        return self._recent.get(key) is not None

    async def answer(
        self,
        abandoned: Callable[[], Awaitable[bool]],
        operation: Operation[Any, Any],
        request: BaseModel | bytes,
        **turn: Any,
    ) -> Reply:
        """The answer of an operation to a request, or to JSON that a worker is to decode; ``turn``
        goes to :meth:`Compute.run`.

        Raises
        ------
        ServiceError, KnitcoreError, InvalidRequestError
        """
        key = "" if isinstance(request, bytes) else operation.key(request)
        known: Reply | None = self._recent.get(key)
        if known is not None:
            return known
        earlier: Reply | None = self._recent.get(getattr(request, "after", None) or "")
        job = partial(perform, before=earlier and earlier.view)
        args = operation.run, operation.request, request, await self.supplies(request)
        answer: Reply = await self.compute.run(abandoned, job, *args, **turn)
        self._recent.put(answer.key or key, answer, answer.size_bytes)
        return answer
