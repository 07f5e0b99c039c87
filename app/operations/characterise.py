"""Characterise a yarn: what the yarn level says of its pure fabrics, as one table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from app.results.own_materials import find_material
from knitcore.batch import BatchProgress
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.materials import Material
from knitcore.materials.document import MaterialDocument
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.relax import Branch
from knitcore.yarnlevel.yarn import YarnModel
from knitcore.yarnlibrary.lawfit import MAX_STRESS_N_PER_MM
from knitcore.yarnlibrary.yarn_material import material_of
from knitcore.yarnlibrary.yarn_table import (
    TENSIONS,
    YarnPlan,
    YarnRow,
    YarnTable,
    characterise_yarns,
    plan_for_material,
    plan_for_yarn,
)

Cancelled = Callable[[], bool]
Positive = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)]
MAX_SETTINGS = 24


class YarnInput(BaseModel):
    """A yarn by its parameters."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field(pattern=r"^[a-z0-9][a-z0-9._-]{0,63}$", examples=["my-merino"])
    bending_modulus_n_mm2: Positive
    contact_stiffness_n_per_mm3: Positive
    contact_exponent: Positive
    radius_mm: Positive
    core_radius_mm: float = Field(ge=0, le=100, allow_inf_nan=False)

    def model(self) -> YarnModel:
        """The yarn of the model."""
        return YarnModel(**{f.name: getattr(self, f.name) for f in fields(YarnModel)})


class CharacteriseOptions(BaseModel):
    """Which stitches of a yarn, and which model."""

    model_config = ConfigDict(extra="forbid")

    fabrics: list[Fabric] = Field(default_factory=lambda: list(Fabric), min_length=1)
    loop_lengths_mm: list[Positive] = Field(
        default_factory=list,
        max_length=MAX_SETTINGS,
        description="Yarn per stitch, for all fabrics; `tensions` is not used then.",
    )
    tensions: list[Positive] = Field(
        default_factory=lambda: list(TENSIONS),
        min_length=1,
        max_length=MAX_SETTINGS,
        description="Loop lengths as parts of the material's own.",
    )
    branch: Branch = Branch.MIRRORED
    convention: Convention = Convention.PUBLISHED
    max_stress_n_per_mm: float = Field(
        MAX_STRESS_N_PER_MM, gt=0.001, le=100, allow_inf_nan=False, description="Laws end here."
    )


class CharacteriseRequest(CharacteriseOptions):
    """A yarn, of a material or by its parameters."""

    material: str | None = Field(None, max_length=80, examples=["acrylic"])
    yarn: YarnInput | None = None

    @model_validator(mode="after")
    def _one_yarn(self) -> Self:
        if (self.material is None) == (self.yarn is None):
            raise ValueError("give either a material or a yarn")
        return self


class FabricCurve(BaseModel):
    """A stretch, free across."""

    strain: list[float]
    transverse_strain: list[float]
    stress_n_per_mm: list[float]
    bending_share: list[float]
    contact_share: list[float]
    contact_overtakes_at_strain: float | None = Field(
        description="Where contact first holds half of the energy."
    )
    jumps: list[int]
    notes: list[str]


class FabricRow(BaseModel):
    """A pure fabric at one stitch setting: rest, law with its range, shares of the energy."""

    fabric: Fabric
    setting: str
    loop_length_mm: float
    stitch_course_mm: float | None
    stitch_wale_mm: float | None
    stitches_per_cm2: float | None
    energy_n_mm: float | None
    bending_share: float | None
    contact_share: float | None
    contact_overtakes_at_strain_course: float | None
    jumps_course: int | None
    contact_overtakes_at_strain_wale: float | None
    jumps_wale: int | None
    modulus_course_n_per_mm: float | None
    modulus_wale_n_per_mm: float | None
    poisson_yx: float | None
    poisson_xy: float | None
    alpha_xx: float | None
    alpha_yy: float | None
    beta_xx_n_per_mm: float | None
    beta_yy_n_per_mm: float | None
    max_stress_n_per_mm: float | None
    largest_strain_course: float | None
    largest_strain_wale: float | None
    rms_course_n_per_mm: float | None
    rms_wale_n_per_mm: float | None
    converged: bool | None
    remark: str = Field(description="Why something is missing, or what to know.")


class CharacterisedFabric(FabricRow):
    """With its stress-strain curves."""

    curves: dict[Direction, FabricCurve]


class CharacteriseResult(BaseModel):
    """The table of a yarn; `material` holds its laws at the reference setting."""

    identifier: str
    provenance: str
    estimated: bool = Field(description="Whether contact data were estimated.")
    branch: Branch
    convention: Convention
    reference: str = Field(description="The setting that `material` was made at.")
    rows: list[CharacterisedFabric]
    material: MaterialDocument | None = Field(
        description="A material file; null if no fabric has a law at the reference."
    )
    materials: dict[str, MaterialDocument] = Field(description="The same at every setting.")


def run_characterise(
    request: CharacteriseRequest,
    *,
    cancelled: Cancelled,
    progress: Callable[[int, int], None] | None = None,
) -> CharacteriseResult:
    """Characterise one yarn in this process, for the service."""
    found = find_material(request.material) if request.material is not None else None
    (result,) = characterise(
        [plan_of(found or request.yarn, request)],
        workers=1,
        on_progress=None if progress is None else lambda told: progress(told.done, told.total),
        should_stop=cancelled,
    )
    return result


def characterise(
    plans: list[YarnPlan],
    *,
    scheduler: str | None = None,
    workers: int | None = None,
    keep: Path | None = None,
    on_progress: Callable[[BatchProgress], None] | None = None,
    should_stop: Cancelled | None = None,
) -> list[CharacteriseResult]:
    """Characterise any number of yarns as one batch."""
    tables = characterise_yarns(
        plans, scheduler=scheduler, workers=workers, keep=keep, on_progress=on_progress,
        should_stop=should_stop,
    )  # fmt: skip
    return [_result(table) for table in tables]


def plan_of(yarn: Material | YarnInput | None, options: CharacteriseOptions) -> YarnPlan:
    """What to compute of a yarn.

    Raises
    ------
    InputError
        If there is none, or it does not go with the options.
    """
    if isinstance(yarn, Material):
        return plan_for_material(
            yarn, fabrics=options.fabrics, loop_lengths_mm=options.loop_lengths_mm,
            tensions=options.tensions, branch=options.branch, convention=options.convention,
            max_stress_n_per_mm=options.max_stress_n_per_mm,
        )  # fmt: skip
    if yarn is None:
        raise InputError("material", "is missing.", "Name a material, or give a yarn.")
    return plan_for_yarn(
        yarn.name, yarn.model(), options.loop_lengths_mm, fabrics=options.fabrics,
        branch=options.branch, convention=options.convention,
        max_stress_n_per_mm=options.max_stress_n_per_mm,
    )  # fmt: skip


def _result(table: YarnTable) -> CharacteriseResult:
    plan = table.plan
    materials = {}
    for setting in plan.settings:
        if any(row.law is not None for row in table.at(setting.name).values()):
            made = material_of(table, setting.name)
            materials[setting.name] = MaterialDocument.from_material(made)
    reference = plan.settings[plan.reference].name
    return CharacteriseResult(
        identifier=plan.identifier,
        provenance=plan.provenance,
        estimated=plan.estimated,
        branch=plan.branch,
        convention=plan.convention,
        reference=reference,
        rows=[_row(row) for row in table.rows],
        material=materials.get(reference),
        materials=materials,
    )


def _row(row: YarnRow) -> CharacterisedFabric:
    return CharacterisedFabric.model_validate(
        {**row.flat(), "curves": row.document.get("curves", {})}
    )
