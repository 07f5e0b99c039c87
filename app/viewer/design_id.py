"""Names of designs in addresses."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path

from ..service.identity import current_user

DesignId = Annotated[
    str,
    Path(
        pattern=r"^[A-Za-z0-9_-]{1,64}$",
        description="The design's identifier: up to 64 letters, digits, - or _.",
    ),
]


def private_name(design: str) -> str:
    """The name of a design's view, unique among users, so that views are private."""
    return f"{current_user.get()}/{design}"
