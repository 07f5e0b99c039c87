"""Fields of a request as arguments and options, and the request made of what they hold.

============================  ====================================================
field                         on the command line
============================  ====================================================
``chart``                     the argument CHART, and ``--size``
a group, such as a gauge      an option for each field of the group
a file that must be given     an argument; a list of files takes several
true or false                 ``--name``; ``--name/--no-name`` if true by default
a list                        ``--name``, which may be repeated
anything else                 ``--name VALUE``
============================  ====================================================
"""

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import click
from click.core import ParameterSource
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from knitcore.base.errors import InputError

from ..requests.base import UNIT
from ..requests.charts import ANY_STITCHES, IS_REPEAT
from ..requests.faults import OF_VALUES, problem_in_words, remedy_in_words
from ..requests.uploads import UploadedFile
from .options import chart_file, is_fabric, resolve_chart, show_notes, stitches_of

FILE = click.Path(path_type=Path)
MATERIAL_HELP = "Library id (see `knitcore materials`) or a material file."

Given = Mapping[str, Any]
"""Values of a command's parameters, by their names."""


@dataclass(frozen=True)
class Input:
    """A field of a request on the command line.

    Attributes
    ----------
    name : of the field.
    parameters : those of the command that it is read from.
    fields : the field, and others that come with it, made of the parameters' values; none that was
        left out.
    """

    name: str
    parameters: list[click.Parameter]
    fields: Callable[[Given], dict[str, Any]]


class Inputs:
    """The inputs of a command.

    Parameters
    ----------
    model : the request.
    renamed : options that are not named after their field; None leaves a field out.
    """

    def __init__(self, model: type[BaseModel], renamed: Mapping[str, str | None]) -> None:
        self.model = model
        self._renamed = renamed
        self.inputs = list(self._inputs())

    @property
    def names(self) -> set[str]:
        """Names of the fields."""
        return {made.name for made in self.inputs}

    @property
    def parameters(self) -> list[click.Parameter]:
        """Parameters for click, arguments first."""
        every = [parameter for made in self.inputs for parameter in made.parameters]
        return sorted(every, key=lambda parameter: not isinstance(parameter, click.Argument))

    def request(self, given: Given, more: Mapping[str, Any]) -> Any:
        """Make the request of the parameters' values and of further fields.

        Raises
        ------
        InputError
            If a value is wrong; it names the option.
        """
        fields: dict[str, Any] = {}
        for made in sorted(self.inputs, key=lambda made: made.name != "chart"):  # a design's first
            fields |= made.fields(given)
        try:
            return self.model.model_validate(fields | dict(more))
        except ValidationError as error:
            raise self._refusal(error) from None

    def _inputs(self) -> Iterator[Input]:
        fields = self.model.model_fields
        for name, field in fields.items():
            if self._renamed.get(name, "") is None or (name == "outline" and "chart" in fields):
                continue  # the file of the chart holds the outline
            kind, is_list = _kind(field)
            if name == "chart":
                yield _chart_input(self.model)
            elif _is_group(kind):
                yield self._group(name, kind)
            else:
                yield Input(name, [self._parameter(name, field, kind, is_list)], _value_of(name))

    def _group(self, name: str, group: type[BaseModel]) -> Input:
        options: list[click.Parameter] = [
            click.Option(
                [self._option(part), part],
                type=_click_type(_kind(field)[0]),
                help=field.description,
            )
            for part, field in group.model_fields.items()
        ]

        def fields(given: Given) -> dict[str, Any]:
            parts = {part: given[part] for part in group.model_fields if given[part] is not None}
            return {name: parts} if parts else {}

        return Input(name, options, fields)

    def _parameter(self, name: str, field: FieldInfo, kind: Any, is_list: bool) -> click.Parameter:
        option, text = self._option(name), field.description
        if field.is_required() and kind is UploadedFile:
            return click.Argument([name], type=FILE, nargs=-1 if is_list else 1, required=True)
        if kind is bool:
            both = f"{option}/--no-{option.removeprefix('--')}" if field.default else option
            return click.Option([both, name], is_flag=True, default=field.default, help=text)
        default = _shown(field.get_default(call_default_factory=True))
        shown = {} if default is None else {"default": default}  # None is a value, too
        return click.Option(
            [option, name],
            type=_click_type(kind),
            multiple=is_list,
            required=field.is_required(),
            show_default=True,
            **shown,
            help=MATERIAL_HELP if name == "material" else text,
        )

    def _option(self, field: str) -> str:
        kebab = field.removesuffix(UNIT).replace("_", "-")
        return self._renamed.get(field) or f"--{kebab}"

    def _refusal(self, error: ValidationError) -> InputError:
        """Say the first thing that pydantic refuses, with the name of the option."""
        first = error.errors()[0]
        place = [part for part in first["loc"] if isinstance(part, str)]
        field = self.model.model_fields.get(place[0]) if place else None
        if field is not None and _is_group(_kind(field)[0]):
            place = place[1:] or place
        name = ".".join(self._option(part).removeprefix("--") for part in place) or "request"
        value = f"{first['input']!r}: " if isinstance(first["input"], str | float) else ""
        return InputError(
            name,
            f"{value}{problem_in_words(first)}.",
            remedy_in_words(first, name)
            if first["type"] in OF_VALUES
            else "See --help for what it takes.",
        )


def _chart_input(model: type[BaseModel]) -> Input:
    marks = model.model_fields["chart"].metadata
    size = click.Option(
        ["--size"],
        metavar="COLUMNSxROWS",
        help="Size of cloth of a fabric given by name, or of a repeat in one line, such as 31x20.",
    )

    def fields(given: Given) -> dict[str, Any]:
        text, size = given["chart"], given["size"]
        any_stitches = ANY_STITCHES in marks and size is None
        if any_stitches and (repeat := stitches_of(text)) is not None:
            return {"chart": repeat.text}
        if size is None and (any_stitches or "outline" in model.model_fields):
            with chart_file(text) as file:
                if file is not None:
                    from ..operations.files.imports import design_in  # a repeat needs no readers

                    design, notes = design_in(file)
                    show_notes(notes)
                    known = ((n, part) for n, part in design if n in model.model_fields)
                    return {name: part for name, part in known if part is not None}
        chart = resolve_chart(text, size, is_repeat=IS_REPEAT in marks)
        if is_fabric(text) and size is not None:
            named = {"fabric": text.lower(), "columns": chart.columns, "rows": chart.rows}
            return {"chart": named}
        return {"chart": chart.text}

    return Input("chart", [click.Argument(["chart"], metavar="CHART"), size], fields)


def _value_of(name: str) -> Callable[[Given], dict[str, Any]]:
    def fields(given: Given) -> dict[str, Any]:
        source = click.get_current_context().get_parameter_source(name)
        value = None if source is ParameterSource.DEFAULT else _sent(given[name])
        return {} if value is None else {name: value}

    return fields


def _sent(value: Any) -> Any:
    """Turn a parameter's value into what a request takes: files, and lists that are not empty."""
    if isinstance(value, Path):
        return UploadedFile.at(value)
    if isinstance(value, tuple):
        return [_sent(part) for part in value] or None
    return value


def _shown(default: Any) -> Any:
    """Return a default that the help can show, None for any other."""
    if isinstance(default, Enum):
        return default.value
    return default if isinstance(default, str | float | int) and default != "" else None


def _kind(field: FieldInfo) -> tuple[Any, bool]:
    """Return the type of a field's value without None, and whether the value is a list of it."""
    of = field.annotation
    parts = get_args(of) if get_origin(of) in (Union, UnionType) else (of,)
    bare = [get_args(part)[0] if get_origin(part) is Annotated else part for part in parts]
    kinds = [kind for kind in bare if kind is not NoneType]
    kind = str if str in kinds else kinds[0]  # a choice, or any name that an extension adds
    return (get_args(kind)[0], True) if get_origin(kind) is list else (kind, False)


def _is_group(kind: Any) -> bool:
    return inspect.isclass(kind) and issubclass(kind, BaseModel) and kind is not UploadedFile


def _click_type(kind: Any) -> Any:
    if kind is UploadedFile:
        return FILE
    if get_origin(kind) is Literal:
        return click.Choice(get_args(kind))
    if inspect.isclass(kind) and issubclass(kind, Enum):
        return click.Choice([member.value for member in kind])
    return kind if kind in (int, float, str) else str
