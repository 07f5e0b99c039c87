"""Which Knitcore answers."""

from __future__ import annotations

from pydantic import Field

from app.models.base import NoRequest, ResultModel
from app.operations.context import Context
from app.operations.registry import Operation
from app.version import VERSION


class VersionResult(ResultModel):
    """The program behind the address."""

    version: str = Field(description="Of the program, as `knitcore --version` says.")
    api: str = Field(description="Of the REST API: the part of its addresses after /api/.")


def version(_: NoRequest, __: Context) -> VersionResult:
    """What `knitcore --version` says on the service's machine."""
    return VersionResult(version=VERSION, api="v1")


OPERATION = Operation(version, tag="service", summary="Which version answers", method="GET")
