"""The registry of operations: one module of a subject's folder each.

A module holds one ``OPERATION``. Routes (:mod:`app.service.api.operations`), commands
(:mod:`app.cli.commands`), jobs (:mod:`app.service.jobs.kinds`), the client's methods
(``scripts/client_code.py``) and the page's types (``scripts/page_types.py``) are made from it, so
a new operation is one file here and its test.
"""

from __future__ import annotations

import contextlib
import importlib
import inspect
import keyword
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass, field
from functools import cache, cached_property
from typing import (
    Any,
    Generic,
    Literal,
    TypeVar,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

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
    help : of the command; by default the operation's summary.
    group : the command that it is a part of, such as ``measure``.
    names : options that are not named after their field; None leaves the field out.
    fields : makes fields of the request from options of its own (``click.option`` on it).
    run : runs the operation where the command does more, with options of its own. Both take any
        option of the command that they have a parameter for.
    request : model of the command's options, where it takes more or less than the operation.
    """

    lines: Callable[[Any], list[str]]
    help: str = ""
    group: str = ""
    names: Mapping[str, str | None] = field(default_factory=dict)
    fields: Callable[..., Mapping[str, Any]] | None = None
    run: Callable[..., BaseModel | Viewed[Any]] | None = None
    request: type[BaseModel] | None = None


@dataclass(frozen=True)
class Operation(Generic[Request, Result]):
    """Something that Knitcore does for the page, programs and the command line alike.

    Attributes
    ----------
    run : the function that does it. Its name is that of the client's method, of the kind of job
        and, by default, of the address; its annotations are the models of request and result; its
        docstring is the description in the API's reference.
    summary : one line.
    tag : heading in the API's reference.
    example : a small request, which the reference shows and the tests send.
    path : address under ``/api/v1``; None if it is a job only.
    heavy : whether it always takes long enough to need a worker process, as every job does; others
        go there with large charts only.
    job : whether it can run in the background.
    command : on the command line, where its name is that of the module.
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
    command: Command | None = None

    @property
    def name(self) -> str:
        """Name of the client's method and of the kind of job."""
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
    """All operations by name, in the order of their modules."""
    modules = [importlib.import_module(name) for _, name in sorted(_modules().items())]
    declared = [module.OPERATION for module in modules if hasattr(module, "OPERATION")]
    return {operation.name: operation for operation in declared}


def operation_of_command(name: str, group: str = "") -> Operation[Any, Any] | None:
    """The operation behind a command; loads no other."""
    module = f"{name}_" if keyword.iskeyword(name) else name
    if module not in _modules():
        return None
    operation = getattr(importlib.import_module(_modules()[module]), "OPERATION", None)
    if not isinstance(operation, Operation) or operation.command is None:
        return None
    return operation if operation.command.group == group else None


def commands(group: str = "") -> set[str]:
    """Names of all commands made from operations."""
    names = set()
    for name in (module.removesuffix("_") for module in _modules()):
        with contextlib.suppress(ModuleNotFoundError):  # the light library has not all packages
            if operation_of_command(name, group) is not None:
                names.add(name)
    return names


@cache
def _modules() -> dict[str, str]:
    """Full names of the modules, by their last part."""
    modules = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
    return {m.name.rpartition(".")[2]: m.name for m in modules if not m.ispkg}
