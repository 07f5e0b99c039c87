"""A law calibrated on a measured displacement field."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.fit.calibration import Calibration, ForceCurve
from knitcore.fit.calibration import calibrate as calibrated
from knitcore.fit.field_comparison import Edges, compare
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests
from knitcore.formats.read.law_files import LawFile, save_law
from knitcore.measure.stretch_test import stated_direction
from knitcore.measure.uniaxial_files import Marks, read_stretch_test

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Floats
from ...requests.charts import MaterialName
from ...requests.fabrics import LawResult, LawsRequest
from ...requests.fields import FieldRequest, FrameErrorResult, errors_table, load
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation


class CalibrateRequest(FieldRequest, LawsRequest):
    """The law to start from, and tests whose forces the law has to match."""

    material: MaterialName
    fabric: Fabric
    tests: list[UploadedFile] = Field(
        default_factory=list,
        max_length=2,
        description="Stretch tests: of the direction (forces), or course and wale (forces and "
        "start).",
    )


class CalibrateResult(LawResult):
    """The calibrated law; its shear modulus is calibrated, too."""

    kind: Literal["calibrate"] = "calibrate"
    parameters: dict[str, float]
    standard_errors: dict[str, float]
    frames: list[int] = Field(description="The frames that were fitted.")
    comparison: list[FrameErrorResult] = Field(
        description="Errors at all frames, with the edges moved as measured."
    )
    force_strain: Floats
    force_ratio: Floats = Field(description="Simulated force over measured force.")
    evaluations: int


def calibrate(request: CalibrateRequest, context: Context) -> CalibrateResult:
    """A law that fits a measured field, and forces if tests are given.

    Raises
    ------
    InputError
        If none of the tests is in the direction.
    """
    return _result(request, _calibration(request, context))


def _calibration(request: CalibrateRequest, context: Context) -> Calibration:
    field = request.chosen(load(request.field))
    law = context.material(request.material).law(request.fabric)
    forces = None
    with stored(request.tests) as paths:
        tests = _course_first(paths) if len(paths) == 2 else paths
        if len(tests) == 2:
            law = fit_tests(*tests, reduction=Reduction.UNIFORM).law
        if tests:
            chosen = tests[request.direction.axis] if len(tests) == 2 else tests[0]
            test = read_stretch_test(chosen, marks=Marks.CLAMPS)
            if stated_direction(test) not in (None, request.direction):
                raise InputError(
                    "tests",
                    f"{chosen.name} was not pulled {request.direction}-wise.",
                    "Give the test in the direction of the field.",
                )
            forces = ForceCurve.of_test(test, field.length / field.width)
    return calibrated(field, law, request.direction, forces=forces, cancelled=context.cancelled)


def _course_first(tests: list[Path]) -> list[Path]:
    """Two tests in the order course, wale; swapped if the files say so."""
    stated = [stated_direction(read_stretch_test(path, marks=Marks.CLAMPS)) for path in tests]
    if Direction.WALE is stated[0] or Direction.COURSE is stated[1]:
        return tests[::-1]
    return tests


def _result(request: CalibrateRequest, calibration: Calibration) -> CalibrateResult:
    """The result, with the errors at all frames, fitted or not."""
    field, direction = load(request.field), request.direction
    errors = compare(field, calibration.law, direction, edges=Edges.MEASURED)
    return CalibrateResult.of_law(
        calibration.law,
        parameters=calibration.parameters,
        standard_errors=calibration.standard_errors,
        frames=calibration.frames,
        comparison=errors.frames,
        force_strain=calibration.force_strain,
        force_ratio=calibration.force_ratio,
        evaluations=calibration.evaluations,
    )


@click.argument("more_tests", nargs=-1, metavar="", type=click.Path(path_type=Path))
@out_option("--out", required=True, help="LAW.json to write.")
def _command(
    request: CalibrateRequest, context: Context, out: Path, more_tests: tuple[Path, ...]
) -> CalibrateResult:
    if more_tests and not request.tests:
        raise InputError(
            "tests", f"{more_tests[0]} is unexpected.", "Put --tests before the names of the tests."
        )
    tests = [*request.tests, *map(UploadedFile.at, more_tests)]
    if len(tests) > 2:
        raise InputError("tests", f"{len(tests)} tests are too many.", "Give one per direction.")
    request = request.model_copy(update={"tests": tests})
    calibration = _calibration(request, context)
    numbers = ", ".join(str(number) for number in calibration.frames)
    source = (
        f"{request.material} {request.fabric}, calibrated {request.direction}-wise on "
        f"{request.field.name}, frames {numbers}"
    )
    shear = {n: error for n, error in calibration.standard_errors.items() if n == "shear_modulus"}
    save_law(LawFile(calibration.law, source, shear), out)
    return _result(request, calibration)


def _lines(r: CalibrateResult) -> list[str]:
    lines = [
        f"{name:20} {value:8.4f} ± {r.standard_errors[name]:.4f}"
        for name, value in r.parameters.items()
    ]
    lines += errors_table(r.comparison)
    if r.force_ratio:
        low, high = min(r.force_ratio), max(r.force_ratio)
        lines.append(f"simulated / measured force: {low:.2f} to {high:.2f}")
    return lines


OPERATION = Operation(
    calibrate,
    tag="displacement fields",
    summary="Shear modulus and couplings from a displacement field",
    example={
        "field": example_file("field.npz"),
        "direction": "wale",
        "material": "acrylic",
        "fabric": "garter",
    },
    job=True,
    command=Command(
        _lines,
        more="FIELD is a .npz file.",
        names={"frames": "--frame"},
        run=_command,
    ),
)
