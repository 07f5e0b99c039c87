"""Relaxing and stretching a repeat at the yarn level."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict

from pydantic import BaseModel, ConfigDict, Field

from app.kept import KeptResults
from app.operations.charts import ChartInput, to_repeat
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.materials import Material
from knitcore.materials import material as find_material
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.published.relax import relax_published
from knitcore.yarnlevel.relax import Branch, RelaxedRepeat, relax
from knitcore.yarnlevel.results import RelaxedCell
from knitcore.yarnlevel.yarns import ChartYarn, yarn_for

Cancelled = Callable[[], bool]


class YarnLevelOptions(BaseModel):
    """Which model of the yarn."""

    model_config = ConfigDict(extra="forbid")

    loop_length_mm: float | None = Field(
        None, gt=0, le=1000, allow_inf_nan=False, description="Yarn per stitch; the material's."
    )
    branch: Branch = Branch.MIRRORED
    convention: Convention = Convention.PUBLISHED
    fresh: bool = Field(False, description="Compute it even if the result is known.")


class RelaxRequest(YarnLevelOptions):
    """A repeat and its yarn."""

    chart: ChartInput
    material: str = Field(max_length=80, examples=["acrylic"])
    centre_lines: bool = Field(False, description="Return the centre lines of the yarn too.")


class StartResult(BaseModel):
    """What became of one start; null where it failed."""

    name: str
    outcome: str
    energy_n_mm: float | None
    cell_course_mm: float | None
    cell_wale_mm: float | None


class YarnResult(BaseModel):
    """The yarn that was used and where its numbers come from."""

    bending_modulus_n_mm2: float
    contact_stiffness_n_per_mm3: float
    contact_exponent: float
    radius_mm: float
    core_radius_mm: float
    provenance: str
    estimated: bool


class RelaxResult(BaseModel):
    """The shape of least energy, free of force; sizes and energies of one stitch."""

    branch: Branch
    convention: Convention
    repeat_rows: int
    repeat_columns: int
    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    bending_share: float
    contact_share: float
    yarn_length_mm: float
    min_distance_mm: float | None
    seconds: float = Field(description="CPU time of the solve, whenever it was.")
    known: bool = Field(False, description="Whether it had been computed before.")
    evaluations: int
    converged: bool
    yarn: YarnResult
    starts: list[StartResult]
    notes: list[str]
    centre_lines_mm: list[list[tuple[float, float, float]]] | None = Field(
        None, description="Bottom course first; each runs once across the repeat."
    )


def run_relax(request: RelaxRequest, *, cancelled: Cancelled) -> RelaxResult:
    """Relax for the service."""
    chart, material = to_repeat(request.chart), find_material(request.material)
    return relax_chart(
        chart, material, request, with_lines=request.centre_lines, cancelled=cancelled
    )


def relax_chart(
    chart: StitchChart,
    material: Material,
    options: YarnLevelOptions,
    *,
    with_lines: bool = False,
    cancelled: Cancelled | None = None,
) -> RelaxResult:
    """Relax a chart's repeat, or say what is known of it."""
    repeat = chart.repeat()
    used = chart_yarn(material, repeat, options.loop_length_mm)
    inputs = {**what_decides(repeat, used, options), "centre_lines": with_lines}
    result, known = KeptResults.of_user().get_or_make(
        RelaxResult,
        inputs,
        lambda: _relaxed(repeat, used, options, with_lines, cancelled),
        fresh=options.fresh,
    )
    return result.model_copy(update={"known": known})


def what_decides(
    repeat: StitchChart, used: ChartYarn, options: YarnLevelOptions
) -> dict[str, object]:
    """All inputs of a relaxation or a stretch, for its name among kept results."""
    asked = options.model_dump(mode="json", exclude={"fresh", "chart", "material", "centre_lines"})
    return {"repeat": repeat.text, "used": asdict(used), "asked": asked}


def _relaxed(
    repeat: StitchChart,
    used: ChartYarn,
    options: YarnLevelOptions,
    with_lines: bool,
    cancelled: Cancelled | None,
) -> RelaxResult:
    cell = relaxed_cell(repeat, used, options, cancelled)
    lines = [[(x, y, z) for x, y, z in line.tolist()] for line in cell.centre_lines]
    return RelaxResult(
        branch=Branch(cell.branch),
        convention=cell.convention,
        repeat_rows=repeat.rows,
        repeat_columns=repeat.columns,
        cell_course_mm=cell.cell_course_mm,
        cell_wale_mm=cell.cell_wale_mm,
        energy_n_mm=cell.energy_n_mm,
        bending_share=cell.bending_share,
        contact_share=cell.contact_share,
        yarn_length_mm=cell.yarn_length_mm,
        min_distance_mm=cell.min_distance_mm if isinstance(cell, RelaxedRepeat) else None,
        seconds=cell.seconds,
        evaluations=cell.evaluations,
        converged=cell.converged,
        yarn=yarn_result(used),
        starts=[
            StartResult(
                name=s.name,
                outcome=s.outcome,
                energy_n_mm=_or_none(s.energy_n_mm),
                cell_course_mm=_or_none(s.cell_course_mm),
                cell_wale_mm=_or_none(s.cell_wale_mm),
            )
            for s in cell.starts
        ],
        notes=list(cell.notes),
        centre_lines_mm=lines if with_lines else None,
    )


def chart_yarn(material: Material, repeat: StitchChart, loop_length_mm: float | None) -> ChartYarn:
    """The material's yarn for a repeat, with another loop length if one is given."""
    used = yarn_for(material, repeat, loop_length_mm)
    if loop_length_mm is None:
        return used
    return ChartYarn(used.yarn, loop_length_mm, used.provenance, used.estimated)


def yarn_result(used: ChartYarn) -> YarnResult:
    """The yarn at the border."""
    yarn = used.yarn
    return YarnResult(
        bending_modulus_n_mm2=yarn.bending_modulus_n_mm2,
        contact_stiffness_n_per_mm3=yarn.contact_stiffness_n_per_mm3,
        contact_exponent=yarn.contact_exponent,
        radius_mm=yarn.radius_mm,
        core_radius_mm=yarn.core_radius_mm,
        provenance=used.provenance,
        estimated=used.estimated,
    )


def relaxed_cell(
    repeat: StitchChart, used: ChartYarn, options: YarnLevelOptions, cancelled: Cancelled | None
) -> RelaxedCell:
    """Relax in the branch that is asked for."""
    if options.branch is Branch.PUBLISHED:
        return relax_published(
            pure_fabric(repeat),
            used.yarn,
            used.loop_length_mm,
            convention=options.convention,
            cancel=cancelled,
        )
    return relax(
        repeat,
        used.yarn,
        used.loop_length_mm,
        branch=options.branch,
        convention=options.convention,
        cancel=cancelled,
    )


def pure_fabric(repeat: StitchChart) -> Fabric:
    """The pure fabric of a repeat.

    Raises
    ------
    InputError
        If it is a mixed one, for which there is no published ansatz.
    """
    for fabric in Fabric:
        if StitchChart.of_fabric(fabric, 2, 2).repeat() in (repeat, repeat.swap()):
            return fabric
    raise InputError(
        "branch",
        "the published branch knows the four pure fabrics only.",
        "Use mirrored or free for this chart.",
    )


def _or_none(value: float) -> float | None:
    """None where a failed start left NaN."""
    return None if math.isnan(value) else value
