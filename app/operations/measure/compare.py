"""A law compared with a measured displacement field."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Fabric
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel
from knitcore.fit.field_comparison import Edges
from knitcore.fit.field_comparison import compare as compared
from knitcore.formats.read.law_files import load_law
from knitcore.law.constitutive import ConstitutiveLaw

from ...context import Context
from ...requests.base import ResultModel
from ...requests.charts import MaterialName
from ...requests.fabrics import LawsRequest
from ...requests.fields import FieldRequest, FrameErrorResult, errors_table, load
from ...requests.uploads import UploadedFile, example_file, stored
from ..registry import Command, Operation


class CompareRequest(FieldRequest, LawsRequest):
    """A law, or a fabric of a material, and a field to compare it with."""

    material: MaterialName | None = None
    fabric: Fabric | None = Field(None, description="A fabric of the material.")
    law: UploadedFile | None = Field(
        None, description="A law file, LAW.json, in place of material and fabric."
    )
    edges: Edges = Edges.MEASURED
    model: EnergyModel = EnergyModel.FULL


class CompareResult(ResultModel):
    """Errors of each frame, in the order of the stretch."""

    kind: Literal["compare"] = "compare"
    frames: list[FrameErrorResult]
    edges: Edges
    model: EnergyModel
    messages: list[str]


def compare(request: CompareRequest, context: Context) -> CompareResult:
    """Errors of the displacements, frame by frame.

    Raises
    ------
    InputError
        If neither or both of a law and a material are given.
    """
    field = request.chosen(load(request.field))
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
    model = SheetModel(request.model)
    if request.law is not None and request.material is None:
        with stored([request.law]) as (path,):
            return load_law(path).law, model
    if request.law is not None:
        raise InputError("law", "material is given as well.", "Give one of the two.")
    if request.material is None:
        raise InputError("material", "is missing.", "Give a material and a fabric, or a law file.")
    if request.fabric is None:
        raise InputError("fabric", "is missing.", "Name the fabric of the material.")
    return context.material(request.material).law(request.fabric), model


def _lines(r: CompareResult) -> list[str]:
    return [f"{r.model} model, {r.edges} edges", *errors_table(r.frames)]


OPERATION = Operation(
    compare,
    tag="displacement fields",
    summary="A law compared with a measured displacement field",
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
    ),
)
