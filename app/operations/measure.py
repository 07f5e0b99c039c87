"""Measuring a yarn: bending modulus from photos, compressibility from squeezing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from app.models.uploads import UploadedFile, stored
from knitcore.errors import InputError
from knitcore.measure.bending import measure_bending
from knitcore.measure.compression import (
    PROBE_WIDTH_MM,
    average_compression,
    fit_compression,
)
from knitcore.measure.compression_files import read_compression

MAXIMUM_PHOTOS = 100


class BendingOptions(BaseModel):
    """What a photo does not show."""

    model_config = ConfigDict(extra="forbid")

    linear_density_g_per_m: float = Field(description="0.5 g/m is 500 tex.")
    length_mm: list[float] | float | None = Field(
        None, description="Hanging length, one for all photos or one per photo."
    )
    px_per_mm: float | None = Field(None, description="Scale, if it is known.")


class BendingRequest(BendingOptions):
    """Photos of hanging yarn."""

    images: list[UploadedFile] = Field(min_length=1, max_length=MAXIMUM_PHOTOS)


class BendingPhotoResult(BaseModel):
    """What one photo gave."""

    name: str
    bending_modulus_n_mm2: float
    length_mm: float
    px_per_mm: float
    yarn_width_mm: float
    rms_mm: float = Field(description="Distance of the traced line from the elastica.")


class BendingResult(BaseModel):
    """Mean over photos; proportional to the linear density given."""

    bending_modulus_n_mm2: float
    standard_deviation: float | None = Field(description="Of one photo, N·mm²; None for one.")
    standard_error: float | None = Field(description="Of the mean, N·mm².")
    photos: list[BendingPhotoResult]
    notes: list[str]


class CompressionRequest(BaseModel):
    """Compression tests of yarns."""

    model_config = ConfigDict(extra="forbid")

    file: UploadedFile
    yarn: str | None = Field(None, max_length=80, description="Only the samples of this yarn.")
    diameter_mm: float | None = None
    probe_width_mm: float = PROBE_WIDTH_MM


class CompressionSampleResult(BaseModel):
    """What one test gave; the errors are those of the fit."""

    name: str
    yarn: str
    k_n_per_mm3: float
    k_error_n_per_mm3: float
    p: float
    p_error: float
    thickness_mm: float
    diameter_mm: float
    rms_n: float


class CompressionMeanResult(BaseModel):
    """Mean over the samples of one yarn."""

    yarn: str
    samples: int
    k_n_per_mm3: float
    k_standard_deviation_n_per_mm3: float | None
    p: float
    p_standard_deviation: float | None


class CompressionResult(BaseModel):
    """Constants of the contact law, per sample and mean."""

    k_n_per_mm3: float | None = Field(
        description="Mean of the yarn; null if there are several, which have one each in `mean`."
    )
    p: float | None = Field(description="The same.")
    mean: dict[str, CompressionMeanResult] = Field(description="By yarn.")
    samples: list[CompressionSampleResult]
    notes: list[str]


def run_bending(
    request: BendingRequest, *, cancelled: Callable[[], bool] | None = None
) -> BendingResult:
    """The measurement that a request asks for."""
    del cancelled
    with stored(request.images) as paths:
        return bending_of(paths, request)


def bending_of(paths: Sequence[Path], options: BendingOptions) -> BendingResult:
    """Bending modulus from photos."""
    found = measure_bending(
        paths,
        linear_density_g_per_m=options.linear_density_g_per_m,
        length_mm=options.length_mm,
        px_per_mm=options.px_per_mm,
    )
    return BendingResult(
        bending_modulus_n_mm2=found.bending_modulus_n_mm2,
        standard_deviation=found.standard_deviation,
        standard_error=found.standard_error,
        photos=[
            BendingPhotoResult(
                **{name: getattr(photo, name) for name in BendingPhotoResult.model_fields}
            )
            for photo in found.photos
        ],
        notes=list(found.notes),
    )


def run_compression(
    request: CompressionRequest, *, cancelled: Callable[[], bool] | None = None
) -> CompressionResult:
    """The measurement that a request asks for."""
    del cancelled
    with stored([request.file]) as paths:
        return compression_of(
            paths,
            yarn=request.yarn,
            diameter_mm=request.diameter_mm,
            probe_width_mm=request.probe_width_mm,
        )


def compression_of(
    paths: Sequence[Path],
    *,
    yarn: str | None = None,
    diameter_mm: float | None = None,
    probe_width_mm: float = PROBE_WIDTH_MM,
) -> CompressionResult:
    """k and p from the tests of one or more files.

    Raises
    ------
    InputError
        If no test is of the yarn asked for, or one cannot be used.
    """
    tests = [test for path in paths for test in read_compression(path)]
    known = ", ".join(dict.fromkeys(t.yarn for t in tests))
    if yarn is not None:
        tests = [test for test in tests if test.yarn == yarn.strip().lower()]
    if not tests:
        raise InputError("yarn", f"{yarn!r} is not among the tests.", f"Use one of {known}.")
    samples = [
        fit_compression(test, diameter_mm=diameter_mm, probe_width_mm=probe_width_mm)
        for test in tests
    ]
    means = [CompressionMeanResult(**asdict(m)) for m in average_compression(samples)]
    alone = means[0] if len(means) == 1 else None
    notes = [] if alone else [f"{known} have no common k and p; ask for one yarn to get one pair."]
    return CompressionResult(
        k_n_per_mm3=alone.k_n_per_mm3 if alone else None,
        p=alone.p if alone else None,
        mean={m.yarn: m for m in means},
        samples=[
            CompressionSampleResult(
                **{name: getattr(s, name) for name in CompressionSampleResult.model_fields}
            )
            for s in samples
        ],
        notes=notes,
    )
