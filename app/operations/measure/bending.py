"""Bending modulus of a yarn from photos."""

from typing import Literal

from pydantic import Field

from knitcore.measure.bending_modulus import measure_bending

from ...context import Context
from ...requests.base import RequestModel, ResultModel
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation

MAX_PHOTOS = 100


class BendingRequest(RequestModel):
    """Photos of hanging yarn, with the lengths and weight needed to read them."""

    images: list[UploadedFile] = Field(min_length=1, max_length=MAX_PHOTOS)
    linear_density_g_per_m: float = Field(
        description="Mass per length: weigh some metres; 0.5 g/m is 500 tex."
    )
    length_mm: list[float] | float | None = Field(
        None, description="Hanging length, clamp to free end; one for all photos or one per photo."
    )
    px_per_mm: float | None = Field(
        None, description="Scale of the photos, pixels per mm, if it is known."
    )


class BendingPhotoResult(ResultModel):
    """The result of one photo."""

    name: str
    bending_modulus_n_mm2: float
    length_mm: float
    px_per_mm: float
    yarn_width_mm: float
    rms_mm: float = Field(description="Distance between the traced line and the fitted elastica.")


class BendingResult(ResultModel):
    """Mean over photos; proportional to the linear density given."""

    kind: Literal["bending"] = "bending"
    bending_modulus_n_mm2: float
    standard_deviation: float | None = Field(
        description="Standard deviation of a single photo, N·mm²; null if there is only one."
    )
    standard_error: float | None = Field(description="Standard error of the mean, N·mm².")
    photos: list[BendingPhotoResult]
    notes: list[str]


def bending(request: BendingRequest, context: Context) -> BendingResult:
    """Traces each photo and fits the heavy elastica."""
    del context
    with stored(request.images) as paths:
        return BendingResult.of(request.pass_to(measure_bending, paths))


def _lines(r: BendingResult) -> list[str]:
    lines = [f"{'photo':24} {'B mN·mm²':>9} {'length mm':>10} {'px/mm':>7} {'rms mm':>7}"]
    lines += [
        f"{p.name:24} {1000 * p.bending_modulus_n_mm2:9.2f} {p.length_mm:10.1f} {p.px_per_mm:7.2f}"
        f" {p.rms_mm:7.2f}"
        for p in r.photos
    ]
    spread = "" if r.standard_deviation is None else f" ± {1000 * r.standard_deviation:.3g}"
    error = "" if r.standard_error is None else f" (mean ± {1000 * r.standard_error:.2g})"
    lines.append(f"bending modulus {1000 * r.bending_modulus_n_mm2:.4g}{spread} mN·mm²{error}")
    return lines


OPERATION = Operation(
    bending,
    path="/measure/bending",
    tag="measure",
    summary="Bending modulus from photos of hanging yarn",
    example={
        "images": [example_file("photo.png")],
        "linear_density_g_per_m": 0.5,
        "length_mm": 120.0,
    },
    job=True,
    command=Command(_lines, more="The yarn hangs from a horizontal clamp."),
)
