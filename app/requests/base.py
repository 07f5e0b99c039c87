"""Bases of requests and results."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from inspect import signature
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    TypeAdapter,
    ValidationError,
    model_validator,
)
from pydantic_core import PydanticCustomError

from knitcore.base.errors import InputError

from .faults import problem_in_words

if TYPE_CHECKING:
    from ..context import Context

T = TypeVar("T")
_HALF = re.compile("[\ud800-\udfff]")
"""Half of a character, which texts of JSON may hold but no answer and no database."""
_NUL = re.compile(r"(?<!\\)(?:\\\\)*\\u0000")
"""An escaped NUL; backslashes before it may be escaped themselves."""
UNIT = "_n_per_mm"
MAX_NAMES = 1_000
"""Names in one object; no request has a tenth of it, and to check 140,000 takes 150 ms."""
MAX_LISTED = 1_000
"""Faults of one request that are looked at: to list 150,000 takes two seconds."""


class MissingError(InputError):
    """Error: nothing has the name that the address gives."""


class InvalidRequestError(Exception):
    """Error: the body of a request does not have the form that its address takes."""

    def __init__(self, errors: list[Any]) -> None:
        super().__init__(errors)
        self._errors = errors

    def errors(self) -> list[Any]:
        """Pydantic's errors, with the inputs removed."""
        return self._errors


def read(model: Any, content: bytes | str) -> Any:
    """A model, or what another annotation means, of JSON that somebody sent.

    Raises
    ------
    InvalidRequestError
    """
    try:
        sent = TypeAdapter(model).validate_json(content)
        decoded(content)
        return sent
    except json.JSONDecodeError as error:
        fault = {"type": "json_invalid", "loc": ("body",), "ctx": {"error": error.msg}}
        raise InvalidRequestError([fault]) from None
    except ValidationError as error:
        faults = error.errors(include_url=False, include_input=False)
        raise InvalidRequestError(
            [fault | {"loc": ("body", *fault["loc"])} for fault in faults]
        ) from None


def decoded(content: bytes | str) -> Any:
    """Decode JSON that somebody sent.

    Raises
    ------
    json.JSONDecodeError
        Also if an object has one name twice, or a text half a character or a NUL, which PostgreSQL
        does not take.
    """
    if isinstance(content, bytes):
        content = content.decode(json.detect_encoding(content), "surrogatepass")
    if "\\u0000" in content and _NUL.search(content):
        raise json.JSONDecodeError("a text holds the character NUL, \\u0000", "", 0)
    return json.loads(content, object_pairs_hook=_object)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    if len(pairs) > MAX_NAMES:
        raise json.JSONDecodeError(f"an object has more than {MAX_NAMES} names", "", 0)
    values = dict(pairs)
    for name, value in pairs:
        for part in (name, value):
            if isinstance(part, str) and not part.isascii() and _HALF.search(part):
                raise json.JSONDecodeError(f"{name!r} holds half of a character", "", 0)
    if len(values) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise json.JSONDecodeError(f"{twice!r} comes twice in one object", "", 0)
    return values


def first_fault(error: ValidationError) -> str:
    """The first thing that is wrong, and where."""
    fault = error.errors()[0]
    return ": ".join(filter(None, (".".join(map(str, fault["loc"])), problem_in_words(fault))))


class RequestModel(BaseModel):
    """A request, or a part of one; unknown fields are refused."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    @model_validator(mode="wrap")
    @classmethod
    def _with_few_faults(cls, sent: Any, check: ModelWrapValidatorHandler[Self]) -> Self:
        """Report a great many faults as one."""
        try:
            return check(sent)
        except ValidationError as error:
            if error.error_count() <= MAX_LISTED:
                raise
            words = "more than {most} of its names and values are wrong"
            raise PydanticCustomError("too_many_faults", words, {"most": MAX_LISTED}) from None

    def pass_to(self, function: Callable[..., T], *first: Any, **more: Any) -> T:
        """Call a function or a class of the library with these fields and the values given.

        A parameter that is not given takes the field of its name, or of its name and the unit N/mm.
        """
        names = list(signature(function).parameters)[len(first) :]
        mine = {n: f for n in names for f in (n, n + UNIT) if f in type(self).model_fields}
        return function(*first, **{n: getattr(self, f) for n, f in mine.items()} | more)

    def check_parts(self, context: Context) -> None:
        """Refuse parts that do not go together, or are too large together.

        An operation does so before it computes, and so does the queue of jobs.

        Raises
        ------
        InputError
        """


class NoRequest(RequestModel):
    """The request of an operation without inputs."""


class ResultModel(BaseModel):
    """A result, or a part of one, read from the attributes of a library result.

    A model that has all fields of a dataclass of the library inherits them from it.
    """

    model_config = ConfigDict(from_attributes=True)

    @classmethod
    def of(cls, source: object, **given: Any) -> Self:
        """Read the fields that are not given from one library result, by their names."""
        names = (name for name in cls.model_fields if name not in given and hasattr(source, name))
        return cls.model_validate({name: getattr(source, name) for name in names} | given)


class IntervalResult(ResultModel):
    """A result, or a part of one, with 90 % intervals."""

    interval_source: str = Field(description="Source of the 90 % intervals.")


def listed(value: Any) -> Any:
    """Turn an array of the library into lists."""
    return value.tolist() if hasattr(value, "tolist") else value


def _ends(value: Any) -> Any:
    return (value.low, value.high) if hasattr(value, "low") else value


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


Floats = Annotated[list[float], BeforeValidator(listed)]
"""An array of the library."""
Ends = Annotated[tuple[float, float], BeforeValidator(_ends)]
"""An interval is [low, high] everywhere, each end in the shape and the unit of its value, and its
field is named after that of the value: ``force_interval_n`` belongs to ``force_n``."""
EndsOfList = Annotated[tuple[Floats, Floats], BeforeValidator(_ends)]
"""Intervals of a list of values: the list of low ends, and that of high ends."""
Known = Annotated[float | None, BeforeValidator(_known)]
"""A number, null where the library's is not finite."""
KnownEnds = Annotated[tuple[Known, Known], BeforeValidator(_ends)]
"""The ends of an interval, null where they are not finite."""

Positive = Annotated[float, Field(gt=0, le=1000)]
Seed = Annotated[
    int,
    Field(
        ge=0, le=2**32 - 1, description="Seed of random choices: the same one gives the same chart."
    ),
]
