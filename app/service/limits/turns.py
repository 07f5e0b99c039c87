"""The order in which several users are served."""

from collections import OrderedDict, deque
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class Turns(Generic[T]):
    """Lines of several users, of which each gives one at a time; not for two threads at once."""

    def __init__(self) -> None:
        self._lines: OrderedDict[str, deque[T]] = OrderedDict()

    def add(self, owner: str, item: T) -> None:
        """Put an item at the end of its owner's line."""
        self._lines.setdefault(owner, deque()).append(item)

    def next(self, may: Callable[[str], bool] = lambda _: True) -> tuple[str, T] | None:
        """Take the first item of the owner whose turn it is; None if there is none.

        Parameters
        ----------
        may : whether an owner may have a turn now.
        """
        for owner, line in self._lines.items():
            if may(owner):
                item = line.popleft()
                if line:
                    self._lines.move_to_end(owner)
                else:
                    del self._lines[owner]
                return owner, item
        return None
