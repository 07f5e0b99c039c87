"""Commands made of operations: an option for every field of the request.

A chart becomes the argument CHART with ``--size``, a file an argument or an option that names it, a
group of fields (such as a gauge) an option for each of them; options leave out the unit N/mm.
Exceptions to these rules are in the operation's :class:`~app.operations.registry.Command`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from enum import Enum
from functools import partial
from inspect import signature
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import click
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from app.cli.common import emit, json_option, telling_what_is_compiled, user_data_dir
from app.command_options import resolve_chart
from app.context import Context
from app.models.base import UNIT, IntervalResult
from app.models.charts import IS_REPEAT
from app.models.refusals import OF_VALUES, problem_in_words, remedy_in_words
from app.models.uploads import UploadedFile
from app.operations.perform import Viewed, carried_out
from app.operations.registry import Command, Operation
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Fabric

FILE = click.Path(path_type=Path)
MATERIAL_HELP = "Library id (see `knitcore materials`) or a material file."


def command_of(operation: Operation[Any, Any], name: str) -> click.Command:
    """The command of an operation."""
    described = operation.command
    if described is None:
        raise TypeError(f"{operation.name} is not a command")
    options = _Options(described.request or operation.request, described)

    def callback(**given: Any) -> None:
        context = Context(user_data_dir, local=True)
        run: Callable[..., Any] = described.run or operation.run
        run = partial(run, **_taken(described.run, given))
        try:
            with telling_what_is_compiled():
                found = carried_out(run, options.request(given), context)
        except InputError as error:
            raise _of_options(error, made) from error
        result = found.result if isinstance(found, Viewed) else found
        emit(result, "\n".join(described.lines(result)), as_json=given["as_json"])
        for remark in () if given["as_json"] else _remarks(result):
            click.echo(remark, err=True)  # the result may be piped on

    help_text = described.help or f"{operation.summary}."
    made = json_option(click.command(name, help=help_text)(callback))
    own = [*_declared(described.fields), *_declared(described.run)]
    made.params = [*options.parameters, *own, *made.params]
    return made


def _of_options(error: InputError, command: click.Command) -> InputError:
    """The error, and those with it, with the names of options instead of those of fields."""
    options = (option for option in command.params if isinstance(option, click.Option))
    names = {option.name: max(option.opts, key=len).removeprefix("--") for option in options}
    field = names.get(error.field, error.field)
    named = InputError(field, error.problem, error.remedy, most=error.most)
    named.others = tuple(_of_options(other, command) for other in error.others)
    return named


def _remarks(result: BaseModel) -> list[str]:
    """What a result says besides its figures."""
    told = [
        f"{head}{remark}"
        for field, head in (("notes", "note: "), ("messages", ""), ("warnings", "warning: "))
        for remark in getattr(result, field, ())
    ]
    if isinstance(result, IntervalResult):
        source = result.interval_source
        told.append(source if source.startswith("No interval") else f"90 % intervals: {source}")
    return told


def _declared(function: Callable[..., Any] | None) -> list[click.Parameter]:
    """The options that ``click.option`` added to a function, in the order of its lines."""
    return list(reversed(getattr(function, "__click_params__", [])))


def _taken(function: Callable[..., Any] | None, given: dict[str, Any]) -> dict[str, Any]:
    """The options that a function has parameters for."""
    return {n: given[n] for n in signature(function).parameters if n in given} if function else {}


class _Options:
    """The options of a request's fields, and the request made from them."""

    def __init__(self, request: type[BaseModel], described: Command) -> None:
        self._model = request
        self._described = described
        fields = request.model_fields
        self._fields = {
            name: f for name, f in fields.items() if described.names.get(name, "") is not None
        }
        if "chart" in fields:
            self._fields.pop("outline", None)  # comes with the chart's file
        self._groups = {
            name: group
            for name, field in self._fields.items()
            if (group := _group(field)) is not None
        }

    @property
    def parameters(self) -> list[click.Parameter]:
        """For click, arguments first."""
        found = [p for name, field in self._fields.items() for p in self._of(name, field)]
        return sorted(found, key=lambda p: not isinstance(p, click.Argument))

    def request(self, given: dict[str, Any]) -> Any:
        """The request.

        Raises
        ------
        InputError
            Naming the option that is wrong.
        """
        asked = self._chart(given) if "chart" in self._fields else {}
        for name in self._fields:
            if name in self._groups:
                parts = {part: given[part] for part in self._groups[name].model_fields}
                if group := {part: value for part, value in parts.items() if value is not None}:
                    asked[name] = group
            elif name != "chart" and (value := _value(given[name])) is not None:
                asked[name] = value
        if self._described.fields is not None:
            asked |= self._described.fields(**_taken(self._described.fields, given))
        try:
            return self._model.model_validate(asked)
        except ValidationError as error:
            first = error.errors()[0]
            place = [part for part in first["loc"] if isinstance(part, str)]
            place = place[1:] if place and place[0] in self._groups else place
            name = ".".join(self._named(part) for part in place) or "request"
            given_text = f"{first['input']!r}: " if isinstance(first["input"], str | float) else ""
            known = first["type"] in OF_VALUES
            raise InputError(
                name,
                f"{given_text}{problem_in_words(first)}.",
                remedy_in_words(first, name) if known else "See --help for what it takes.",
            ) from None

    def _chart(self, given: dict[str, Any]) -> dict[str, Any]:
        """The chart, and other fields of the request that its file holds."""
        chart, size = given["chart"], given["size"]
        fields = self._model.model_fields
        if "outline" in fields and size is None and Path(chart).suffix:
            from app.operations.import_ import design_in

            held = design_in(Path(chart))
            return {name: value for name, value in held if name in fields and value is not None}
        if chart.lower() in set(Fabric):
            if size is None and IS_REPEAT in self._fields["chart"].metadata:
                return {"chart": StitchChart.of_fabric(chart).repeat().text}
            of = resolve_chart(chart, size)
            return {"chart": {"fabric": chart.lower(), "columns": of.columns, "rows": of.rows}}
        return {"chart": resolve_chart(chart, size).text}

    def _named(self, field: str) -> str:
        option = self._described.names.get(field) or field.removesuffix(UNIT).replace("_", "-")
        return option.removeprefix("--")

    def _of(self, name: str, field: FieldInfo) -> Iterator[click.Parameter]:
        if name in self._groups:
            for part, its in self._groups[name].model_fields.items():
                yield click.Option(
                    [f"--{self._named(part)}", part], type=_type(its), help=its.description
                )
        elif name == "chart":
            yield click.Argument(["chart"], metavar="CHART")
            yield click.Option(
                ["--size"],
                metavar="COLUMNSxROWS",
                help="Size of a fabric given by name, such as 31x20.",
            )
        elif field.is_required() and _is_file(field):
            many = get_origin(field.annotation) is list
            yield click.Argument([name], type=FILE, nargs=-1 if many else 1, required=True)
        elif field.annotation is bool:
            off = f"/--no-{self._named(name)}" if field.default else ""
            yield click.Option(
                [f"--{self._named(name)}{off}", name],
                is_flag=True,
                default=field.default,
                help=field.description,
            )
        else:
            default = field.get_default(call_default_factory=True)
            more: dict[str, Any] = {}
            if get_origin(_kinds(field)[0]) is list:
                more = {"multiple": True}
            elif isinstance(default, str | float | int) and default != "":
                more = {"show_default": str(default)}
            yield click.Option(
                [f"--{self._named(name)}", name],
                type=_type(field),
                required=field.is_required(),
                help=MATERIAL_HELP if name == "material" else field.description,
                **more,
            )


def _value(value: Any) -> Any:
    """The value as the request takes it: files as paths; options not given are left out."""
    if isinstance(value, Path):
        return UploadedFile.at(value)
    if isinstance(value, tuple):
        return [_value(one) for one in value] or None
    return value


def _kinds(field: FieldInfo) -> list[Any]:
    """The type of a value, without None."""
    of = field.annotation
    parts = get_args(of) if get_origin(of) in (Union, UnionType) else (of,)
    bare = [get_args(part)[0] if get_origin(part) is Annotated else part for part in parts]
    return [part for part in bare if part is not NoneType]


def _group(field: FieldInfo) -> type[BaseModel] | None:
    """The model of a group of fields."""
    kind = _kinds(field)[0]
    is_model = inspect.isclass(kind) and issubclass(kind, BaseModel)
    return kind if is_model and kind is not UploadedFile else None


def _is_file(field: FieldInfo) -> bool:
    kind = _kinds(field)[0]
    return kind is UploadedFile or get_args(kind) == (UploadedFile,)


def _type(field: FieldInfo) -> Any:
    """A type of click."""
    kind, *others = _kinds(field)
    if str in others:  # a choice, or a name that an extension adds
        return str
    if get_origin(kind) is list:
        kind = get_args(kind)[0]
    if kind is UploadedFile:
        return FILE
    if get_origin(kind) is Literal:
        return click.Choice(get_args(kind))
    if inspect.isclass(kind) and issubclass(kind, Enum):
        return click.Choice([member.value for member in kind])
    return kind if kind in (int, float, str) else str
