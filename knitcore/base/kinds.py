"""Kinds of things that callers give."""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from knitcore.base.arrays import Array, Mask
from knitcore.base.errors import InputError

Kind = type | tuple[type, ...]


def check_kind(field: str, value: object, kind: Kind, remedy: str) -> None:
    """Refuse a value that is not of a kind.

    Raises
    ------
    InputError

    Examples
    --------
    >>> check_kind("material", 3, str, "Give the identifier of a material such as 'acrylic'.")
    Traceback (most recent call last):
    knitcore.base.errors.InputError: material: is of type int. Give the identifier of a material \
such as 'acrylic'.
    """
    if not isinstance(value, kind):
        raise InputError(field, f"is of type {type(value).__name__}.", remedy)


def check_flags(**flags: object) -> None:
    """Refuse a flag that is neither True nor False.

    Raises
    ------
    InputError
    """
    for field, value in flags.items():
        check_kind(field, value, (bool, np.bool_), "Give True or False.")


def check_callables(**functions: Callable[..., object] | None) -> None:
    """Refuse what is neither a function nor None.

    Raises
    ------
    InputError
    """
    for field, value in functions.items():
        if value is not None and not callable(value):
            raise InputError(field, f"is of type {type(value).__name__}.", "Give a function.")


def as_numbers(field: str, values: ArrayLike, remedy: str) -> Array:
    """Take numbers as an array.

    Raises
    ------
    InputError
        If they are no numbers, or lists of unequal lengths.

    Examples
    --------
    >>> as_numbers("strain", "0.2 mm", "Give a number above 0.")
    Traceback (most recent call last):
    knitcore.base.errors.InputError: strain: '0.2 mm' cannot be read as numbers. Give a number \
above 0.
    """
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        problem = f"{values!r:.40} cannot be read as numbers."
        raise InputError(field, problem, remedy) from None


def as_mask(field: str, values: ArrayLike, remedy: str) -> Mask:
    """Take a table of True and False, or of 1 and 0, as an array of its own.

    Raises
    ------
    InputError
        If it has no rows and columns, or holds anything else.
    """
    is_mask = isinstance(values, np.ndarray) and values.dtype == bool
    table = np.asarray(values) if is_mask else as_numbers(field, values, remedy)
    if table.ndim != 2 or not (is_mask or np.isin(table, (0, 1)).all()):
        raise InputError(field, "is not a table of True and False.", remedy)
    return table.astype(bool)
