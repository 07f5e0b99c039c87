"""The reduced-symmetry model of the four fabrics."""

from __future__ import annotations

from pydantic import BaseModel, Field

from knitcore.fabric import Direction, Fabric
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import SegmentResult, rs_fabrics


class RSSegment(BaseModel):
    """The connecting segments of one direction."""

    parity: Parity
    separation_mm: float = Field(description="lambda, distance of the segment's ends.")
    length_mm: float = Field(description="L, yarn between them.")
    slope: float = Field(description="v, the ends' tangent across the line between them.")
    angle_rad: float | None = Field(description="phi, tilt out of the cloth; odd segments only.")
    delta: float
    rigidity_n_per_mm: float
    modulus_n_per_mm: float
    published_n_per_mm: float | None = Field(description="The paper's value for this modulus.")


class RSFabricResult(BaseModel):
    """A pure fabric in the model."""

    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    segments: dict[Direction, RSSegment]


class RSResult(BaseModel):
    """The four fabrics of a yarn."""

    material: str
    fabrics: dict[Fabric, RSFabricResult]


def rs_material(material: str) -> RSResult:
    """Moduli from the shape of the yarn alone; the paper has shapes for acrylic and cotton."""
    return RSResult(
        material=material,
        fabrics={
            fabric: RSFabricResult(
                modulus_course_n_per_mm=found.modulus_course_n_per_mm,
                modulus_wale_n_per_mm=found.modulus_wale_n_per_mm,
                segments={d: _segment(found.segment(d)) for d in Direction},
            )
            for fabric, found in rs_fabrics(material).items()
        },
    )


def _segment(result: SegmentResult) -> RSSegment:
    geometry = result.geometry
    return RSSegment(
        parity=geometry.parity,
        separation_mm=geometry.separation_mm,
        length_mm=geometry.length_mm,
        slope=geometry.slope,
        angle_rad=geometry.angle_rad,
        delta=geometry.delta,
        rigidity_n_per_mm=result.rigidity_n_per_mm,
        modulus_n_per_mm=result.modulus_n_per_mm,
        published_n_per_mm=result.published_n_per_mm,
    )
