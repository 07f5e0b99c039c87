"""The library of materials, with the user's own, and all that is known about one."""

import click
import numpy as np
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import PHASES, Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import (
    FabricRecord,
    Material,
    load_library,
    load_variants,
    offered_materials,
)
from knitcore.materials.law_uncertainty import in_a_sentence
from knitcore.materials.material_document import CurveDocument
from knitcore.mechanics.local_moduli import StitchTable, stitch_table

from ...context import Context
from ...requests.base import (
    Ends,
    Floats,
    IntervalResult,
    MissingError,
    NoRequest,
    RequestModel,
    ResultModel,
)
from ...requests.charts import MaterialName
from ...requests.fabrics import ElasticConstants, Extensibility, LawResult, Moduli, law_fields
from ...service.identity import current_user
from ..registry import Command, Operation

CURVE_POINTS = 60
CURVE_END = 0.85
"""Curves are drawn up to this share of the lock-up strain."""


class MaterialRequest(RequestModel):
    """A material by its identifier."""

    identifier: MaterialName


class FabricSummary(Moduli):
    """A summary of a pure fabric of a material."""

    stitch_course_mm: float = Field(description="Relaxed width of one stitch.")
    stitch_wale_mm: float = Field(description="Relaxed height of one stitch.")
    loop_length_mm: float | None


class FigureResult(ResultModel):
    """A figure of the paper: as printed, as used, and why they differ."""

    table: int
    quantity: str
    unit: str
    printed: str
    used: float
    standard_deviation: float | None
    reason: str


class FabricDetail(ElasticConstants, FabricSummary):
    """A pure fabric of a material in full."""

    law: LawResult
    lock_up_strain_course: float = Field(
        description="Strain at which the loops are taut while the width is held; cloth that may "
        "narrow stretches farther."
    )
    lock_up_strain_wale: float
    setting: str
    origin: str
    stitch_size_source: str
    uncertainty_source: str
    figures: list[FigureResult]


class StitchKind(Moduli, Extensibility):
    """One of the 16 kinds of stitch, by its odd segments: left 1, right 2, below 4, above 8."""

    code: int
    modulus_course_interval_n_per_mm: Ends
    modulus_wale_interval_n_per_mm: Ends
    fractions: dict[Fabric, float] = Field(description="Shares of the four phases.")


class StitchTableResult(IntervalResult):
    """Values for all 16 kinds of stitch."""

    codes: list[StitchKind]


class LawCurve(ResultModel):
    """A stress-strain curve, transverse direction free."""

    strain: Floats
    stress_n_per_mm: Floats


class MaterialSummary(ResultModel):
    """A summary of a material."""

    id: str
    name: str
    description: str
    fabrics: dict[Fabric, FabricSummary]
    added_by_you: bool = Field(
        description="True if you added the material, and may replace and remove it."
    )


class MaterialDetail(ResultModel):
    """A material in full."""

    id: str
    name: str
    description: str
    notes: list[str]
    bending_modulus_n_mm2: float | None
    bending_modulus_sd_n_mm2: float | None
    compression_stiffness_n_per_mm3: float | None
    compression_exponent: float | None
    fabrics: dict[Fabric, FabricDetail]
    stitch_table: StitchTableResult | None = Field(
        description="Values per stitch; null for a material that lacks one of the four fabrics."
    )
    curves: dict[Fabric, dict[Direction, LawCurve]] = Field(description="Curves of the laws.")
    measured: dict[Fabric, dict[Direction, CurveDocument]] = Field(
        description="Curves of the stretch tests, if they are stored with the material."
    )


def material(request: MaterialRequest, context: Context) -> MaterialDetail:
    """Laws, sizes, uncertainty, the paper's figures with corrections, and values per stitch.

    Raises
    ------
    MissingError
        If there is none of that id.
    """
    try:
        material = context.material(request.identifier)
    except InputError as error:
        raise MissingError("identifier", error.problem, error.remedy) from None
    return MaterialDetail.of(
        material.yarn,
        id=material.identifier,
        name=material.name,
        description=description(material),
        notes=[material.note] if material.note else [],
        fabrics={fabric: _detail(record) for fabric, record in material.fabrics.items()},
        stitch_table=_table(stitch_table(material), material) if material.is_complete else None,
        curves={
            fabric: {d: _curve(record.law, d) for d in Direction}
            for fabric, record in material.fabrics.items()
        },
        measured={
            fabric: {d: CurveDocument.from_curve(c) for d, c in record.measured.items()}
            for fabric, record in material.fabrics.items()
            if record.measured
        },
    )


def summary(material: Material, *, added_by_you: bool) -> MaterialSummary:
    """A material in short."""
    return MaterialSummary.of(
        material,
        id=material.identifier,
        description=description(material),
        fabrics={
            fabric: FabricSummary.of(record, **law_fields(record.law, Moduli))
            for fabric, record in material.fabrics.items()
        },
        added_by_you=added_by_you,
    )


def description(material: Material) -> str:
    """Fibre and product."""
    return ", ".join(part for part in (material.yarn.fibre, material.yarn.product) if part)


def _detail(record: FabricRecord) -> FabricDetail:
    return FabricDetail.of(
        record,
        **law_fields(record.law, ElasticConstants),
        law=law_fields(record.law, LawResult),
        lock_up_strain_course=record.law.lock_up_strain(Direction.COURSE),
        lock_up_strain_wale=record.law.lock_up_strain(Direction.WALE),
        uncertainty_source=record.uncertainty.source,
        figures=[FigureResult.of(f, used=f.corrected) for f in record.printed.values()],
    )


def _curve(law: ConstitutiveLaw, direction: Direction) -> LawCurve:
    end = CURVE_END * min(law.lock_up_strain(direction), 10.0)
    curve = uniaxial_response(law, direction, np.linspace(0.0, end, CURVE_POINTS))
    return LawCurve(strain=np.round(curve.strain, 5), stress_n_per_mm=np.round(curve.stress, 6))


def _table(table: StitchTable, of: Material) -> StitchTableResult:
    kinds = []
    for code in range(len(table.fractions)):
        values = {}
        for d in Direction:
            modulus = table.modulus_n_per_mm(d)[code]
            low, high = table.modulus_interval_n_per_mm(d)
            values[f"modulus_{d}_n_per_mm"] = modulus
            values[f"extensibility_{d}_mm_per_n"] = 1 / modulus
            values[f"modulus_{d}_interval_n_per_mm"] = (low[code], high[code])
        fractions = dict(zip(PHASES, table.fractions[code].tolist(), strict=True))
        kinds.append(StitchKind(code=code, fractions=fractions, **values))
    errors = in_a_sentence(record.uncertainty.source for record in of.fabrics.values())
    return StitchTableResult(codes=kinds, interval_source=errors)


class Materials(ResultModel):
    """The library."""

    materials: list[MaterialSummary]


def materials(request: NoRequest, context: Context) -> Materials:
    """The user's own materials, the paper's yarns and their variants, and those of extensions."""
    del request
    library = {**load_library(), **load_variants(), **offered_materials()}
    own = context.own.listed(current_user.get())
    return Materials(
        materials=[
            *(summary(material, added_by_you=yours) for material, yours in own),
            *(summary(material, added_by_you=False) for material in library.values()),
        ]
    )


@click.argument("name", metavar="MATERIAL", required=False)
def _command(request: NoRequest, context: Context, name: str | None) -> Materials | MaterialDetail:
    if name is None:
        return materials(request, context)
    return material(MaterialRequest(identifier=name), context)


def _lines(listed: Materials | MaterialDetail) -> list[str]:
    if isinstance(listed, Materials):
        return [f"{m.id:24} {m.name}: {m.description}" for m in listed.materials]
    lines = [f"{listed.name} ({listed.id}): {listed.description}"]
    if listed.bending_modulus_n_mm2 is not None:
        deviation = listed.bending_modulus_sd_n_mm2
        spread = "" if deviation is None else f" ± {1000 * deviation:.3g}"
        lines.append(f"bending modulus {1000 * listed.bending_modulus_n_mm2:.4g}{spread} mN mm²")
    for fabric, record in listed.fabrics.items():
        lines += [
            "",
            f"{fabric}: {record.setting or record.origin}",
            f"  Young's modulus   course {record.modulus_course_n_per_mm:.4f}   "
            f"wale {record.modulus_wale_n_per_mm:.4f} N/mm",
            f"  Poisson's ratio   yx {record.poisson_yx:.3f}   xy {record.poisson_xy:.3f}",
            f"  lock-up strain    course {record.lock_up_strain_course:.2f}   "
            f"wale {record.lock_up_strain_wale:.2f} at a held width",
            f"  stitch            {record.stitch_course_mm:.2f} x {record.stitch_wale_mm:.2f} mm",
        ]
        lines += [
            f"  table {f.table}, {f.quantity}: printed {f.printed}, used {f.used:g} ({f.reason})"
            for f in record.figures
            if f.reason
        ]
    return lines


MATERIALS = Operation(
    materials,
    method="GET",
    tag="materials",
    summary="The library of materials",
    command=Command(_lines, more="MATERIAL is an id or a file.", run=_command),
)
MATERIAL = Operation(
    material,
    method="GET",
    path="/materials/{identifier}",
    tag="materials",
    summary="Everything known about a material",
)
