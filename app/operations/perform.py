"""Running an operation in a worker process, which also packs the answer."""

from __future__ import annotations

import gzip
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from pydantic import BaseModel

from app.operations.context import Context

Result = TypeVar("Result", bound=BaseModel)
LEVEL = 4
"""Level of gzip: twice as fast as the default, for a few per cent more bytes."""


class View(Protocol):
    """Data of a result for the 3D view."""

    @property
    def size_bytes(self) -> int:
        """About how much memory it takes."""
        ...


@dataclass(frozen=True, eq=False)
class Viewed(Generic[Result]):
    """A result that the 3D view shows, too; an operation may return it in place of the result."""

    result: Result
    view: View


@dataclass(frozen=True, eq=False)
class Answer:
    """What came of a request.

    Attributes
    ----------
    body : the result as packed JSON.
    view : data for the 3D view.
    """

    body: bytes
    view: View | None = None

    @property
    def size_bytes(self) -> int:
        """About how much memory it takes."""
        return len(self.body) + (self.view.size_bytes if self.view is not None else 0)


def perform(
    run: Callable[..., Any],
    request: BaseModel,
    data_dir: Path,
    *,
    cancelled: Callable[[], bool],
    progress: Callable[[float, float], None],
) -> Answer:
    """Do an operation; megabytes of numbers are packed here and not on the event loop."""
    found = run(request, Context(data_dir, cancelled=cancelled, progress=progress))
    result, view = (found.result, found.view) if isinstance(found, Viewed) else (found, None)
    return Answer(gzip.compress(result.model_dump_json().encode(), LEVEL), view)
