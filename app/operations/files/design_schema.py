"""The JSON schema of the project file."""

from __future__ import annotations

from typing import Any

from pydantic import RootModel

from knitcore.formats.designs.design_file import design_schema as schema_of_designs

from ...context import Context
from ...requests.base import NoRequest
from ..registry import Operation


class DesignSchema(RootModel[dict[str, Any]]):
    """A JSON schema."""


def design_schema(request: NoRequest, context: Context) -> DesignSchema:
    """The JSON schema of a design file."""
    del request, context
    return DesignSchema(schema_of_designs())


OPERATION = Operation(
    design_schema,
    method="GET",
    path="/schemas/design",
    tag="files",
    summary="JSON schema of the project file",
)
