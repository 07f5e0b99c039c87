"""Names of things that extensions offer, in requests."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from knitcore.extensions import IDENTIFIER

ExtensionName = Annotated[str, Field(pattern=f"^{IDENTIFIER.pattern}$")]
"""An identifier of something that is not built in."""
