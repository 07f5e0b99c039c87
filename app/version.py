"""The version of the installed program, which ``pyproject.toml`` says."""

from __future__ import annotations

from importlib.metadata import version

VERSION = version("knitcore")
