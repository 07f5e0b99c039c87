"""Relaxing and stretching a repeat at the yarn level."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from pydantic import BaseModel, ConfigDict, Field

from app.models.charts import ChartInput, to_chart, to_repeat
from app.results.on_disk import KeptResults
from app.results.own_materials import find_material
from knitcore.chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Fabric
from knitcore.materials import Material
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.published.relax import relax_published
from knitcore.yarnlevel.relax import Branch, RelaxedRepeat, relax
from knitcore.yarnlevel.results import RelaxedCell
from knitcore.yarnlibrary.yarns import ChartYarn, yarn_for

Cancelled = Callable[[], bool]
LoopLength = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)]
LoopLengths = list[
    Annotated[list[LoopLength], Field(min_length=1, max_length=MAX_STITCHES_PER_SIDE)]
]


class YarnLevelOptions(BaseModel):
    """Which model of the yarn."""

    model_config = ConfigDict(extra="forbid")

    loop_length_mm: float | None = Field(
        None, gt=0, le=1000, allow_inf_nan=False, description="Yarn per stitch; the material's."
    )
    loop_lengths_mm: LoopLengths | None = Field(
        None,
        min_length=1,
        max_length=MAX_STITCHES_PER_SIDE,
        description="Instead of one length: a list for every row of the chart, the bottom row "
        "first, of one length for all its stitches or one for each.",
        examples=[[[14.0], [12.0]]],
    )
    flat: bool = Field(
        False, description="Hold the stitches in one plane, as a fabric laid flat; not published."
    )
    branch: Branch = Branch.MIRRORED
    convention: Convention = Convention.PUBLISHED
    fresh: bool = Field(False, description="Compute it even if the result is known.")


class RelaxOptions(YarnLevelOptions):
    """What may be held while a repeat relaxes."""

    cell_course_mm: float | None = Field(
        None, gt=0, le=1000, allow_inf_nan=False, description="Hold a stitch at this width."
    )
    cell_wale_mm: float | None = Field(
        None, gt=0, le=1000, allow_inf_nan=False, description="Hold a stitch at this height."
    )


class RelaxRequest(RelaxOptions):
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
    """The shape of least energy, free of force or held; sizes and energies of one stitch."""

    branch: Branch
    convention: Convention
    repeat_rows: int = Field(description="At least 2 in the free branch, as are the columns.")
    repeat_columns: int
    cell_course_mm: float
    cell_wale_mm: float
    energy_n_mm: float
    bending_share: float
    contact_share: float
    yarn_length_mm: float
    force_course_n: float | None = Field(
        description="What holds a prescribed width, per stitch; null in the published branch."
    )
    force_wale_n: float | None
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
    chart, material = asked_chart(request.chart, request), find_material(request.material)
    return relax_chart(
        chart, material, request, with_lines=request.centre_lines, cancelled=cancelled
    )


def relax_chart(
    chart: StitchChart,
    material: Material,
    options: RelaxOptions,
    *,
    with_lines: bool = False,
    cancelled: Cancelled | None = None,
) -> RelaxResult:
    """Relax a chart's repeat, or say what is known of it."""
    repeat = cell_chart(chart, options)
    used = chart_yarn(material, repeat, options)
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
    options: RelaxOptions,
    with_lines: bool,
    cancelled: Cancelled | None,
) -> RelaxResult:
    sizes = options.cell_course_mm, options.cell_wale_mm
    cell = relaxed_cell(repeat, used, options, cancelled, sizes)
    force = cell.force_n if isinstance(cell, RelaxedRepeat) else (None, None)
    shown = cell.chart if isinstance(cell, RelaxedRepeat) else repeat
    lines = [[(x, y, z) for x, y, z in line.tolist()] for line in cell.centre_lines]
    return RelaxResult(
        branch=Branch(cell.branch),
        convention=cell.convention,
        repeat_rows=shown.rows,
        repeat_columns=shown.columns,
        cell_course_mm=cell.cell_course_mm,
        cell_wale_mm=cell.cell_wale_mm,
        energy_n_mm=cell.energy_n_mm,
        bending_share=cell.bending_share,
        contact_share=cell.contact_share,
        yarn_length_mm=cell.yarn_length_mm,
        force_course_n=force[0],
        force_wale_n=force[1],
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


def asked_chart(chart: ChartInput, options: YarnLevelOptions) -> StitchChart:
    """A pure fabric's own repeat, or all of it where its rows have loop lengths of their own."""
    return to_repeat(chart) if options.loop_lengths_mm is None else to_chart(chart)


def cell_chart(chart: StitchChart, options: YarnLevelOptions) -> StitchChart:
    """The repeat of a chart, or all of it where its rows have loop lengths of their own."""
    return chart.repeat() if options.loop_lengths_mm is None else chart


def chart_yarn(material: Material, repeat: StitchChart, options: YarnLevelOptions) -> ChartYarn:
    """The material's yarn for a repeat, with the mean of the loop lengths if they are given.

    Raises
    ------
    InputError
        If lengths are given twice.
    """
    lengths = options.loop_lengths_mm
    if lengths is not None and options.loop_length_mm is not None:
        raise InputError(
            "loop_lengths_mm", "loop_length_mm is given as well.", "Leave one of them out."
        )
    given = options.loop_length_mm
    if lengths is not None:
        given = float(np.mean([np.mean(row) for row in lengths]))
    used = yarn_for(material, repeat, given)
    return used if given is None else replace(used, loop_length_mm=given)


def _lengths(options: YarnLevelOptions, used: ChartYarn, rows: int, columns: int) -> ArrayLike:
    """One loop length, one for every course, or one for every stitch."""
    table = options.loop_lengths_mm
    if table is None:
        return used.loop_length_mm
    if len(table) != rows or any(len(row) not in (1, columns) for row in table):
        raise InputError(
            "loop_lengths_mm",
            f"they do not fit a chart of {rows} rows and {columns} columns.",
            f"Give {rows} rows of one length or of {columns} lengths, the bottom row first.",
        )
    if all(len(row) == 1 for row in table):
        return [row[0] for row in table]
    return [row * (columns // len(row)) for row in table]


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
    repeat: StitchChart,
    used: ChartYarn,
    options: YarnLevelOptions,
    cancelled: Cancelled | None,
    sizes_mm: tuple[float | None, float | None] = (None, None),
) -> RelaxedCell:
    """Relax in the branch that is asked for, at held sizes of a stitch if they are given.

    Raises
    ------
    InputError
        If the published branch is asked for what it has not.
    """
    lengths = _lengths(options, used, repeat.rows, repeat.columns)
    if options.branch is Branch.PUBLISHED:
        held = options.flat or sizes_mm != (None, None) or options.loop_lengths_mm is not None
        if held:
            raise InputError(
                "branch",
                "the published branch knows one loop length and no held sizes or planes.",
                "Use mirrored or free.",
            )
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
        lengths,
        branch=options.branch,
        convention=options.convention,
        cell_course_mm=sizes_mm[0],
        cell_wale_mm=sizes_mm[1],
        flat=options.flat,
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
