"""The running version."""

from __future__ import annotations

from pydantic import Field

from ...context import Context
from ...requests.base import NoRequest, ResultModel
from ...service import VERSION
from ..registry import Operation


class VersionResult(ResultModel):
    """The program and its versions."""

    version: str = Field(description="Version of the program, as `knitcore --version` prints it.")
    api: str = Field(description="Version of the REST API, as in its addresses after /api/.")


def version(_: NoRequest, __: Context) -> VersionResult:
    """The version of the program, as `knitcore --version` prints it on the service's machine."""
    return VersionResult(version=VERSION, api="v1")


OPERATION = Operation(version, tag="service", summary="The version of the service", method="GET")
