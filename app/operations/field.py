"""Measured displacement fields: comparing a law with one, and calibrating a law on one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from app.models.uploads import UploadedFile, stored
from app.operations.materials import LawResult
from app.results.own_materials import find_material
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.formats.calibrated_files import load_calibrated, save_calibrated
from knitcore.formats.law_files import LawFile
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.measure.stretch_test import stated_direction
from knitcore.measure.uniaxial import Reduction, fit_files
from knitcore.measure.uniaxial_files import Gauge, read_stretch_test
from knitcore.swatch.calibration import Calibration, ForceCurve, calibrate
from knitcore.swatch.comparison import Comparison, Edges, compare
from knitcore.swatch.measured import MeasuredField, load_field
from knitcore.swatch.models import EnergyModel, SheetModel


class FieldRequest(BaseModel):
    """A displacement field and the fabric in it."""

    model_config = ConfigDict(extra="forbid")

    field: UploadedFile = Field(description=".npz: displacement (frames, 2, rows, columns), frame.")
    direction: Direction = Field(description="In which the fabric was pulled.")
    material: str | None = Field(None, max_length=80)
    fabric: Fabric | None = None
    frames: list[int] | None = Field(None, description="Pictures to use; all otherwise.")


class CompareRequest(FieldRequest):
    """A law, or a fabric of a material, beside a field."""

    law: UploadedFile | None = Field(None, description="LAW.json, instead of material and fabric.")
    edges: Edges = Edges.MEASURED
    model: EnergyModel | None = Field(None, description="full, or what the law file says.")


class CalibrateRequest(FieldRequest):
    """Where to start from, and tests whose forces the law should keep."""

    material: str = Field(max_length=80)
    fabric: Fabric
    tests: list[UploadedFile] = Field(
        default_factory=list, max_length=2, description="One in the direction, or one in each."
    )


class FrameErrorResult(BaseModel):
    """Simulated minus measured displacement of one picture, in percent of the width."""

    frame: int
    applied_stretch: float
    ux_rms_percent_width: float
    ux_max_percent_width: float
    uy_rms_percent_width: float
    uy_max_percent_width: float


class CompareResult(BaseModel):
    """Errors per picture, in the order of the stretch."""

    frames: list[FrameErrorResult]
    edges: Edges
    model: EnergyModel
    messages: list[str]

    @classmethod
    def of(cls, found: Comparison, edges: Edges, model: SheetModel) -> CompareResult:
        """From the library's comparison."""
        return cls(
            frames=[FrameErrorResult(**vars(frame)) for frame in found.frames],
            edges=edges,
            model=model.energy,
            messages=[found.problem] if found.problem else [],
        )


class CalibrateResult(LawResult):
    """The calibrated law; its shear modulus is no assumption any more."""

    stiffening_coupling: float
    parameters: dict[str, float]
    standard_errors: dict[str, float]
    frames: list[int] = Field(description="Pictures that were used.")
    comparison: list[FrameErrorResult] = Field(description="All pictures, measured edges.")
    force_strain: list[float]
    force_ratio: list[float] = Field(description="Simulated over measured force.")
    evaluations: int


def run_compare(request: CompareRequest, *, cancelled: Callable[[], bool]) -> CompareResult:
    """The comparison that a REST request asks for."""
    del cancelled  # a few tenths of a second
    files = [request.field] if request.law is None else [request.field, request.law]
    with stored(files) as paths:
        field = chosen_frames(load_field(paths[0]), request.frames)
        law, model = law_and_model(
            paths[1] if request.law is not None else None,
            request.material,
            request.fabric,
            request.model,
        )
        return compare_field(field, law, request.direction, request.edges, model)


def run_calibrate(request: CalibrateRequest, *, cancelled: Callable[[], bool]) -> CalibrateResult:
    """The calibration that a REST request asks for."""
    with stored([request.field, *request.tests]) as (path, *tests):
        field = load_field(path)
        found = calibrate_field(
            chosen_frames(field, request.frames),
            find_material(request.material).law(request.fabric),
            request.direction,
            tests,
            cancelled=cancelled,
        )
    return calibrate_result(field, found, request.direction)


def chosen_frames(field: MeasuredField, numbers: Sequence[int] | None) -> MeasuredField:
    """Some pictures of a field, or all."""
    return field if not numbers else field.only(set(numbers))


def law_and_model(
    law: Path | None,
    material: str | None,
    fabric: Fabric | None,
    model: EnergyModel | None,
) -> tuple[ConstitutiveLaw, SheetModel]:
    """The law of a file, or of a fabric of a library material; a model overrules the file's.

    Raises
    ------
    InputError
        If neither or both are given.
    """
    if (law is None) == (material is None):
        raise InputError(
            "law", "give either a law file or a material.", "Use --law, or --material and --fabric."
        )
    if law is not None:
        file, stored_model = load_calibrated(law)
        overruled = model is not None and model is not stored_model.energy
        return file.law, SheetModel(model) if overruled and model else stored_model
    if fabric is None or material is None:
        raise InputError("fabric", "is missing.", "Name the fabric of the material.")
    return find_material(material).law(fabric), SheetModel(model or EnergyModel.FULL)


def compare_field(
    field: MeasuredField,
    law: ConstitutiveLaw,
    direction: Direction,
    edges: Edges,
    model: SheetModel,
) -> CompareResult:
    """The comparison of a law with a field."""
    return CompareResult.of(compare(field, law, direction, edges=edges, model=model), edges, model)


def calibrate_field(
    field: MeasuredField,
    law: ConstitutiveLaw,
    direction: Direction,
    tests: Sequence[Path],
    *,
    cancelled: Callable[[], bool] | None = None,
) -> Calibration:
    """Calibrate on a field; one test gives forces in the direction, two also a law to start from.

    Raises
    ------
    InputError
        If there are more than two tests, or none is in the direction.
    """
    if not tests:
        return calibrate(field, law, direction, cancelled=cancelled)
    if len(tests) > 2:
        raise InputError("tests", f"{len(tests)} are too many.", "Give one per direction.")
    ordered = list(tests)
    if len(ordered) == 2:
        ordered = _course_first(ordered)
        law = fit_files(ordered[0], ordered[1], reduction=Reduction.RECOMMENDED).law
    chosen = ordered[direction.axis] if len(ordered) == 2 else ordered[0]
    test = read_stretch_test(chosen, gauge=Gauge.CLAMPS)
    if stated_direction(test) not in (None, direction):
        raise InputError(
            "tests",
            f"{chosen.name} says that it was not pulled {direction}-wise.",
            "Give the test in the direction of the field.",
        )
    forces = ForceCurve.of_test(test, field.length / field.width)
    return calibrate(field, law, direction, forces=forces, cancelled=cancelled)


def calibrate_result(
    field: MeasuredField, found: Calibration, direction: Direction
) -> CalibrateResult:
    """The numbers of a calibration, with the errors of all pictures, used or not."""
    errors = compare(field, found.law, direction, edges=Edges.MEASURED, model=found.model)
    return CalibrateResult(
        **LawResult.of(found.law).model_dump(),
        stiffening_coupling=found.model.stiffening_coupling,
        parameters=found.parameters,
        standard_errors=found.standard_errors,
        frames=list(found.frames),
        comparison=[FrameErrorResult(**vars(frame)) for frame in errors.frames],
        force_strain=found.force_strain.tolist(),
        force_ratio=found.force_ratio.tolist(),
        evaluations=found.evaluations,
    )


def save_calibration(found: Calibration, source: str, path: Path) -> None:
    """Write the calibrated law file."""
    errors = {
        name: error for name, error in found.standard_errors.items() if name == "shear_modulus"
    }
    save_calibrated(LawFile(found.law, source, errors), found.model, path)


def _course_first(tests: list[Path]) -> list[Path]:
    """Two tests in the order course, wale; swapped if the files say so."""
    stated = [stated_direction(read_stretch_test(path, gauge=Gauge.CLAMPS)) for path in tests]
    if Direction.WALE is stated[0] or Direction.COURSE is stated[1]:
        return tests[::-1]
    return tests
