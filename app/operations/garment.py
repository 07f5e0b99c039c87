"""Garments from measurements."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from knitcore.fabric import Direction, Fabric
from knitcore.garment.glove import Finger, Hand, glove
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.templates import Girth, limb_tube, sock_leg, wrist_brace
from knitcore.materials import Material
from knitcore.materials import material as find_material

Length = Annotated[float, Field(gt=0, le=5000, allow_inf_nan=False)]
Ease = Annotated[float, Field(ge=-0.6, le=1, allow_inf_nan=False)]


class WristBrace(BaseModel):
    """A brace knitted sideways and grafted."""

    model_config = ConfigDict(extra="forbid")

    template: Literal["wrist-brace"]
    wrist_mm: Length
    length_mm: Length
    edge_mm: Annotated[float, Field(ge=0, le=500)] = 15.0
    ease: Ease = -0.15

    def plan(self, material: Material) -> GarmentPlan:
        """Make it."""
        return wrist_brace(
            self.wrist_mm, self.length_mm, material, ease=self.ease, edge_mm=self.edge_mm
        )


class SockLeg(BaseModel):
    """The leg of a sock."""

    model_config = ConfigDict(extra="forbid")

    template: Literal["sock-leg"]
    ankle_mm: Length
    calf_mm: Length
    length_mm: Length
    ease: Ease = -0.15

    def plan(self, material: Material) -> GarmentPlan:
        """Make it."""
        return sock_leg(self.ankle_mm, self.calf_mm, self.length_mm, material, ease=self.ease)


class Limb(BaseModel):
    """A sleeve along any limb."""

    model_config = ConfigDict(extra="forbid")

    template: Literal["limb"]
    profile: list[tuple[float, Length]] = Field(
        min_length=2, max_length=200, description="[position_mm, circumference_mm] along the limb."
    )
    body: Fabric = Fabric.STOCKINETTE
    hem: Fabric = Fabric.RIB
    hem_mm: Annotated[float, Field(ge=0, le=500)] = 40.0
    ease: Ease = -0.15

    def plan(self, material: Material) -> GarmentPlan:
        """Make it."""
        girths = [Girth(at, around) for at, around in self.profile]
        return limb_tube(
            "sleeve",
            girths,
            material,
            ease=self.ease,
            body=self.body,
            hem=self.hem,
            hem_mm=self.hem_mm,
        )


class FingerSize(BaseModel):
    """Of one finger."""

    model_config = ConfigDict(extra="forbid")

    length_mm: Length
    circumference_mm: Length

    def finger(self) -> Finger:
        """As the library knows it."""
        return Finger(self.length_mm, self.circumference_mm)


_HAND = Hand()


class Glove(BaseModel):
    """The therapeutic glove; an adult's hand unless measured."""

    model_config = ConfigDict(extra="forbid")

    template: Literal["glove"]
    cuff_mm: Length = _HAND.cuff_mm
    wrist_mm: Length = _HAND.wrist_mm
    palm_mm: Length = _HAND.palm_mm
    thumb_crotch_mm: Length = _HAND.thumb_crotch_mm
    palm_circumference_mm: Length = _HAND.palm_circumference_mm
    thumb: FingerSize | None = None
    fingers: list[FingerSize] | None = Field(None, min_length=4, max_length=4)
    ease: Ease = -0.10

    def plan(self, material: Material) -> GarmentPlan:
        """Make it."""
        hand = Hand(
            cuff_mm=self.cuff_mm,
            wrist_mm=self.wrist_mm,
            palm_mm=self.palm_mm,
            thumb_crotch_mm=self.thumb_crotch_mm,
            palm_circumference_mm=self.palm_circumference_mm,
            thumb=self.thumb.finger() if self.thumb else _HAND.thumb,
            fingers=tuple(f.finger() for f in self.fingers) if self.fingers else _HAND.fingers,
        )
        return glove(hand, material, ease=self.ease)


class GarmentRequest(BaseModel):
    """A template with measurements, and the yarn."""

    model_config = ConfigDict(extra="forbid")

    garment: Annotated[WristBrace | SockLeg | Limb | Glove, Field(discriminator="template")]
    material: str = Field(max_length=80, examples=["glove-wool"])


class RegionResult(BaseModel):
    """One region: the fabric's repeat, its colour, and means over its stitches."""

    name: str
    fill: str
    colour: str
    stitches: int
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    cells: str = Field(description="Lines of x (in the region) and ., the top row first.")


class GarmentResult(BaseModel):
    """A garment as a chart with an outline."""

    name: str
    rows: int
    columns: int
    chart: str
    outline: str = Field(description="Lines of x (stitch) and . (no stitch), the top row first.")
    stitches: int
    around: Direction = Field(description="The material direction around the limb.")
    closing: str
    regions: list[RegionResult]
    yarn_m: float
    notes: list[str]
    warnings: list[str] = Field(description="Where regions of unlike gauge meet.")


def run_garment(request: GarmentRequest) -> GarmentResult:
    """Plan a garment.

    Raises
    ------
    InputError
        From measurements or the material.
    """
    return garment_result(request.garment.plan(find_material(request.material)))


def garment_result(plan: GarmentPlan) -> GarmentResult:
    """A plan at the border."""
    numbers = {n.name: n for n in plan.numbers}
    regions = []
    for region in plan.regions:
        n = numbers[region.name]
        cells = (region.cells & plan.shaped.stitch)[::-1]
        regions.append(
            RegionResult(
                name=region.name,
                fill=region.fill.text,
                colour=region.colour,
                stitches=n.stitches,
                extensibility_course_mm_per_n=n.extensibility_course_mm_per_n,
                extensibility_wale_mm_per_n=n.extensibility_wale_mm_per_n,
                modulus_course_n_per_mm=n.modulus_course_n_per_mm,
                modulus_wale_n_per_mm=n.modulus_wale_n_per_mm,
                cells="\n".join("".join("x" if c else "." for c in row) for row in cells),
            )
        )
    return GarmentResult(
        name=plan.name,
        rows=plan.shaped.chart.rows,
        columns=plan.shaped.chart.columns,
        chart=plan.shaped.chart.text,
        outline=plan.shaped.outline,
        stitches=plan.shaped.stitches,
        around=plan.around,
        closing=plan.closing,
        regions=regions,
        yarn_m=plan.yarn.length_m,
        notes=list(plan.notes),
        warnings=[misfit.text for misfit in plan.misfits],
    )
