"""Parts of a request that the library can judge one by one.

A computation stops at the first input that it cannot use. Then :func:`all_faults` checks the parts
that it did not reach, so that a caller learns at once of a wrong chart, a wrong material and wrong
stresses. A valid request costs nothing more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin

from pydantic import BaseModel

from knitcore.base.errors import InputError

if TYPE_CHECKING:
    from ..context import Context


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
    fields = ((name, getattr(request, name)) for name in type(request).model_fields)
    others = faults_of(type(request), dict(fields), context)
    return with_others(error, [*error.others, *others])


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
