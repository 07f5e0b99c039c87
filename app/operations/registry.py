"""The registry of operations, which modules in folders of subjects declare.

Each ``Operation`` that a module holds is one. Routes (:mod:`app.service.api.operations`), commands
(:mod:`app.cli.commands`), jobs (:mod:`app.service.jobs.kinds`) and the page's types
(``scripts/page_types.py``) are made from it, so a new operation is one file here and its test.
"""

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass, field
from functools import cache, cached_property
from operator import attrgetter
from typing import Any, Generic, Literal, TypeVar, cast, get_args, get_origin, get_type_hints

from pydantic import BaseModel

from .. import operations as package
from ..context import Context
from .perform import Viewed, key_of

Request = TypeVar("Request", bound=BaseModel)
Result = TypeVar("Result", bound=BaseModel)


@dataclass(frozen=True)
class Command:
    """An operation as a command, whose options are the fields of the request.

    Attributes
    ----------
    lines : a result for people; its notes, warnings and messages are printed besides.
    more : its help, after the line that it has in :mod:`app.cli.main`.
    names : options that are not named after their field; None leaves the field out.
    fields : makes fields of the request from options of its own (``click.option`` on it).
    run : runs the operation where the command does more, with options of its own. Both take any
        option of the command that they have a parameter for.
    request : model of the command's options, where it takes more or less than the operation.
    """

    lines: Callable[[Any], list[str]]
    more: str = ""
    names: Mapping[str, str | None] = field(default_factory=dict)
    fields: Callable[..., Mapping[str, Any]] | None = None
    run: Callable[..., BaseModel | Viewed[Any]] | None = None
    request: type[BaseModel] | None = None


@dataclass(frozen=True)
class Operation(Generic[Request, Result]):
    """Something that Knitcore does for the page, programs and the command line alike.

    Attributes
    ----------
    run : the function that does it. Its name is that of the kind of job and, by default,
        of the address; its annotations are the models of request and result; its
        docstring is the description in the API's reference. It raises KnitcoreErrors.
    summary : one line.
    tag : heading in the API's reference.
    example : a small request, which the reference shows and the tests send.
    path : address under ``/api/v1``; None if it is a job only.
    heavy : whether it always takes long enough to need a worker process, as every job does; others
        go there with large charts only.
    job : whether it can run in the background.
    most_stitches : stitches of the largest chart over REST, where it has a limit of its own;
        ``run`` or the request refuses larger ones.
    command : on the command line, where :mod:`app.cli.main` lists it.
    """

    run: Callable[[Request, Context], Result | Viewed[Result]]
    _: KW_ONLY
    summary: str
    tag: str
    example: Mapping[str, Any] | None = None
    method: Literal["GET", "POST"] = "POST"
    path: str | None = ""
    heavy: bool = False
    job: bool = False
    most_stitches: int | None = None
    command: Command | None = None

    @property
    def name(self) -> str:
        """Name of the kind of job."""
        return self.run.__name__.rstrip("_")

    @cached_property
    def request(self) -> type[Request]:
        """The model of the request."""
        first, *_ = get_type_hints(self.run).values()
        return cast("type[Request]", first)

    @cached_property
    def result(self) -> type[Result]:
        """The model of the result."""
        returned = get_type_hints(self.run)["return"]
        return cast("type[Result]", get_args(returned)[0] if self.is_viewed else returned)

    @cached_property
    def is_viewed(self) -> bool:
        """True if its results come with data for the 3D view."""
        return get_origin(get_type_hints(self.run)["return"]) is Viewed

    @property
    def address(self) -> str:
        """The path under ``/api/v1``."""
        return self.path or f"/{self.name}"

    @property
    def description(self) -> str:
        """Description in the API's reference."""
        return (inspect.getdoc(self.run) or "").partition("\n\nRaises\n")[0]

    def key(self, request: BaseModel) -> str:
        """A key made of everything that a caller can choose."""
        return key_of(self.run, request)


@cache
def operations() -> dict[str, Operation[Any, Any]]:
    """All operations, in the order of their names."""
    modules = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    names = [module.name.removeprefix(f"{package.__name__}.") for module in modules]
    declared = [operation for name in names for operation in operations_in(name)]
    return {operation.name: operation for operation in sorted(declared, key=attrgetter("name"))}


def operations_in(module: str) -> list[Operation[Any, Any]]:
    """The operations that a module of this package declares."""
    values = vars(importlib.import_module(f"{package.__name__}.{module}")).values()
    return [value for value in values if isinstance(value, Operation)]
