"""Listing and explaining materials."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from pydantic import BaseModel, Field

from app.results.own_materials import find_material, own_materials
from app.settings import Settings
from knitcore.fabric import PHASES, Direction, Fabric
from knitcore.law.constitutive import ConstitutiveLaw
from knitcore.law.uniaxial import uniaxial_response
from knitcore.materials import FabricRecord, Material, load_library, load_variants
from knitcore.materials.document import CurveDocument
from knitcore.mechanics.local import StitchTable, stitch_table

CURVE_POINTS = 60
CURVE_END = 0.85
"""Curves are drawn up to this share of the lock-up strain."""


class FabricSummary(BaseModel):
    """A pure fabric of a material, in short."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    stitch_course_mm: float = Field(description="Relaxed width of one stitch.")
    stitch_wale_mm: float = Field(description="Relaxed height of one stitch.")
    loop_length_mm: float | None


class MaterialSummary(BaseModel):
    """A material, in short."""

    id: str
    name: str
    description: str
    fabrics: dict[Fabric, FabricSummary]


class Materials(BaseModel):
    """The library."""

    materials: list[MaterialSummary]


class LawResult(BaseModel):
    """The nine constants of a constitutive law."""

    stiffness_xxxx_n_per_mm: float
    stiffness_yyyy_n_per_mm: float
    stiffness_xxyy_n_per_mm: float
    stiffness_yyxx_n_per_mm: float
    alpha_xx: float
    alpha_yy: float
    beta_xx_n_per_mm: float
    beta_yy_n_per_mm: float
    shear_modulus_n_per_mm: float = Field(description="An assumption unless it was calibrated.")

    @classmethod
    def of(cls, law: ConstitutiveLaw) -> LawResult:
        """The constants of a law, with units in their names."""
        return cls(
            stiffness_xxxx_n_per_mm=law.stiffness_xxxx,
            stiffness_yyyy_n_per_mm=law.stiffness_yyyy,
            stiffness_xxyy_n_per_mm=law.stiffness_xxyy,
            stiffness_yyxx_n_per_mm=law.stiffness_yyxx,
            alpha_xx=law.alpha_xx,
            alpha_yy=law.alpha_yy,
            beta_xx_n_per_mm=law.beta_xx,
            beta_yy_n_per_mm=law.beta_yy,
            shear_modulus_n_per_mm=law.shear_modulus,
        )


class FigureResult(BaseModel):
    """A figure of the paper: as printed, as used, and why they differ."""

    table: int
    quantity: str
    unit: str
    printed: str
    used: float
    standard_deviation: float | None
    reason: str


class FabricDetail(FabricSummary):
    """A pure fabric of a material, with everything that is known of it."""

    law: LawResult
    poisson_yx: float
    poisson_xy: float
    lock_up_strain_course: float
    lock_up_strain_wale: float
    setting: str
    origin: str
    stitch_size_source: str
    uncertainty_source: str
    figures: list[FigureResult]


class StitchKind(BaseModel):
    """One of the 16 kinds of stitch, by its odd segments: left 1, right 2, below 4, above 8."""

    code: int
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_interval: tuple[float, float]
    modulus_wale_interval: tuple[float, float]
    fractions: dict[Fabric, float] = Field(description="Shares of the four phases.")


class StitchTableResult(BaseModel):
    """Values of all kinds of stitch."""

    codes: list[StitchKind]


class CurveResult(BaseModel):
    """A stress-strain curve, transverse direction free."""

    strain: list[float]
    stress_n_per_mm: list[float]


class MaterialDetail(BaseModel):
    """A material, with everything that is known of it."""

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
        description="None for a material that lacks one of the four fabrics."
    )
    curves: dict[Fabric, dict[Direction, CurveResult]] = Field(description="Of the laws.")
    measured: dict[Fabric, dict[Direction, CurveDocument]] = Field(
        description="Of the stretch tests, where they are kept with the material."
    )


def list_materials() -> Materials:
    """One's own, the library and its variants, in short."""
    found = [
        *own_materials(Settings().data_dir.expanduser()).values(),
        *load_library().values(),
        *load_variants().values(),
    ]
    return Materials(
        materials=[
            MaterialSummary(
                id=m.identifier,
                name=m.name,
                description=_description(m),
                fabrics={f: _summary(r) for f, r in m.fabrics.items()},
            )
            for m in found
        ]
    )


@lru_cache(maxsize=64)
def explain_material(identifier: str) -> MaterialDetail:
    """Everything that is known of a library material."""
    return describe_material(find_material(identifier))


def describe_material(material: Material) -> MaterialDetail:
    """Everything that is known of a material."""
    yarn = material.yarn
    return MaterialDetail(
        id=material.identifier,
        name=material.name,
        description=_description(material),
        notes=[material.note] if material.note else [],
        bending_modulus_n_mm2=yarn.bending_modulus_n_mm2,
        bending_modulus_sd_n_mm2=yarn.bending_modulus_sd_n_mm2,
        compression_stiffness_n_per_mm3=yarn.compression_stiffness_n_per_mm3,
        compression_exponent=yarn.compression_exponent,
        fabrics={fabric: _detail(record) for fabric, record in material.fabrics.items()},
        stitch_table=_table(stitch_table(material)) if material.is_complete else None,
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


def _description(material: Material) -> str:
    parts = [material.yarn.fibre, material.yarn.product]
    return ", ".join(part for part in parts if part)


def _summary(record: FabricRecord) -> FabricSummary:
    return FabricSummary(
        modulus_course_n_per_mm=record.law.modulus_course,
        modulus_wale_n_per_mm=record.law.modulus_wale,
        stitch_course_mm=record.stitch_course_mm,
        stitch_wale_mm=record.stitch_wale_mm,
        loop_length_mm=record.loop_length_mm,
    )


def _detail(record: FabricRecord) -> FabricDetail:
    law = record.law
    return FabricDetail(
        **_summary(record).model_dump(),
        law=LawResult.of(law),
        poisson_yx=law.poisson_yx,
        poisson_xy=law.poisson_xy,
        lock_up_strain_course=law.lock_up_strain(Direction.COURSE),
        lock_up_strain_wale=law.lock_up_strain(Direction.WALE),
        setting=record.setting,
        origin=record.origin,
        stitch_size_source=record.stitch_size_source,
        uncertainty_source=record.uncertainty.source,
        figures=[
            FigureResult(
                table=figure.table,
                quantity=figure.quantity,
                unit=figure.unit,
                printed=figure.printed,
                used=figure.corrected,
                standard_deviation=figure.standard_deviation,
                reason=figure.reason,
            )
            for figure in record.printed.values()
        ],
    )


def _curve(law: ConstitutiveLaw, direction: Direction) -> CurveResult:
    end = CURVE_END * min(law.lock_up_strain(direction), 10.0)
    curve = uniaxial_response(law, direction, np.linspace(0.0, end, CURVE_POINTS))
    return CurveResult(
        strain=np.round(curve.strain, 5).tolist(),
        stress_n_per_mm=np.round(curve.stress, 6).tolist(),
    )


def _table(table: StitchTable) -> StitchTableResult:
    low_x, high_x = table.modulus_interval_n_per_mm(Direction.COURSE)
    low_y, high_y = table.modulus_interval_n_per_mm(Direction.WALE)
    return StitchTableResult(
        codes=[
            StitchKind(
                code=code,
                modulus_course_n_per_mm=table.modulus_course_n_per_mm[code],
                modulus_wale_n_per_mm=table.modulus_wale_n_per_mm[code],
                extensibility_course_mm_per_n=1 / table.modulus_course_n_per_mm[code],
                extensibility_wale_mm_per_n=1 / table.modulus_wale_n_per_mm[code],
                modulus_course_interval=(low_x[code], high_x[code]),
                modulus_wale_interval=(low_y[code], high_y[code]),
                fractions=dict(zip(PHASES, table.fractions[code].tolist(), strict=True)),
            )
            for code in range(len(table.fractions))
        ]
    )
