"""Choices by name."""

from enum import StrEnum
from typing import Self

from knitcore.base.errors import InputError


class Choice(StrEnum):
    """A closed set of names; errors name an input of this kind by the class, in small letters."""

    @classmethod
    def parse(cls, name: str) -> Self:
        """The member of a name.

        Raises
        ------
        InputError
            If there is none of this name.
        """
        try:
            return cls(name)
        except ValueError:
            field, known = cls.__name__.lower(), ", ".join(cls)
            raise InputError(field, f"{name!r} is not known.", f"Use {known}.") from None
