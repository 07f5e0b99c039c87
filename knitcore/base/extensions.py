"""Extensions: yarns and file formats of other installed packages.

A package offers them by entry points (``importlib.metadata``) of the groups in :class:`Group`. Each
names a function without arguments that returns a list of what the group holds. An extension is
imported only when something is requested that is not built in, or a list of everything.
An extension that cannot be used is left out with a warning; the others are not affected.
"""

import re
import warnings
from collections.abc import Container, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import StrEnum
from importlib.metadata import EntryPoint, entry_points
from typing import Protocol, TypeVar

from knitcore.base.errors import KnitcoreError

IDENTIFIER = re.compile(r"[a-z0-9][a-z0-9:-]{0,79}")


class Group(StrEnum):
    """Groups of entry points, and what their functions return lists of."""

    MATERIALS = "knitcore.materials"
    """:class:`knitcore.materials.Material`"""
    EXPORTERS = "knitcore.exporters"
    """:class:`knitcore.formats.write.export.Exporter`"""


class Offer(Protocol):
    """A thing that an extension offers, with a name for requests."""

    @property
    def identifier(self) -> str:
        """Lower-case letters, digits, hyphens and colons."""
        ...


Kind = TypeVar("Kind", bound=Offer)


class ExtensionError(KnitcoreError):
    """An extension that cannot be used; names its entry point and its package."""


class ExtensionWarning(UserWarning):
    """Warning that an extension was left out."""


@dataclass(frozen=True)
class Extension:
    """An entry point of an installed package.

    Attributes
    ----------
    group, name : of the entry point.
    target : its function, ``module:function``.
    package : the package and its version.
    """

    group: Group
    name: str
    target: str
    package: str

    def load(self, kind: type[Kind]) -> tuple[Kind, ...]:
        """The things that it offers.

        Raises
        ------
        ExtensionError
            If it cannot be imported, fails, or offers something else.
        """
        try:
            things = tuple(EntryPoint(self.name, self.target, self.group).load()())
        except Exception as error:  # a foreign package may raise anything
            raise self.error(f"{type(error).__name__}: {error}") from error
        for thing in things:
            if not isinstance(thing, kind):
                raise self.error(f"it offers a {type(thing).__name__}, not a {kind.__name__}")
            if not IDENTIFIER.fullmatch(thing.identifier):
                raise self.error(
                    f"{thing.identifier!r} is not an identifier"
                    " (lower-case letters, digits, hyphens)"
                )
        return things

    def error(self, problem: str) -> ExtensionError:
        """An error that names the entry point."""
        return ExtensionError(
            f"extension {self.name!r} ({self.group}, {self.target}) of {self.package} cannot be "
            f"used: {problem}. Update or uninstall that package."
        )


def extensions(group: Group) -> Iterator[Extension]:
    """All extensions of a group by name; imports none of them."""
    for point in sorted(entry_points(group=group), key=lambda point: point.name):
        package = f"{point.dist.name} {point.dist.version}" if point.dist else "an unknown package"
        yield Extension(group, point.name, point.value, package)


def offered(group: Group, kind: type[Kind], built_in: Container[str] = ()) -> dict[str, Kind]:
    """Everything that the extensions of a group offer, by identifier.

    Parameters
    ----------
    group : of entry points.
    kind : the class of what they offer.
    built_in : identifiers that no extension may take.

    Warns
    -----
    ExtensionWarning
        Of every extension that is left out, because it fails or takes a name that is taken.
    """
    things: dict[str, Kind] = {}
    for extension in extensions(group):
        try:
            new = {thing.identifier: thing for thing in extension.load(kind)}
            if taken := [name for name in new if name in built_in or name in things]:
                raise extension.error(f"{', '.join(taken)} exists already")
        except ExtensionError as error:
            warnings.warn(str(error), ExtensionWarning, stacklevel=2)
        else:
            things |= new
    return things


@contextmanager
def running(group: Group, identifier: str) -> Iterator[None]:
    """A context for code of an extension, which turns its errors into ones that name the extension.

    Raises
    ------
    ExtensionError
        In place of errors that this library does not raise.
    """
    try:
        yield
    except KnitcoreError:
        raise
    except Exception as error:
        raise ExtensionError(
            f"{identifier!r} of an extension ({group}) failed: {type(error).__name__}: {error}"
        ) from error
