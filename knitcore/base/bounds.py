"""Ranges of numbers that callers give; NaN lies in none."""

from math import inf
from numbers import Integral, Real

from knitcore.base.errors import InputError
from knitcore.base.kinds import check_kind


def check_range(
    field: str, value: float, low: float, high: float, unit: str = "", what: str = "in range"
) -> None:
    """Refuse a number below ``low`` or above ``high``; ``what`` says what it is not.

    Raises
    ------
    InputError

    Examples
    --------
    >>> check_range("ease", 2, -0.6, 1, what="an ease")
    Traceback (most recent call last):
    knitcore.base.errors.InputError: ease: 2 is not an ease. Give -0.6 to 1.
    """
    remedy = f"Give {low:g} to {high:g} {unit}".rstrip() + "."
    check_kind(field, value, Real, remedy)
    if not low <= value <= high:
        raise InputError(field, _problem(value, unit, what), remedy)


def check_positive(
    field: str, value: float, unit: str = "", what: str = "positive", most: float = inf
) -> None:
    """Refuse a number that is not above 0, infinite or above ``most``.

    Raises
    ------
    InputError

    Examples
    --------
    >>> check_positive("width_mm", 0, "mm", "a width")
    Traceback (most recent call last):
    knitcore.base.errors.InputError: width_mm: 0 mm is not a width. Give a number above 0 mm.
    """
    remedy = "Give a number above 0" if most == inf else f"Give above 0 to {most:g}"
    remedy = f"{remedy} {unit}".rstrip() + "."
    check_kind(field, value, Real, remedy)
    if not 0 < value < inf or value > most:
        raise InputError(field, _problem(value, unit, what), remedy)


def check_count(field: str, value: int, low: int, high: int) -> None:
    """Refuse a value that is not a whole number from ``low`` to ``high``.

    Raises
    ------
    InputError

    Examples
    --------
    >>> check_count("rounds", 2.5, 2, 200)
    Traceback (most recent call last):
    knitcore.base.errors.InputError: rounds: 2.5 is not a whole number. Give 2 to 200.
    """
    check_kind(field, value, Real, f"Give a whole number from {low} to {high}.")
    if not isinstance(value, Integral):
        raise InputError(field, _problem(value, "", "a whole number"), f"Give {low} to {high}.")
    check_range(field, value, low, high)


def check_linear_density(g_per_m: float) -> None:
    """Refuse a linear density that no yarn has, g/m.

    Raises
    ------
    InputError
    """
    field = "linear_density_g_per_m"
    check_range(field, g_per_m, 0.005, 20.0, "g/m (tex divided by 1000)")


def _problem(value: float, unit: str, what: str) -> str:
    return f"{value:g} {unit}".rstrip() + f" is not {what}."
