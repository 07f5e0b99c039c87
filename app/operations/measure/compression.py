"""Contact constants of a yarn from squeezing it."""

from pathlib import Path
from typing import Literal

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.measure.compression import (
    PROBE_WIDTH_MM,
    CompressionMean,
    average_compression,
    fit_compression,
)
from knitcore.measure.compression_files import read_compression

from ...context import Context
from ...requests.base import RequestModel, ResultModel
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation


class CompressionRequest(RequestModel):
    """Compression tests of yarns."""

    file: UploadedFile
    yarn: str | None = Field(
        None,
        max_length=80,
        description="Use only the samples of this yarn (sheets named yarn-number).",
    )
    diameter_mm: float | None = Field(
        None, description="Diameter of the yarn, if the file does not state it."
    )
    probe_width_mm: float = PROBE_WIDTH_MM


class CompressionSampleResult(ResultModel):
    """The result of one test, with the standard errors of its fit."""

    name: str
    yarn: str
    k_n_per_mm3: float
    k_error_n_per_mm3: float
    p: float
    p_error: float
    thickness_mm: float
    diameter_mm: float
    rms_n: float


class CompressionMeanResult(ResultModel, CompressionMean):
    """Mean over the samples of one yarn."""


class CompressionResult(ResultModel):
    """Constants of the contact law, per sample and mean."""

    kind: Literal["compression"] = "compression"
    k_n_per_mm3: float | None = Field(
        description="Mean of the yarn; null if there are several yarns, whose means are in `mean`."
    )
    p: float | None = Field(
        description="Mean exponent p of the yarn; null if there are several yarns."
    )
    mean: dict[str, CompressionMeanResult] = Field(description="Means by yarn.")
    samples: list[CompressionSampleResult]
    notes: list[str]


def compression(request: CompressionRequest, context: Context) -> CompressionResult:
    """k and p, per sample and mean."""
    return _command(request, context, ())


@click.argument("more_files", metavar="[FILE]...", nargs=-1, type=click.Path(path_type=Path))
def _command(
    request: CompressionRequest, context: Context, more_files: tuple[Path, ...]
) -> CompressionResult:
    """Fit the contact law to any number of files.

    Raises
    ------
    InputError
        If no test is of the yarn asked for, or one cannot be used.
    """
    del context
    with stored([request.file]) as paths:
        tests = [test for path in (*paths, *more_files) for test in read_compression(path)]
    known = ", ".join(dict.fromkeys(t.yarn for t in tests))
    if request.yarn is not None:
        tests = [test for test in tests if test.yarn == request.yarn.strip().lower()]
    if not tests:
        problem = f"{request.yarn!r} is not among the tests."
        raise InputError("yarn", problem, f"Use one of {known}.")
    samples = [request.pass_to(fit_compression, test) for test in tests]
    means = average_compression(samples)
    alone = means[0] if len(means) == 1 else None
    notes = [] if alone else [f"{known} have no common k and p; ask for one yarn to get one pair."]
    return CompressionResult(
        k_n_per_mm3=alone.k_n_per_mm3 if alone else None,
        p=alone.p if alone else None,
        mean={m.yarn: m for m in means},
        samples=samples,
        notes=notes,
    )


def _lines(r: CompressionResult) -> list[str]:
    lines = [f"{'sample':16} {'k mN/mm³':>9} {'p':>7}"]
    lines += [f"{s.name:16} {1000 * s.k_n_per_mm3:9.4g} {s.p:7.3f}" for s in r.samples]
    for m in r.mean.values():
        k_spread, p_spread = m.k_standard_deviation_n_per_mm3, m.p_standard_deviation
        k = "" if k_spread is None else f" ± {1000 * k_spread:.2g}"
        p = "" if p_spread is None else f" ± {p_spread:.2g}"
        lines.append(f"{m.yarn}: k {1000 * m.k_n_per_mm3:.4g}{k} mN/mm³, p {m.p:.3f}{p}")
    return lines


OPERATION = Operation(
    compression,
    path="/measure/compression",
    tag="measure",
    summary="Contact constants from compression tests",
    example={"file": example_file("my-yarn-1.csv"), "diameter_mm": 2.0},
    job=True,
    command=Command(_lines, more="Each FILE is an XLS, XLSX or CSV.", run=_command),
)
