"""Names of designs in addresses."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path

DesignId = Annotated[
    str,
    Path(
        pattern=r"^[A-Za-z0-9_-]{8,64}$",
        description="The design's identifier: 8 to 64 letters, digits, - or _.",
    ),
]
