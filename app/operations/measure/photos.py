"""Points of a stretch curve from photos of a hanging swatch, and the sheet that gives the scale."""

import base64
import json
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from knitcore.chart.fabric import Direction, Fabric
from knitcore.formats.write.drawn_page import to_pdf, to_svg
from knitcore.formats.write.marks_sheet import TITLE, marks_sheet
from knitcore.measure.centreline import load_grey
from knitcore.measure.photos.hanging_swatch import (
    HangingSwatch,
    PhotoReading,
    Swatch,
    SwatchPhoto,
    read_hanging,
)

from ...cli.options import out_option
from ...context import Context
from ...requests.base import NoRequest, RequestModel, ResultModel
from ...requests.stretch_points import Gauge, PointModel
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation

MAX_PHOTOS = 4


class PhotosRequest(RequestModel):
    """Photos of one swatch that is pulled down by weights, before the sheet of marks."""

    images: list[UploadedFile] = Field(min_length=1, max_length=MAX_PHOTOS)
    loads_g: list[Annotated[float, Field(ge=0, le=20_000)]] = Field(
        min_length=1,
        max_length=MAX_PHOTOS,
        description="Weight on the swatch in each photo, with its clamp, in grams; 0 without.",
    )
    fabric: Fabric = Field(description="Fabric of the swatch, its face side seen.")
    direction: Direction = Field(
        description="Direction that is pulled down: course if the rows hang down."
    )
    stitches_per_10_cm: Gauge
    rows_per_10_cm: Gauge
    clamped_width_mm: float = Field(ge=10, le=1000, description="Width that the clamps hold.")
    swatch_weight_g: float = Field(0.0, ge=0, le=1000, description="Weight of the swatch.")
    coin_mm: float | None = Field(
        None, ge=10, le=60, description="Diameter of a coin beside the swatch, without the sheet."
    )

    @model_validator(mode="after")
    def _one_load_each(self) -> "PhotosRequest":
        if len(self.loads_g) != len(self.images):
            raise ValueError(f"give {len(self.images)} loads_g, one for each photo")
        return self


class PhotoResult(ResultModel):
    """Stitches in a photo, and its scale; sizes with standard deviations."""

    name: str
    load_g: float
    scale: Literal["sheet", "coin"]
    px_per_mm: float
    tilt_deg: float
    blur_px: float
    scale_error: float = Field(description="Relative error of lengths, of the tilt.")
    stitch_course_mm: float
    stitch_course_sd_mm: float
    stitch_wale_mm: float
    stitch_wale_sd_mm: float
    periodicity: float = Field(description="Likeness of neighbouring stitches, at most 1.")


class PhotosResult(ResultModel):
    """Points by increasing load, and what each photo shows."""

    kind: Literal["photos"] = "photos"
    points: list[PointModel]
    photos: list[PhotoResult]
    notes: list[str]


def photos(request: PhotosRequest, context: Context) -> PhotosResult:
    """The scale comes from the sheet of marks or a coin, strains from the spacing of the stitches.

    Raises
    ------
    InputError
        Naming the photo that cannot serve, the reason and the remedy.
    """
    del context
    swatch = Swatch(
        request.fabric,
        request.direction,
        request.stitches_per_10_cm,
        request.rows_per_10_cm,
        request.clamped_width_mm,
        request.swatch_weight_g,
    )
    with stored(request.images) as paths:
        pictures = [
            SwatchPhoto(image.name, load_grey(path), load)
            for image, path, load in zip(request.images, paths, request.loads_g, strict=True)
        ]
    return _result(read_hanging(pictures, swatch, coin_mm=request.coin_mm))


def _result(hanging: HangingSwatch) -> PhotosResult:
    return PhotosResult(
        points=[PointModel(**vars(point)) for point in hanging.points],
        photos=[_photo(reading) for reading in hanging.photos],
        notes=list(hanging.notes),
    )


def _photo(reading: PhotoReading) -> PhotoResult:
    scale, spacing = reading.scale, reading.spacing
    return PhotoResult.of(
        scale,
        name=reading.name,
        load_g=reading.load_g,
        scale=scale.source,
        scale_error=scale.relative_error,
        stitch_course_mm=spacing.course_mm,
        stitch_course_sd_mm=spacing.course_sd_mm,
        stitch_wale_mm=spacing.wale_mm,
        stitch_wale_sd_mm=spacing.wale_sd_mm,
        periodicity=spacing.periodicity,
    )


@out_option("--out", help="Write the points to POINTS.json, for `knitcore measure swatch`.")
def _command(request: PhotosRequest, context: Context, out: Path | None) -> PhotosResult:
    result = photos(request, context)
    if out is not None:
        content = [point.model_dump(mode="json") for point in result.points]
        out.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    return result


def _lines(r: PhotosResult) -> list[str]:
    lines = [f"{'photo':20} {'load g':>7} {'tilt':>5} {'blur px':>8} {'stitch mm':>24}"]
    lines += [
        f"{p.name:20} {p.load_g:7g} {p.tilt_deg:4.0f}° {p.blur_px:8.1f}"
        f"   {p.stitch_course_mm:.3f} ± {p.stitch_course_sd_mm:.3f}"
        f" × {p.stitch_wale_mm:.3f} ± {p.stitch_wale_sd_mm:.3f}"
        for p in r.photos
    ]
    lines += [
        f"{p.fabric} {p.direction}-wise at {p.force_n_per_mm:.4f} N/mm: strain"
        f" {p.strain_along:.3f} ± {p.strain_along_sd:.3f},"
        f" across {p.strain_across:+.3f} ± {p.strain_across_sd:.3f}"
        for p in r.points
    ]
    return lines


OPERATION = Operation(
    photos,
    path="/measure/photos",
    tag="measure",
    summary="Points of a stretch curve from photos of a hanging swatch",
    example={
        "images": [example_file("swatch-rest.jpg"), example_file("swatch-500g.jpg")],
        "loads_g": [0, 500],
        "fabric": "stockinette",
        "direction": "wale",
        "stitches_per_10_cm": 20.0,
        "rows_per_10_cm": 28.0,
        "clamped_width_mm": 110.0,
        "swatch_weight_g": 8.0,
    },
    job=True,
    command=Command(
        _lines,
        more="The swatch hangs before the sheet of `knitcore measure marks`.",
        names={"loads_g": "--load-g"},
        run=_command,
    ),
)


class MarksResult(ResultModel):
    """The sheet as a file inside JSON."""

    name: str
    media_type: str
    content: str = Field(description="The file, base64.")


class MarksFacts(ResultModel):
    """The written sheet."""

    kind: str
    bytes: int


def marks(_: NoRequest, __: Context) -> MarksResult:
    """A sheet of A4 with four marks, as PDF: photos of a swatch before it have scale and tilt."""
    content = base64.b64encode(to_pdf([marks_sheet()], TITLE)).decode()
    return MarksResult(name="knitcore-marks.pdf", media_type="application/pdf", content=content)


@out_option(
    "-o", "--out", suffixes=(".pdf", ".svg"), required=True, help="FILE.pdf or FILE.svg to write."
)
def _marks_command(request: NoRequest, context: Context, out: Path) -> MarksFacts:
    del request, context
    as_svg = out.suffix.lower() == ".svg"
    content = to_svg(marks_sheet(), TITLE).encode() if as_svg else to_pdf([marks_sheet()], TITLE)
    out.write_bytes(content)
    return MarksFacts(kind="SVG" if as_svg else "PDF", bytes=len(content))


MARKS = Operation(
    marks,
    path="/measure/marks",
    tag="measure",
    summary="A sheet of marks for photos of a swatch",
    method="GET",
    command=Command(lambda r: [f"{r.bytes} bytes of {r.kind}: print at 100 %"], run=_marks_command),
)
