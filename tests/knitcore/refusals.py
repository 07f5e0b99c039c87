"""Refusals of input."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from knitcore import InputError


@contextmanager
def refuses(field: str, problem: str | None = None) -> Iterator[pytest.ExceptionInfo[InputError]]:
    """Expect an error of this very field, with a message that matches."""
    with pytest.raises(InputError, match=problem) as refusal:
        yield refusal
    assert refusal.value.field == field
