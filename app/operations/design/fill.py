"""Charts with a target stiffness, given as a map or part by part, or a target outline."""

import csv
from pathlib import Path
from typing import Annotated, Any, Literal

import click
import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field

from knitcore.base.errors import InputError
from knitcore.base.reading_time import in_reading_time
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart, size_in_words
from knitcore.design.atlas import INTERVAL_SOURCE, Atlas
from knitcore.design.fill import fill_field
from knitcore.design.part_targets import PartTarget, target_maps
from knitcore.design.shape import MAX_SHAPED_STITCHES, fill_shape
from knitcore.formats.read.stitch_maps import read_target_moduli
from knitcore.garment.shaped import outline_marks

from ...cli.options import atlas_option, design_option, resolve_chart, write_design_of
from ...context import Context
from ...requests.base import Ends, IntervalResult, Known, ResultModel, Seed
from ...requests.charts import (
    ChartLines,
    ChartText,
    Column,
    MaterialName,
    OutlineInput,
    RepeatText,
    Row,
)
from ...requests.fabrics import Gauged, LawsRequest
from ...service.results.atlases import Extent
from ..registry import Command, Operation

Maps = tuple[NDArray[np.float64], NDArray[np.float64], tuple[PartTarget, ...]]

MAPS = ("modulus_course_n_per_mm", "modulus_wale_n_per_mm")
MAX_STITCHES = 40_000
"""Largest map over REST, in stitches; the command line accepts larger ones."""
MAX_TARGETS = 200
MAX_RUNS = 40_000

Modulus = Annotated[float, Field(gt=0, le=1000)] | None
Map = Annotated[list[list[Modulus]], Field(min_length=1, max_length=1000)]
StitchRun = tuple[
    Annotated[int, Field(ge=0)], Annotated[int, Field(ge=0)], Annotated[int, Field(ge=1)]
]


Rounded = Annotated[list[float], BeforeValidator(lambda values: np.round(values, 5).tolist())]
Gaps = Annotated[list[Known], BeforeValidator(list)]
Width = Annotated[float, Field(gt=0.05, lt=3)] | None


class PartTargetInput(Gauged):
    """Target stiffness of one part of the chart, which may have been counted as it is."""

    name: str = Field("part", min_length=1, max_length=80)
    runs: list[StitchRun] = Field(
        min_length=1,
        max_length=MAX_RUNS,
        description="Stitches as runs [row, first column, length], with row 0 at the bottom.",
    )
    modulus_course_n_per_mm: Modulus = None
    modulus_wale_n_per_mm: Modulus = None

    def target(self) -> PartTarget:
        """The library's object."""
        return PartTarget(
            self.name,
            tuple(self.runs),
            self.modulus_course_n_per_mm,
            self.modulus_wale_n_per_mm,
            self.relaxed_size,
        )


class FillRequest(LawsRequest):
    """Target moduli, stitch by stitch or part by part."""

    material: MaterialName
    modulus_course_n_per_mm: Map | None = Field(
        None,
        description="Moduli [row][column], the bottom row first; null where any value will do.",
    )
    modulus_wale_n_per_mm: Map | None = None
    rows: int | None = Field(
        None, ge=1, le=1000, description="Rows of the chart, if targets of parts are given."
    )
    columns: int | None = Field(None, ge=1, le=1000)
    targets: list[PartTargetInput] | None = Field(
        None,
        min_length=1,
        max_length=MAX_TARGETS,
        description="Targets of parts, in place of the two maps.",
    )
    chart: ChartText | None = Field(
        None,
        description="K/P lines, the top row first: stitches without a target stay as in this "
        "chart; otherwise they are filled.",
    )
    outline: OutlineInput = None
    repeats: Extent = "small"
    smallest_patch: int = Field(
        4, ge=1, le=100, description="Smallest side of a patch, where its part is not smaller."
    )
    scattered: bool = Field(
        True,
        description="Single stitches may be turned over where that comes nearer; otherwise every "
        "patch is a repeat, or stripes of two.",
    )
    seed: Seed = 0
    check: bool = Field(
        True,
        description="Pull the chart of a map in the finite swatch; choose again where the result "
        "differs. Parts are judged by what is predicted for them.",
    )

    def check_parts(self, context: Context) -> None:
        """Refuse maps or targets that do not go together, or are too large for the service."""
        size = _targets(self)[0].size
        if size > MAX_STITCHES and not context.local:
            raise InputError(
                "rows" if self.targets else MAPS[0],
                f"{size} stitches are too many here.",
                f"Use at most {MAX_STITCHES}, or the command line.",
            )


class PatchResult(ResultModel):
    """A region of one repeat."""

    part: str = Field(description="Name of the target that it fills; empty if maps were given.")
    repeat: RepeatText
    stitches: int
    row: Row = Field(description="Row of its first stitch, counted from 0 at the bottom.")
    column: Column
    deviation_course: Known = Field(
        description="Deviation of the repeat from the target; null without a target."
    )
    deviation_wale: Known
    swatch_course: Known = Field(
        description="Deviation of the patch in the finite swatch; null if it was not pulled."
    )
    swatch_wale: Known
    modulus_course_n_per_mm: float = Field(
        description="Modulus of the patch, in the finite swatch if it was pulled there; of its "
        "part, if parts were given."
    )
    modulus_course_interval_n_per_mm: Ends = Field(
        description="90 % interval; includes that of a large cloth of the repeat."
    )
    modulus_wale_n_per_mm: float
    modulus_wale_interval_n_per_mm: Ends


class NearestResult(ResultModel):
    """The repeat nearest to a target, with the moduli of a large cloth of it."""

    repeat: RepeatText
    course_n_per_mm: float
    wale_n_per_mm: float


class PartResult(ResultModel):
    """Moduli of a part, beside those that it had."""

    name: str
    stitches: int
    repainted: bool = Field(
        description="False for a part that stays as it was: no repeat that was tried came 10 % "
        "nearer, in neither direction farther."
    )
    nearest: NearestResult = Field(description="To its target, of all repeats of the yarn.")
    course_before_n_per_mm: Known = Field(
        description="Modulus of the largest rectangle inside, as the chart was, with "
        "its gauge; null without one."
    )
    wale_before_n_per_mm: Known
    course_n_per_mm: Known = Field(
        description="The same in the filled chart, which nobody has counted: of its computed size."
    )
    wale_n_per_mm: Known


class FillResult(IntervalResult):
    """A chart, and how near it comes to the targets."""

    kind: Literal["fill"] = "fill"
    rows: int
    columns: int
    chart: ChartLines
    off_share: float = Field(
        description="Share of the stitches with a target that miss it by more than 10 %."
    )
    patches: list[PatchResult]
    parts: list[PartResult] = Field(description="One for each target; none if maps were given.")
    messages: list[str]


class ShapeRequest(LawsRequest):
    """A profile of widths at a stretch."""

    material: MaterialName
    direction: Direction = Field(Direction.WALE, description="Direction of the pull.")
    strain: float = Field(gt=0, le=5, description="Strain from clamp to clamp: 0.3 is 30 %.")
    width: list[Width] = Field(
        min_length=3,
        max_length=1000,
        description="Stretched width over width at rest, line by line across the pull, from the "
        "bottom (wale-wise) or the left (course-wise); null where any width will do.",
    )
    across: int = Field(ge=3, le=1000, description="Stitches in a line.")
    repeats: Extent = "small"
    smallest_band: int = Field(4, ge=1, le=100, description="Fewest lines in a band.")
    seed: Seed = 0


class BandResult(ResultModel):
    """A band of lines of one repeat."""

    repeat: RepeatText
    first: int = Field(
        ge=1, description="First line of the band, counted from 1 at the bottom or the left."
    )
    lines: int


class ShapeResult(ResultModel):
    """A chart, and the outline of its swatch."""

    kind: Literal["shape"] = "shape"
    rows: int
    columns: int
    chart: ChartLines
    bands: list[BandResult]
    width: Rounded = Field(description="Width in the finite swatch, to compare with the target.")
    target: Gaps = Field(description="Width that was asked for; null where any will do.")
    rms: float = Field(description="Rms of the differences, over the width at rest.")
    largest: float
    force_n: float
    pulls: int = Field(description="Number of swatches that were computed.")
    messages: list[str]


def fill(request: FillRequest, context: Context) -> FillResult:
    """Patches of repeats from the atlas, matched at their edges; reports targets that are missed.

    Raises
    ------
    InputError
        If the maps or the targets of parts cannot be used, or are too large here.
    """
    request.check_parts(context)
    targets = _targets(request)
    atlas = context.within(0.0, 0.3).atlas(request.material, request.repeats)
    return _filled(request, targets, atlas, context.within(0.3, 0.7))


def _filled(request: FillRequest, targets: Maps, atlas: Atlas, context: Context) -> FillResult:
    course, wale, parts = targets
    filled = request.pass_to(
        fill_field,
        course,
        wale,
        context.material(request.material),
        atlas,
        parts=parts,
        kept=None if request.chart is None else StitchChart.parse(request.chart),
        stitch=None if request.outline is None else outline_marks(request.outline),
        progress=context.share,
        cancelled=context.cancelled,
    )
    return FillResult.of(
        filled,
        rows=filled.chart.rows,
        columns=filled.chart.columns,
        interval_source=f"{INTERVAL_SOURCE} Widened to what a patch does in the finite swatch.",
        chart=filled.chart.text,
        patches=filled.regions,
    )


def _targets(request: FillRequest) -> Maps:
    maps = {name: getattr(request, name) for name in MAPS}
    if request.targets is None:
        course, wale = (_array(rows, name) for name, rows in maps.items())
        return course, wale, ()
    if any(rows is not None for rows in maps.values()):
        raise InputError(
            "targets", "are given together with maps.", "Give maps or targets of parts, not both."
        )
    if request.rows is None or request.columns is None:
        raise InputError("rows", "the size of the chart is missing.", "Give rows and columns.")
    targets = tuple(part.target() for part in request.targets)
    return *request.pass_to(target_maps, targets), targets


def _array(rows: list[list[float | None]] | None, name: str) -> NDArray[np.float64]:
    if rows is None:
        raise InputError(name, "is missing.", "Give both maps, or targets of parts.")
    if len({len(row) for row in rows}) > 1 or not rows[0]:
        raise InputError(
            name, "the rows differ in length.", "Give a number or null for each stitch."
        )
    return np.array([[np.nan if v is None else v for v in row] for row in rows], dtype=float)


@click.argument("target", type=click.Path(path_type=Path))
@click.option(
    "--chart", "kept", help="Chart in which stitches without a target keep what they are."
)
@atlas_option
@design_option
def _fill_command(
    request: FillRequest,
    context: Context,
    target: Path,
    kept: str | None,
    atlas: Path | None,
    out: Path | None,
) -> FillResult:
    targets = *read_target_moduli(target), ()
    if kept is not None:
        request = request.model_copy(update={"chart": resolve_chart(kept, None).text})
    table = context.atlas(request.material, request.repeats, atlas)
    result = _filled(request, targets, table, context)
    write_design_of(result.chart, request.material, target.stem, out)
    return result


def _fill_lines(r: FillResult) -> list[str]:
    head = (
        f"{size_in_words(r.columns, r.rows)} in {len(r.patches)} patches; "
        f"{r.off_share:.1%} of the stitches with a target miss it by more than 10 %"
    )
    return [r.chart, head]


def shape(request: ShapeRequest, context: Context) -> ShapeResult:
    """Bands of repeats across the pull, chosen, checked in the finite swatch and chosen again."""
    return _shaped(request, context.atlas(request.material, request.repeats), context)


def _shaped(request: ShapeRequest, atlas: Atlas, context: Context) -> ShapeResult:
    shaped = request.pass_to(
        fill_shape,
        np.array([np.nan if w is None else w for w in request.width], dtype=float),
        material=context.material(request.material),
        atlas=atlas,
        progress=context.share,
        cancelled=context.cancelled,
    )
    return ShapeResult.of(
        shaped,
        rows=shaped.chart.rows,
        columns=shaped.chart.columns,
        chart=shaped.chart.text,
        target=shaped.target,
    )


@atlas_option
@design_option
def _shape_command(
    request: ShapeRequest, context: Context, atlas: Path | None, out: Path | None
) -> ShapeResult:
    table = context.atlas(request.material, request.repeats, atlas)
    result = _shaped(request, table, context)
    write_design_of(result.chart, request.material, "Shape", out)
    return result


@click.argument("profile", type=click.Path(path_type=Path))
@in_reading_time
def _widths(profile: Path) -> dict[str, Any]:
    """Read the column ``width`` of a CSV; an empty field means any width."""
    try:
        with profile.open(newline="", encoding="utf-8") as stream:
            names, *rows = csv.reader(stream)
        column = [name.strip() for name in names].index("width")
        values = [row[column].strip() if row else "" for row in rows]
        return {"width": [float(value) if value else None for value in values]}
    except FileNotFoundError:
        raise InputError("profile", f"there is no file {profile}.", "Check its name.") from None
    except (IndexError, ValueError):
        raise InputError(
            "profile", f"{profile.name} is not a profile.", "Give a column `width` of numbers."
        ) from None


def _shape_lines(r: ShapeResult) -> list[str]:
    bands = ", ".join(f"{b.lines} of {b.repeat}" for b in r.bands)
    head = (
        f"{size_in_words(r.columns, r.rows)}; widths {r.rms:.1%} off (rms), {r.largest:.1%} at "
        f"most; {r.force_n:.2f} N; from the first line: {bands}"
    )
    return [r.chart, head]


FILL = Operation(
    fill,
    tag="design",
    summary="A chart for a map of target stiffness",
    most_stitches=MAX_STITCHES,
    example={
        "material": "acrylic",
        "modulus_course_n_per_mm": [[0.2, 0.2, 0.2, 0.2], [0.2, 0.2, 0.2, 0.2]],
        "modulus_wale_n_per_mm": [[None, None, None, None], [None, None, None, None]],
    },
    job=True,
    command=Command(
        _fill_lines,
        more="TARGET is a CSV of row, column and target moduli, such as `export --to csv` writes.",
        names=dict.fromkeys((*MAPS, "rows", "columns", "targets", "chart")),
        run=_fill_command,
    ),
)
SHAPE = Operation(
    shape,
    tag="design",
    summary="A chart that takes a target outline when it is stretched",
    most_stitches=MAX_SHAPED_STITCHES,
    example={
        "material": "acrylic",
        "strain": 0.2,
        "across": 6,
        "width": [0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9],
    },
    job=True,
    command=Command(
        _shape_lines,
        more="PROFILE is a CSV with a column `width`, stretched width over width at rest, one line "
        "across the pull after the other from the bottom (or the left); empty where any width "
        "will do.",
        names={"width": None},
        fields=_widths,
        run=_shape_command,
    ),
)
