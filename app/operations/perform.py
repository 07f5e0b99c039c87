"""Running an operation in a worker process, which also packs the answer."""

import gzip
import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from pydantic import BaseModel

from knitcore.base.errors import InputError

from ..context import Context, Supplies
from ..requests.base import read
from ..requests.faults import all_faults

Result = TypeVar("Result", bound=BaseModel)
LEVEL = 4
"""Level of gzip: twice as fast as the default, for a few per cent more bytes."""


class ViewData(Protocol):
    """Data of a result for the 3D view."""

    @property
    def size_bytes(self) -> int:
        """About how much memory it takes."""
        ...


@dataclass(frozen=True, eq=False)
class Viewed(Generic[Result]):
    """A result, and what a 3D view shows of it; operations may return it in place of the result."""

    result: Result
    view: ViewData | None


@dataclass(frozen=True, eq=False)
class Reply:
    """Answer to a request.

    Attributes
    ----------
    body : the result as packed JSON.
    view : data for the 3D view.
    key : the operation's key of the request, where the worker decoded it.
    """

    body: bytes
    view: ViewData | None = None
    key: str = ""

    @property
    def size_bytes(self) -> int:
        """About how much memory it takes."""
        return len(self.body) + (self.view.size_bytes if self.view is not None else 0)


def key_of(run: Callable[..., Any], request: BaseModel) -> str:
    """A key made of everything that a caller can choose."""
    content = f"{run.__name__.rstrip('_')}\0{request.model_dump_json()}"
    return hashlib.sha256(content.encode()).hexdigest()[:32]


def carried_out(run: Callable[..., Any], request: BaseModel, context: Context) -> Viewed[Any]:
    """The result of an operation, with its data for the 3D view if it has any.

    Raises
    ------
    InputError
        With everything that is wrong with the request, if something is.
    """
    try:
        outcome = run(request, context)
    except InputError as error:
        raise all_faults(error, request, context) from None
    return outcome if isinstance(outcome, Viewed) else Viewed(outcome, None)


def perform(
    run: Callable[..., Any],
    model: type[BaseModel],
    request: BaseModel | bytes,
    supplies: Supplies,
    *,
    cancelled: Callable[[], bool],
    progress: Callable[[float, float], None],
    before: ViewData | None = None,
) -> Reply:
    """Do an operation; megabytes are decoded and packed here and not on the event loop.

    Raises
    ------
    InvalidRequestError
        If the request came as bytes and is none of the model.
    """
    decoded: BaseModel = read(model, request) if isinstance(request, bytes) else request
    context = supplies.context(cancelled=cancelled, progress=progress, before=before)
    outcome = carried_out(run, decoded, context)
    body = gzip.compress(outcome.result.model_dump_json().encode(), LEVEL)
    return Reply(body, outcome.view, "" if decoded is request else key_of(run, decoded))
