"""Answers of operations: from memory, or computed by a worker."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from ...context import Context
from ...operations.perform import Reply, perform
from ...operations.registry import Operation
from ..results.recent import RecentResults
from .compute import Compute


class Answers:
    """Runs operations for requests and jobs.

    Parameters
    ----------
    compute : where the work is done.
    recent : the latest answers, by the request's key.
    data_dir : folder of own materials and kept results.
    """

    def __init__(self, compute: Compute, recent: RecentResults, data_dir: Path) -> None:
        self.compute = compute
        self._recent = recent
        self._data_dir = data_dir

    def context(self) -> Context:
        """The context of operations that need no worker."""
        return Context(self._data_dir)

    def can_be_viewed(self, operation: Operation[Any, Any], request: str) -> bool:
        """Return whether the result's data for the 3D view are in memory; True if it has none.

        Parameters
        ----------
        request : JSON of a valid one.
        """
        if not operation.is_viewed:
            return True
        key = operation.key(operation.request.model_validate_json(request))
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
        args = operation.run, operation.request, request, self._data_dir
        answer: Reply = await self.compute.run(abandoned, job, *args, **turn)
        self._recent.put(answer.key or key, answer, answer.size_bytes)
        return answer
