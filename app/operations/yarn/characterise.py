"""Characterise a yarn: its pure fabrics at the yarn level, as one table."""

import shutil
from pathlib import Path
from typing import Any, Literal, Self

import click
from pydantic import Field, RootModel, model_validator

from knitcore.base.batch import BatchProgress
from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials import Material
from knitcore.materials.material_document import MaterialDocument
from knitcore.materials.material_files import save_material_file
from knitcore.yarn.library.law_of_stretches import MAX_STRESS_N_PER_MM
from knitcore.yarn.library.yarn_material import material_of
from knitcore.yarn.library.yarn_table import (
    TENSIONS,
    YarnPlan,
    YarnTable,
    characterise_yarns,
    plan_for_material,
    plan_for_yarn,
)
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.yarn_model import YarnModel
from knitcore.yarn.study.relax import Branch

from ...cli.options import write_table
from ...context import Context
from ...requests.base import Positive, RequestModel, ResultModel
from ...requests.charts import MaterialName
from ..registry import Command, Operation

MAX_SETTINGS = 24
QUANTITIES = ("strain", "transverse_strain", "stress_n_per_mm", "bending_share", "contact_share")
"""Quantities of each point of a curve."""
FINISHED = "finished"
"""Folder of finished stitches inside the results folder, from which a stopped batch continues."""


class YarnInput(RequestModel):
    """A yarn by its parameters."""

    name: str = Field(
        pattern=r"^[a-z0-9][a-z0-9._-]{0,63}$",
        description="Name of a yarn that is given by the five numbers below.",
        examples=["my-merino"],
    )
    bending_modulus_n_mm2: Positive = Field(description="B of the yarn.")
    contact_stiffness_n_per_mm3: Positive = Field(description="k of its contact law.")
    contact_exponent: Positive = Field(description="p of its contact law.")
    radius_mm: Positive = Field(description="Outer radius.")
    core_radius_mm: float = Field(ge=0, le=100, description="Core radius.")


class CharacteriseOptions(RequestModel):
    """The stitches of a yarn to compute, and the model to use."""

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
        MAX_STRESS_N_PER_MM, gt=0.001, le=100, description="Largest stress of the fitted laws."
    )


class CharacteriseRequest(CharacteriseOptions):
    """A yarn, of a material or by its parameters."""

    material: MaterialName | None = None
    yarn: YarnInput | None = None

    @model_validator(mode="after")
    def _one_yarn(self) -> Self:
        if self.material is None and self.yarn is None:
            raise ValueError("material and yarn are missing; give one of them")
        if self.material is not None and self.yarn is not None:
            raise ValueError("material and yarn are both given; give one of them")
        return self

    def used(self, context: Context) -> Material | YarnInput | None:
        """The yarn that is characterised."""
        return self.yarn if self.material is None else context.material(self.material)

    def check_parts(self, context: Context) -> None:
        """Refuse options that do not apply to the yarn."""
        _plan(self.used(context), self)


class YarnsRequest(CharacteriseOptions):
    """Yarns of the command line, characterised together."""

    materials: list[str]
    yarn: YarnInput | None = None


class FabricCurve(ResultModel):
    """A stretch, free across."""

    strain: list[float]
    transverse_strain: list[float]
    stress_n_per_mm: list[float]
    bending_share: list[float]
    contact_share: list[float]
    contact_overtakes_at_strain: float | None = Field(
        description="Strain at which contact first holds half of the energy."
    )
    jumps: list[int]
    notes: list[str]


class FabricRow(ResultModel):
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
    remark: str = Field(description="Cautions, and why anything is missing.")


class CharacterisedFabric(FabricRow):
    """A pure fabric at one stitch setting, with its stress-strain curves."""

    curves: dict[Direction, FabricCurve]


class CharacteriseResult(ResultModel):
    """The table of a yarn; `material` holds its laws at the reference setting."""

    kind: Literal["characterise"] = "characterise"
    identifier: str
    provenance: str
    estimated: bool = Field(description="True if contact data were estimated.")
    branch: Branch
    convention: Convention
    reference: str = Field(description="The setting that `material` was made at.")
    rows: list[CharacterisedFabric]
    material: MaterialDocument | None = Field(
        description="A material file; null if no fabric has a law at the reference."
    )
    materials: dict[str, MaterialDocument] = Field(
        description="A material file for every setting, by its name."
    )


class YarnsResult(RootModel[list[CharacteriseResult]]):
    """The tables of several yarns."""


def characterise(request: CharacteriseRequest, context: Context) -> CharacteriseResult:
    """Every fabric is relaxed at every loop length and stretched both ways."""
    (table,) = characterise_yarns(
        [_plan(request.used(context), request)],
        workers=1,
        progress=lambda at: context.progress(at.done, at.total),
        cancelled=context.cancelled,
    )
    return _result(table)


def _plan(yarn: Material | YarnInput | None, options: CharacteriseOptions) -> YarnPlan:
    """The computation that a request asks for.

    Raises
    ------
    InputError
        If no yarn is given, or the options do not apply to it.
    """
    settings = options.model_dump(include=set(CharacteriseOptions.model_fields))
    if isinstance(yarn, Material):
        return plan_for_material(yarn, **settings)
    if yarn is None:
        raise InputError("material", "is missing.", "Name a material, or give a yarn.")
    del settings["tensions"]  # of a material's own lengths
    return plan_for_yarn(yarn.name, yarn.pass_to(YarnModel), **settings)


def _result(table: YarnTable) -> CharacteriseResult:
    plan = table.plan
    materials = {}
    for setting in plan.settings:
        if any(row.law is not None for row in table.at(setting.name).values()):
            made = material_of(table, setting.name)
            materials[setting.name] = MaterialDocument.from_material(made)
    reference = plan.settings[plan.reference].name
    return CharacteriseResult.of(
        plan,
        reference=reference,
        rows=[row.flat() | {"curves": row.document.get("curves", {})} for row in table.rows],
        material=materials.get(reference),
        materials=materials,
    )


@click.argument("materials", nargs=-1, metavar="[MATERIAL]...")
@click.option("--fabrics", metavar="A,B", help="Pure fabrics; all four if left out.")
@click.option(
    "--loop-lengths", "loop_lengths_mm", metavar="MM,MM", help="Yarn per stitch, for all fabrics."
)
@click.option("--tensions", metavar="X,X", help="Loop lengths as parts of the material's own.")
def _lists(
    materials: tuple[str, ...],
    fabrics: str | None,
    loop_lengths_mm: str | None,
    tensions: str | None,
) -> dict[str, Any]:
    lists = {"fabrics": fabrics, "loop_lengths_mm": loop_lengths_mm, "tensions": tensions}
    parts = {
        name: [part.strip().lower() for part in text.split(",")]
        for name, text in lists.items()
        if text is not None
    }
    return {"materials": materials, **parts}


@click.option("--scheduler", metavar="tcp://HOST:PORT", help="A Dask cluster to work on.")
@click.option("--workers", type=click.IntRange(1), help="Processes here; all cores if left out.")
@click.option("--fresh", is_flag=True, help="Discard what an earlier run left in the folder.")
@click.option("--out", required=True, type=click.Path(path_type=Path), help="FOLDER of results.")
def _command(
    request: YarnsRequest,
    context: Context,
    scheduler: str | None,
    workers: int | None,
    fresh: bool,
    out: Path,
) -> YarnsResult:
    yarns: list[Material | YarnInput] = [*map(context.material, request.materials)]
    if request.yarn is not None:
        yarns.append(request.yarn)
    plans = [_plan(yarn, request) for yarn in yarns]
    names = [plan.identifier for plan in plans]
    if not plans:
        raise InputError("material", "is missing.", "Name materials, or give a --yarn.")
    if len(set(names)) < len(names):
        raise InputError("material", "is named twice.", "Name each once.")
    if fresh:
        shutil.rmtree(out / FINISHED, ignore_errors=True)
    tables = characterise_yarns(
        plans, scheduler=scheduler, workers=workers, keep=out / FINISHED, progress=_show
    )
    results = [_result(table) for table in tables]
    for result in results:
        for setting, document in result.materials.items():
            suffix = "" if setting == result.reference else f"-{setting}"
            save_material_file(document.to_material(), out / f"{result.identifier}{suffix}.json")
    rows = [(result.identifier, row) for result in results for row in result.rows]
    of_row = set(FabricRow.model_fields)
    table = ([yarn, *row.model_dump(mode="json", include=of_row).values()] for yarn, row in rows)
    write_table(out / "table.csv", ["yarn", *FabricRow.model_fields], table)
    points = (
        [yarn, row.fabric, row.setting, direction, *point]
        for yarn, row in rows
        for direction, curve in row.curves.items()
        for point in zip(*(getattr(curve, name) for name in QUANTITIES), strict=True)
    )
    head = ["yarn", "fabric", "setting", "direction", *QUANTITIES]
    write_table(out / "curves.csv", head, points)
    return YarnsResult(results)


def _show(batch: BatchProgress) -> None:
    failed = f", {batch.failed} failed" if batch.failed else ""
    label = batch.key.rpartition(".")[0]  # without the digest
    click.echo(f"{batch.done} of {batch.total} stitches{failed} {label}".rstrip(), err=True)


def _lines(results: YarnsResult) -> list[str]:
    return [line for result in results.root for line in ("", *_of_yarn(result))][1:]


def _of_yarn(result: CharacteriseResult) -> list[str]:
    lines = [
        f"{result.identifier}: {result.provenance}",
        f"{result.branch} branch, {result.convention} convention; "
        + (f"material file at {result.reference}" if result.material else "no material file"),
        "fabric      setting   L mm   wide   high  /cm2   E N·mm contact   Y course     Y wale"
        "   v yx  v xy  strains fitted",
    ]
    lines += [_line(row) for row in result.rows]
    return lines


def _line(row: CharacterisedFabric) -> str:
    head = f"{row.fabric:11} {row.setting:8} {row.loop_length_mm:5.2f}"
    if row.stitch_course_mm is None:
        return f"{head}  {row.remark}"
    line = (
        f"{head} {row.stitch_course_mm:6.3f} {row.stitch_wale_mm:6.3f} {row.stitches_per_cm2:5.1f} "
        f"{row.energy_n_mm:8.4f} {row.contact_share:7.3f}"
    )
    if row.modulus_course_n_per_mm is None:
        return f"{line}  no law: {row.remark}"
    return (
        f"{line} {row.modulus_course_n_per_mm:10.4f} {row.modulus_wale_n_per_mm:10.4f} "
        f"{row.poisson_yx:6.2f} {row.poisson_xy:5.2f}  to {row.largest_strain_course:.2f} and "
        f"{row.largest_strain_wale:.2f}{'' if row.converged else '; NOT converged'}"
    )


OPERATION = Operation(
    characterise,
    path=None,
    tag="yarn level",
    summary="The pure fabrics of a yarn at many stitch settings",
    example={"material": "acrylic", "fabrics": ["garter"], "tensions": [1.0]},
    job=True,
    command=Command(
        _lines,
        more="\n\nEvery fabric is relaxed at every loop length and stretched both ways. A stopped "
        "command continues where it left off. FOLDER holds table.csv, curves.csv, and "
        "material files that every other command takes for --material.",
        names={
            "name": "--yarn",
            **dict.fromkeys(("materials", "fabrics", "loop_lengths_mm", "tensions")),
        },
        fields=_lists,
        run=_command,
        request=YarnsRequest,
    ),
)
