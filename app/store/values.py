"""Times and secrets as the tables hold them."""

from __future__ import annotations

import hashlib
import time


def now() -> float:
    """Seconds since 1970, UTC."""
    return time.time()


def hash_of(secret: str) -> str:
    """Secrets here are 256 random bits, so that a plain hash cannot be turned back."""
    return hashlib.sha256(secret.encode()).hexdigest()
