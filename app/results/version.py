"""The version of the program; kept results hold for one version only."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

DECIDING = frozenset({".py", ".csv", ".json", ".npz"})
"""Endings of program and data files."""


@cache
def program_version() -> str:
    """Digest of what computes: after an update, no older result is taken for a new one."""
    root = Path(__file__).resolve().parents[2]
    digest = hashlib.sha256()
    for file in sorted((*root.glob("knitcore/**/*"), *root.glob("app/operations/*"))):
        if file.suffix in DECIDING:
            digest.update(str(file.relative_to(root)).encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()
