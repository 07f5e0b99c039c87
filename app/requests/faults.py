"""Faults of a request: all that the library refuses, and pydantic's errors in words.

A computation stops at the first input that it cannot use. Then :func:`all_faults` checks the parts
that it did not reach, so that a caller learns at once of a wrong chart, a wrong material and wrong
stresses. A valid request costs nothing more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin

from pydantic import BaseModel

from knitcore.base.errors import InputError
from knitcore.base.reading_time import ReadingTimeError

if TYPE_CHECKING:
    from ..context import Context
    from .base import RequestModel


@dataclass(frozen=True)
class CheckedBy:
    """Part of a field's type: how the library reads such a value.

    Attributes
    ----------
    read : called with the value and the context of the operation; raises InputError.
    """

    read: Callable[[Any, Context], object]


def all_faults(error: InputError, request: BaseModel, context: Context) -> InputError:
    """The error that stopped an operation, with those of the request's other parts."""
    if isinstance(error, ReadingTimeError):
        return error  # the other files would take as long
    return with_others(error, [*error.others, *_faults_of_parts(request, context)])


def check_all(request: RequestModel, context: Context) -> None:
    """Refuse a request that its operation would refuse before it computes.

    Raises
    ------
    InputError
        With everything that is wrong.
    """
    try:
        request.check_parts(context)
    except InputError as error:
        raise all_faults(error, request, context) from None
    faults = _faults_of_parts(request, context)
    if (first := next(faults, None)) is not None:
        raise with_others(first, faults)


def _faults_of_parts(request: BaseModel, context: Context) -> Iterator[InputError]:
    fields = ((name, getattr(request, name)) for name in type(request).model_fields)
    return faults_of(type(request), dict(fields), context)


def with_others(error: InputError, others: Iterable[InputError]) -> InputError:
    """An error together with others, without repetitions."""
    distinct = {(other.field, other.problem): other for other in others}
    distinct.pop((error.field, error.problem), None)
    error.others = tuple(distinct.values())
    return error


def faults_of(
    model: type[BaseModel], values: dict[str, Any], context: Context
) -> Iterator[InputError]:
    """Yield the errors that the library finds in the values of some fields of a request."""
    for name, value in values.items():
        field = model.model_fields[name]
        yield from _faults(field.annotation, field.metadata, value, context)


def _faults(
    kind: Any, metadata: Iterable[Any], value: Any, context: Context
) -> Iterator[InputError]:
    if value is None:
        return
    for check in metadata:
        if isinstance(check, CheckedBy):
            try:
                check.read(value, context)
            except InputError as error:
                yield error
    if isinstance(value, BaseModel):
        parts = {name: getattr(value, name) for name in type(value).model_fields}
        yield from faults_of(type(value), parts, context)
    for part in get_args(kind):
        own = get_args(part)[1:] if get_origin(part) is Annotated else ()
        bare = get_args(part)[0] if own else part
        for item in value if isinstance(value, list) else [value]:
            if not isinstance(item, BaseModel) or item is not value:
                yield from _faults(bare, own, item, context)


_PROBLEMS = {
    "too_short": "{actual_length} given, at least {min_length} needed",
    "too_long": "more than {max_length} given",
}
"""Problems by pydantic's type of error, where its own message speaks of Python."""
_OBJECTS = "model_attributes_type", "model_type"
_BODY = "Send a JSON object, with Content-Type: application/json."
_REMEDIES = {
    "missing": "Give {field}; /docs has an example.",
    "extra_forbidden": "Leave {field} out, or compare its name with /docs.",
    **dict.fromkeys(_OBJECTS, "Give {field} as a JSON object; /docs has an example."),
    "chart_type": 'Give rows such as "KP/PK", the top row first, or a fabric such as '
    '{{"fabric": "rib", "columns": 4, "rows": 2}}.',
    "union_tag_invalid": "Use one of {expected_tags}.",
    "literal_error": "Use {expected}.",
    "enum": "Use {expected}.",
    "greater_than": "Use more than {gt}.",
    "greater_than_equal": "Use {ge} or more.",
    "less_than": "Use less than {lt}.",
    "less_than_equal": "Use {le} or less.",
    "string_too_short": "Use {min_length} or more characters.",
    "string_too_long": "Use {max_length} or fewer characters.",
    "too_short": "Give {min_length} or more {field}.",
    "too_long": "Give {max_length} or fewer {field}.",
    "int_parsing": "Use a whole number.",
    "int_from_float": "Use a whole number.",
    "float_parsing": "Use a number.",
    "too_many_faults": "Compare it with the example in /docs.",
}
"""Remedies by pydantic's type of error; fields in braces come from its context."""
OF_VALUES = frozenset(_REMEDIES) - {"missing", "extra_forbidden", *_OBJECTS}
"""Types of errors whose remedy says nothing of how the value was sent."""


def problem_in_words(fault: Mapping[str, Any]) -> str:
    """Describe the problem, without the name of the field and a full stop."""
    words: str = _PROBLEMS.get(fault["type"], "{msg}")
    return words.format_map({"msg": fault["msg"], **fault.get("ctx", {})})


def remedy_in_words(fault: Mapping[str, Any], field: str) -> str:
    """Describe what would be accepted instead."""
    if fault["type"] in _OBJECTS and field == "body":
        return _BODY
    words: str = _REMEDIES.get(fault["type"], "{msg}; see /docs.")
    return words.format_map({"msg": fault["msg"], **fault.get("ctx", {}), "field": field})
