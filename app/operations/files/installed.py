"""Programs that are installed here: the version of this one, and what packages add to it."""

from pydantic import Field

from knitcore.base.extensions import ExtensionError, Group, Offer
from knitcore.base.extensions import extensions as installed
from knitcore.formats.write.export import Exporter
from knitcore.materials import Material

from ...context import Context
from ...requests.base import NoRequest, ResultModel
from ...service import VERSION
from ..registry import Command, Operation, operations
from .export import MAX_STITCHES

KINDS: dict[Group, type[Offer]] = {Group.MATERIALS: Material, Group.EXPORTERS: Exporter}


class ExtensionResult(ResultModel):
    """An extension of an installed package."""

    name: str
    group: Group
    package: str = Field(description="Name and version of the package.")
    offers: list[str] = Field(description="Identifiers of what it adds.")
    problem: str | None = Field(description="Reason why it cannot be used; null if it can.")


class Extensions(ResultModel):
    """All extensions, and how large a chart the service takes."""

    extensions: list[ExtensionResult]
    largest_exports: dict[str, int] = Field(
        description="Stitches of the largest chart over REST, for formats that have a limit."
    )
    largest_charts: dict[str, int] = Field(
        description="Stitches of the largest chart over REST, for operations that have a limit."
    )


def extensions(request: NoRequest, context: Context) -> Extensions:
    """Materials and file formats that installed packages add."""
    del request, context
    results = []
    for group, kind in KINDS.items():
        for extension in installed(group):
            offers: list[str] = []
            problem = None
            try:
                offers = [offer.identifier for offer in extension.load(kind)]
            except ExtensionError as error:
                problem = str(error)
            results.append(ExtensionResult.of(extension, offers=offers, problem=problem))
    limits = {name: operation.most_stitches for name, operation in operations().items()}
    return Extensions(
        extensions=results,
        largest_exports=MAX_STITCHES,
        largest_charts={name: most for name, most in limits.items() if most is not None},
    )


def _lines(result: Extensions) -> list[str]:
    lines = [
        f"{e.group:20} {e.name} ({e.package}): {e.problem or ', '.join(e.offers)}"
        for e in result.extensions
    ]
    return lines or ["no extensions are installed"]


class VersionResult(ResultModel):
    """The program and its versions."""

    version: str = Field(description="Version of the program, as `knitcore --version` prints it.")
    api: str = Field(description="Version of the REST API, as in its addresses after /api/.")


def version(_: NoRequest, __: Context) -> VersionResult:
    """The version of the program, as `knitcore --version` prints it on the service's machine."""
    return VersionResult(version=VERSION, api="v1")


EXTENSIONS = Operation(
    extensions,
    method="GET",
    tag="materials",
    summary="Additions of installed packages",
    command=Command(_lines),
)
VERSION_SHOWN = Operation(
    version, tag="service", summary="The version of the service", method="GET"
)
