"""Choices by name."""

import re
from enum import StrEnum
from typing import Self

from knitcore.base.errors import InputError


class Choice(StrEnum):
    """A closed set of names; errors name an input of this kind by the class: HungBy, hung_by."""

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
            field = re.sub(r"\B(?=[A-Z])", "_", cls.__name__).lower()
            known = ", ".join(cls)
            raise InputError(field, f"{name!r:.40} is not known.", f"Use {known}.") from None
