"""A design in the API: the JSON document, its metadata, and requests that change it."""

from enum import StrEnum
from typing import Annotated, Literal

from pydantic import AwareDatetime, BaseModel, Field

from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE
from knitcore.formats.designs.design_file import FORMAT, VERSION
from knitcore.formats.designs.layout import DesignLayout

from ...requests.base import RequestModel
from ...requests.charts import ChartText

Name = Annotated[
    str,
    Field(
        min_length=1, max_length=200, pattern=r"^[^\x00-\x1f]+$", examples=["Cuff with a soft rim"]
    ),
]
MaterialId = Annotated[
    str, Field(min_length=1, max_length=80, pattern=r"^[^\x00-\x1f]+$", examples=["acrylic"])
]
Note = Annotated[str, Field(max_length=20_000)]
MAX_RUNS = 20_000


class DesignDocument(DesignLayout, RequestModel):
    """A design as a file holds it; ``knitcore`` reads the same on the command line."""

    format: Literal["knitcore-design"] = FORMAT
    version: Literal[2] = VERSION
    name: Name
    material: MaterialId
    chart: ChartText
    note: Note = ""


class DesignSummary(BaseModel):
    """A design in a list."""

    id: str
    name: str
    material: str
    rows: int
    columns: int
    revision: int = Field(
        description="Number that grows with every change; the ETag is made of it."
    )
    created_at: AwareDatetime
    changed_at: AwareDatetime
    deleted_at: AwareDatetime | None = None


class Design(DesignSummary):
    """A design with its document."""

    document: DesignDocument


class DesignPage(BaseModel):
    """A part of a list, latest changes first."""

    designs: list[DesignSummary]
    next_cursor: str | None = Field(description="Send it to get the next page; null at the end.")


class DesignPatch(RequestModel):
    """Fields to change; the others stay."""

    name: Name | None = None
    material: MaterialId | None = None
    note: Note | None = None


class Run(RequestModel):
    """Adjacent stitches of one kind in a row."""

    row: int = Field(
        ge=0, lt=MAX_STITCHES_PER_SIDE, description="Row, counted from 0 at the bottom."
    )
    column: int = Field(
        ge=0, lt=MAX_STITCHES_PER_SIDE, description="First stitch, counted from 0 at the left."
    )
    stitches: str = Field(pattern=r"^[KP]+$", max_length=MAX_STITCHES_PER_SIDE, examples=["KKP"])


class Strokes(RequestModel):
    """Paint: new values of stitches, so that strokes of several people merge."""

    rows: int = Field(ge=1, description="Size of the chart that was painted on.")
    columns: int = Field(ge=1)
    runs: list[Run] = Field(min_length=1, max_length=MAX_RUNS)


class StitchKinds(BaseModel):
    """Kinds of the stitches in a box; a material's `stitches` table says what each kind does."""

    row: int = Field(
        description="Bottom row of the box, counted from 0 at the bottom of the chart."
    )
    column: int = Field(description="Left column of the box, counted from 0 at the left.")
    kinds: list[str] = Field(
        description="A hexadecimal digit for each stitch, bottom row first: its kind, 0 to 15."
    )


class Painted(BaseModel):
    """The design's state after strokes were kept."""

    revision: int
    changed_at: AwareDatetime
    map: StitchKinds = Field(
        description="Stitches that look different now: the strokes and one around."
    )


class VersionRequest(RequestModel):
    """A name for the design's present state."""

    name: Name


class VersionSummary(BaseModel):
    """A kept state of a design."""

    number: int = Field(description="Number of the version, counted from 1, oldest first.")
    name: str
    automatic: bool = Field(
        description="True if the service saved it before a restore replaced it."
    )
    revision: int
    created_at: AwareDatetime


class Version(VersionSummary):
    """A kept state with its document."""

    document: DesignDocument


class Versions(BaseModel):
    """All kept states of a design."""

    versions: list[VersionSummary]


class PlaceRequest(RequestModel):
    """Where somebody is in knitting a design."""

    row: int = Field(
        ge=0, le=100_000, description="Row at hand, counted from 0, which is before the first."
    )
    count: int = Field(0, ge=0, le=1_000_000, description="A counter of the knitter's own.")


class KnittingPlace(BaseModel):
    """A place that is kept."""

    way: str = Field(description="`flat`, `round`, or the identifier of a machine.")
    row: int = Field(description="Row at hand, counted from 0, which is before the first.")
    count: int
    changed_at: AwareDatetime


class KnittingPlaces(BaseModel):
    """The places in a design, the latest first."""

    places: list[KnittingPlace]


class ShareMode(StrEnum):
    """Rights that a link gives."""

    READ = "read"
    COPY = "copy"


class ShareRequest(RequestModel):
    """A link to give away."""

    mode: ShareMode = ShareMode.READ


class Share(BaseModel):
    """A link that was given away; its secret is shown only once, when it is made."""

    id: str
    mode: ShareMode
    created_at: AwareDatetime


class NewShare(Share):
    """A new link with its secret."""

    token: str = Field(
        description="Secret of the link: whoever has it finds the design at /api/v1/shared/{token}."
    )


class Shares(BaseModel):
    """The links of a design that are not revoked."""

    shares: list[Share]


class SharedDesign(BaseModel):
    """The design behind a link."""

    mode: ShareMode
    document: DesignDocument
    revision: int
    changed_at: AwareDatetime
