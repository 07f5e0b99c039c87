"""Results of computations: a short text for people, plain values for programs."""

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any, ClassVar

import numpy as np

from knitcore.chart.stitch_chart import StitchChart

_MOST_SHOWN = 3
"""Items of a list that a text still spells out."""
_LONG = 40
"""Characters of a text that a text still spells out."""
_NOT_PLAIN = object()


class Result:
    """A dataclass of numbers and arrays, made with ``repr=False``.

    Its text gives the shape of an array instead of its numbers, and other objects in the words of
    their ``str``. :meth:`to_dict` has everything that JSON can hold, under names that carry the
    units.
    """

    also_listed: ClassVar[tuple[str, ...]] = ()
    """Properties that :meth:`to_dict` lists after the fields."""
    not_listed: ClassVar[tuple[str, ...]] = ()
    """Fields that it leaves out."""

    def to_dict(self) -> dict[str, Any]:
        """Collect the result as numbers, texts, lists and dictionaries.

        Intervals are lists of their two ends, charts their text, and NaN and infinity None. Fields
        that hold neither, such as functions and meshes, are left out, and so are objects with such
        fields.
        """
        names = [name for name in _names(self) if name not in self.not_listed]
        values = {name: _plain(getattr(self, name)) for name in (*names, *self.also_listed)}
        return {name: value for name, value in values.items() if value is not _NOT_PLAIN}

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={_short(getattr(self, name))}" for name in _names(self))
        return f"{type(self).__name__}({shown})"


def _names(of: object) -> list[str]:
    return [field.name for field in fields(of)]  # type: ignore[arg-type]


def _plain(value: object) -> Any:  # noqa: PLR0911
    """A value as JSON can hold it."""
    match value:
        case None | bool() | int():
            return value
        case Enum():
            return value.value
        case str():
            return value
        case float():
            return float(value) if math.isfinite(value) else None
        case np.generic() | np.ndarray():
            return _plain(value.tolist())
        case StitchChart():
            return value.key
        case Result():
            return value.to_dict()
        case Mapping():
            pairs = {str(key): _plain(item) for key, item in value.items()}
            return _NOT_PLAIN if any(item is _NOT_PLAIN for item in pairs.values()) else pairs
        case _ if hasattr(value, "__iter__"):
            items = [_plain(item) for item in value]
            return _NOT_PLAIN if any(item is _NOT_PLAIN for item in items) else items
        case _ if is_dataclass(value):
            return _plain({name: getattr(value, name) for name in _names(value)})
    return _NOT_PLAIN


def _short(value: object) -> str:  # noqa: PLR0911
    match value:
        case np.ndarray() if value.ndim:
            return f"<{' x '.join(map(str, value.shape))}>"
        case float() | np.floating():
            return f"{value:.4g}"
        case Enum():
            return str(value)
        case StitchChart():
            return f"<{value.columns} x {value.rows} stitches>"
        case tuple() | list() | Mapping() if len(value) > _MOST_SHOWN:
            return f"<{len(value)} items>"
        case tuple() | list():
            return f"({', '.join(map(_short, value))})"
        case str():
            return repr(value if len(value) <= _LONG else f"{value[:_LONG]}…")
        case bool() | int() | None:
            return repr(value)
    has_words = type(value).__str__ is not object.__str__
    return f"<{value if has_words else type(value).__name__}>"
