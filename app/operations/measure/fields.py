"""Measured displacement fields: a law compared with one, and calibrated on one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel
from knitcore.fit.calibration import Calibration, ForceCurve
from knitcore.fit.calibration import calibrate as calibrated
from knitcore.fit.field_comparison import Edges, FrameError
from knitcore.fit.field_comparison import compare as compared
from knitcore.fit.measured_field import MeasuredField, load_field
from knitcore.fit.pull_fit import Reduction
from knitcore.fit.strip_fit import fit_tests
from knitcore.formats.read.law_files import LawFile, load_law, save_law
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.measure.stretch_test import stated_direction
from knitcore.measure.uniaxial_files import Marks, read_stretch_test

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Floats, RequestModel, ResultModel
from ...requests.charts import MaterialName
from ...requests.fabrics import LawResult, LawsRequest, law_fields
from ...requests.faults import CheckedBy
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation

EXAMPLE = {
    "field": example_file("field.npz"),
    "direction": "wale",
    "material": "acrylic",
    "fabric": "garter",
}


def _load(file: UploadedFile) -> MeasuredField:
    with stored([file]) as (path,):
        return load_field(path)


class FieldRequest(RequestModel):
    """A displacement field and how the fabric in it was pulled."""

    field: Annotated[UploadedFile, CheckedBy(lambda file, _: _load(file))] = Field(
        description=".npz: displacement (frames, 2, rows, columns), frame."
    )
    direction: Direction = Field(description="Direction in which the fabric was pulled.")
    frames: list[int] | None = Field(None, description="Frames to use; all by default.")

    def chosen(self) -> MeasuredField:
        """The field, with the frames that the request selects."""
        field = _load(self.field)
        return field.only(set(self.frames)) if self.frames else field


class FrameErrorResult(ResultModel, FrameError):  # noqa: N818 - nothing that is raised
    """Simulated minus measured displacement at one frame, in per cent of the width."""


class CompareRequest(FieldRequest, LawsRequest):
    """A law, or a fabric of a material, and a field to compare it with."""

    material: MaterialName | None = None
    fabric: Fabric | None = Field(None, description="A fabric of the material.")
    law: UploadedFile | None = Field(
        None, description="A law file, LAW.json, in place of material and fabric."
    )
    edges: Edges = Edges.MEASURED
    model: EnergyModel = EnergyModel.FULL

    def check_parts(self, context: Context) -> None:
        """Refuse anything but one law."""
        del context
        if self.law is not None:
            if self.material is not None:
                raise InputError("law", "material is given as well.", "Give one of the two.")
        elif self.material is None:
            remedy = "Give a material and a fabric, or a law file."
            raise InputError("material", "is missing.", remedy)
        elif self.fabric is None:
            raise InputError("fabric", "is missing.", "Name the fabric of the material.")


class CompareResult(ResultModel):
    """Errors of each frame, in the order of the stretch."""

    kind: Literal["compare"] = "compare"
    frames: list[FrameErrorResult]
    edges: Edges
    model: EnergyModel
    messages: list[str]


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


def compare(request: CompareRequest, context: Context) -> CompareResult:
    """Errors of the displacements, frame by frame.

    Raises
    ------
    InputError
        If neither or both of a law and a material are given.
    """
    field = request.chosen()
    law, model = _law_and_model(request, context)
    comparison = request.pass_to(compared, field, law, model=model)
    return CompareResult.of(
        comparison,
        edges=request.edges,
        model=model.energy,
        messages=[comparison.problem] if comparison.problem else [],
    )


def _law_and_model(request: CompareRequest, context: Context) -> tuple[ConstitutiveLaw, SheetModel]:
    """The law of a file, or of a fabric of a material, and the model."""
    request.check_parts(context)
    model = SheetModel(request.model)
    if request.material is not None and request.fabric is not None:
        return context.material(request.material).law(request.fabric), model
    files = [] if request.law is None else [request.law]
    with stored(files) as (path,):
        return load_law(path).law, model


def calibrate(request: CalibrateRequest, context: Context) -> CalibrateResult:
    """A law that fits a measured field, and forces if tests are given.

    Raises
    ------
    InputError
        If none of the tests is in the direction.
    """
    return _result(request, _calibration(request, context))


def _calibration(request: CalibrateRequest, context: Context) -> Calibration:
    field = request.chosen()
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
    errors = compared(
        _load(request.field), calibration.law, request.direction, edges=Edges.MEASURED
    )
    return CalibrateResult.of(
        calibration, **law_fields(calibration.law, LawResult), comparison=errors.frames
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


def _table(frames: list[FrameErrorResult]) -> list[str]:
    """Lines of a table, in per cent of the width."""
    head = f"{'frame':>6} {'stretch':>8} {'ux rms':>7} {'ux max':>7} {'uy rms':>7} {'uy max':>7}"
    return [
        head + "   (% of width)",
        *(
            f"{f.frame:6d} {f.applied_stretch:8.3f} {f.ux_rms_percent_width:7.2f} "
            f"{f.ux_max_percent_width:7.2f} {f.uy_rms_percent_width:7.2f} "
            f"{f.uy_max_percent_width:7.2f}"
            for f in frames
        ),
    ]


def _compare_lines(r: CompareResult) -> list[str]:
    return [f"{r.model} model, {r.edges} edges", *_table(r.frames)]


def _calibrate_lines(r: CalibrateResult) -> list[str]:
    lines = [
        f"{name:20} {value:8.4f} ± {r.standard_errors[name]:.4f}"
        for name, value in r.parameters.items()
    ]
    lines += _table(r.comparison)
    if r.force_ratio:
        low, high = min(r.force_ratio), max(r.force_ratio)
        lines.append(f"simulated / measured force: {low:.2f} to {high:.2f}")
    return lines


COMPARE = Operation(
    compare,
    tag="displacement fields",
    summary="A law compared with a measured displacement field",
    example=EXAMPLE,
    job=True,
    command=Command(_compare_lines, more="FIELD is a .npz file.", names={"frames": "--frame"}),
)
CALIBRATE = Operation(
    calibrate,
    tag="displacement fields",
    summary="Shear modulus and couplings from a displacement field",
    example=EXAMPLE,
    job=True,
    command=Command(
        _calibrate_lines, more="FIELD is a .npz file.", names={"frames": "--frame"}, run=_command
    ),
)
