"""A chart that takes a target outline when it is stretched."""

import csv
from pathlib import Path
from typing import Annotated, Any, Literal

import click
import numpy as np
from pydantic import BeforeValidator, Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import size_in_words
from knitcore.design.atlas import Atlas
from knitcore.design.shape import fill_shape

from ...cli.options import atlas_option, design_option, write_design_of
from ...context import Context
from ...requests.base import Known, ResultModel, Seed
from ...requests.charts import ChartLines, MaterialName, RepeatText
from ...requests.fabrics import LawsRequest
from ...service.results.atlases import Extent
from ..registry import Command, Operation


def _rounded(values: Any) -> Any:
    return np.round(values, 5).tolist()


Rounded = Annotated[list[float], BeforeValidator(_rounded)]
Gaps = Annotated[list[Known], BeforeValidator(list)]
Width = Annotated[float, Field(gt=0.05, lt=3)] | None


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
    wanted: Gaps
    rms: float = Field(description="Rms of the differences, over the width at rest.")
    largest: float
    force_n: float
    pulls: int = Field(description="Number of swatches that were computed.")
    messages: list[str]


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
        wanted=shaped.target,
    )


@click.argument("profile", type=click.Path(path_type=Path))
def _widths(profile: Path) -> dict[str, Any]:
    return {"width": _read(profile)}


@atlas_option
@design_option
def _command(
    request: ShapeRequest, context: Context, atlas: Path | None, out: Path | None
) -> ShapeResult:
    table = context.atlas(request.material, request.repeats, atlas)
    result = _shaped(request, table, context)
    write_design_of(result.chart, request.material, "Shape", out)
    return result


def _read(file: Path) -> list[float | None]:
    """The column ``width`` of a CSV; an empty field means any width."""
    try:
        with file.open(newline="", encoding="utf-8") as stream:
            names, *rows = csv.reader(stream)
        column = [name.strip() for name in names].index("width")
        values = [row[column].strip() if row else "" for row in rows]
        return [float(value) if value else None for value in values]
    except FileNotFoundError:
        raise InputError("profile", f"there is no file {file}.", "Check its name.") from None
    except (IndexError, ValueError):
        raise InputError(
            "profile", f"{file.name} is not a profile.", "Give a column `width` of numbers."
        ) from None


def _lines(r: ShapeResult) -> list[str]:
    bands = ", ".join(f"{b.lines} of {b.repeat}" for b in r.bands)
    head = (
        f"{size_in_words(r.columns, r.rows)}; widths {r.rms:.1%} off (rms), {r.largest:.1%} at "
        f"most; {r.force_n:.2f} N; from the first line: {bands}"
    )
    return [r.chart, head]


OPERATION = Operation(
    shape,
    tag="design",
    summary="A chart that takes a target outline when it is stretched",
    example={
        "material": "acrylic",
        "strain": 0.2,
        "across": 6,
        "width": [0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9],
    },
    job=True,
    command=Command(
        _lines,
        more="PROFILE is a CSV with a column `width`, stretched width over width at rest, one line "
        "across the pull after the other from the bottom (or the left); empty where any width "
        "will do.",
        names={"width": None},
        fields=_widths,
        run=_command,
    ),
)
