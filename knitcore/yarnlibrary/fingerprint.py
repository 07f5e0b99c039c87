"""Which solver made a result, and a name made of everything that decides it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Any

_SOURCES = (
    ("knitcore.yarnlevel", None),
    ("knitcore.yarnlibrary", ("characterise.py", "lawfit.py")),
    ("knitcore.measure", ("law_fit.py",)),
)
"""Packages, and the modules in them (None: all), whose code decides what a result is."""


@cache
def solver_version() -> str:
    """Digest of the code that decides a result of the yarn level, its law included.

    Examples
    --------
    >>> len(solver_version())
    16
    """
    digest = hashlib.sha256()
    for package, names in _SOURCES:
        for name, text in sorted(_sources(files(package), f"{package}/")):
            if names is None or name.rpartition("/")[2] in names:
                digest.update(name.encode() + b"\0" + text + b"\0")
    return digest.hexdigest()[:16]


def content_key(content: Mapping[str, Any]) -> str:
    """A name made of what decides a result: JSON-able inputs, and the solver.

    Examples
    --------
    >>> content_key({"a": 1, "b": 2}) == content_key({"b": 2, "a": 1})
    True
    """
    text = json.dumps(content, sort_keys=True, allow_nan=False)
    return hashlib.sha256(f"{solver_version()}\0{text}".encode()).hexdigest()[:32]


def _sources(folder: Traversable, prefix: str) -> list[tuple[str, bytes]]:
    found = []
    for entry in folder.iterdir():
        if entry.is_dir():
            found += _sources(entry, f"{prefix}{entry.name}/")
        elif entry.name.endswith(".py"):
            found.append((prefix + entry.name, entry.read_bytes()))
    return found
