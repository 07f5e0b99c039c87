"""Garments from measurements."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.results.own_materials import find_material
from knitcore.fabric import Direction, Fabric
from knitcore.formats.design import DesignFile
from knitcore.formats.garment_design import design_of_plan
from knitcore.garment.gauge import Gauge, GaugeLength, GaugeSet
from knitcore.garment.glove import Finger, Hand, glove
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.templates import Girth, limb_tube, sock_leg, wrist_brace
from knitcore.garment.worn import Fit, Worn
from knitcore.materials import Material

Length = Annotated[float, Field(gt=0, le=5000, allow_inf_nan=False)]
Ease = Annotated[float, Field(ge=-0.6, le=1, allow_inf_nan=False)]
Target = Annotated[
    float | None,
    Field(gt=0, le=300, allow_inf_nan=False, description="Wanted pressure; before the ease."),
]


class GaugeCount(BaseModel):
    """A swatch's gauge, as it is counted."""

    model_config = ConfigDict(extra="forbid")

    stitches: float = Field(gt=0, le=1000, allow_inf_nan=False)
    rows: float = Field(gt=0, le=1000, allow_inf_nan=False)
    per: Literal["10 cm", "4 in", "5 cm"] = "10 cm"
    fabric: Fabric = Field(Fabric.STOCKINETTE, description="Of the swatch.")

    def gauge(self) -> Gauge:
        """As the library knows it."""
        return Gauge.of_count(self.stitches, self.rows, _LENGTHS[self.per])


_LENGTHS = {
    "10 cm": GaugeLength.TEN_CM,
    "4 in": GaugeLength.FOUR_INCHES,
    "5 cm": GaugeLength.FIVE_CM,
}


class WristBrace(BaseModel):
    """A brace knitted sideways and grafted."""

    model_config = ConfigDict(extra="forbid")

    template: Literal["wrist-brace"]
    wrist_mm: Length
    length_mm: Length
    edge_mm: Annotated[float, Field(ge=0, le=500)] = 15.0
    ease: Ease = -0.15
    target_mmhg: Target = None

    def plan(self, material: Material, gauges: GaugeSet, tex: float | None) -> GarmentPlan:
        """Make it."""
        return wrist_brace(
            self.wrist_mm,
            self.length_mm,
            material,
            fit=Fit(self.ease, self.target_mmhg),
            gauges=gauges,
            edge_mm=self.edge_mm,
            linear_density_tex=tex,
        )


class SockLeg(BaseModel):
    """The leg of a sock."""

    model_config = ConfigDict(extra="forbid")

    template: Literal["sock-leg"]
    ankle_mm: Length
    calf_mm: Length
    length_mm: Length
    ease: Ease = -0.15
    target_mmhg: Target = None

    def plan(self, material: Material, gauges: GaugeSet, tex: float | None) -> GarmentPlan:
        """Make it."""
        return sock_leg(
            self.ankle_mm,
            self.calf_mm,
            self.length_mm,
            material,
            fit=Fit(self.ease, self.target_mmhg),
            gauges=gauges,
            linear_density_tex=tex,
        )


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
    target_mmhg: Target = None

    def plan(self, material: Material, gauges: GaugeSet, tex: float | None) -> GarmentPlan:
        """Make it."""
        girths = [Girth(at, around) for at, around in self.profile]
        return limb_tube(
            "sleeve",
            girths,
            material,
            fit=Fit(self.ease, self.target_mmhg),
            gauges=gauges,
            body=self.body,
            hem=self.hem,
            hem_mm=self.hem_mm,
            linear_density_tex=tex,
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
    wrist_circumference_mm: Length = _HAND.wrist_circumference_mm
    palm_mm: Length = _HAND.palm_mm
    thumb_crotch_mm: Length = _HAND.thumb_crotch_mm
    palm_circumference_mm: Length = _HAND.palm_circumference_mm
    gusset_mm: Annotated[float, Field(ge=0, le=200)] = _HAND.gusset_mm
    gusset_girth_mm: Annotated[float, Field(ge=0, le=100)] = _HAND.gusset_girth_mm
    thumb: FingerSize | None = None
    fingers: list[FingerSize] | None = Field(None, min_length=4, max_length=4)
    ease: Ease = -0.10
    target_mmhg: Target = None

    def plan(self, material: Material, gauges: GaugeSet, tex: float | None) -> GarmentPlan:
        """Make it."""
        hand = Hand(
            cuff_mm=self.cuff_mm,
            wrist_mm=self.wrist_mm,
            wrist_circumference_mm=self.wrist_circumference_mm,
            palm_mm=self.palm_mm,
            thumb_crotch_mm=self.thumb_crotch_mm,
            palm_circumference_mm=self.palm_circumference_mm,
            gusset_mm=self.gusset_mm,
            gusset_girth_mm=self.gusset_girth_mm,
            thumb=self.thumb.finger() if self.thumb else _HAND.thumb,
            fingers=tuple(f.finger() for f in self.fingers) if self.fingers else _HAND.fingers,
        )
        return glove(
            hand,
            material,
            ease=self.ease,
            mmhg=self.target_mmhg,
            gauges=gauges,
            linear_density_tex=tex,
        )


class GarmentRequest(BaseModel):
    """A template with measurements, and the yarn."""

    model_config = ConfigDict(extra="forbid")

    garment: Annotated[WristBrace | SockLeg | Limb | Glove, Field(discriminator="template")]
    material: str = Field(max_length=80, examples=["glove-wool"])
    gauge: GaugeCount | None = Field(None, description="The knitter's; else the material's.")
    linear_density_tex: float | None = Field(None, gt=0, lt=1e5, allow_inf_nan=False)
    intarsia: bool = Field(False, description="Give each fabric a yarn of its own.")


class RegionResult(BaseModel):
    """One region: the fabric's repeat, its colour, its size, and means over its stitches."""

    name: str
    fill: str
    colour: str
    stitches: int
    columns: int = Field(description="Stitches of its longest row.")
    rows: int = Field(description="Rows of its longest column.")
    width_mm: float = Field(description="Of that many stitches at rest.")
    height_mm: float
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    yarn_m: float
    yarn_g: float | None
    cells: str = Field(description="Lines of x (in the region) and ., the top row first.")


class GaugeResult(BaseModel):
    """The gauge of a fabric."""

    fabric: Fabric
    stitches_per_10_cm: float
    rows_per_10_cm: float
    stitches_per_4_in: float
    rows_per_4_in: float
    stitches_per_5_cm: float
    rows_per_5_cm: float
    source: str


class Span(BaseModel):
    """From axially free to axially fixed."""

    low: float
    high: float


class WornResult(BaseModel):
    """Pressure at one place along the limb."""

    at_mm: float
    part: str
    rest_mm: float
    worn_mm: float
    ease: float
    strain: float | None
    mmhg: Span | None
    kpa: Span | None
    warnings: list[str]


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
    gauges: list[GaugeResult]
    worn: list[WornResult]
    yarn_m: float
    yarn_g: float | None
    notes: list[str]
    warnings: list[str] = Field(description="Where regions of unlike gauge meet.")
    design: DesignFile = Field(description="The same as a project file, ready to be edited.")


def run_garment(request: GarmentRequest) -> GarmentResult:
    """Plan a garment.

    Raises
    ------
    InputError
        From measurements or the material.
    """
    return plan_garment(request, find_material(request.material))


def plan_garment(request: GarmentRequest, material: Material) -> GarmentResult:
    """Plan a garment in a material that need not be of the library.

    Raises
    ------
    InputError
        From measurements or the material.
    """
    count = request.gauge
    gauges = (
        GaugeSet.of_material(material)
        if count is None
        else GaugeSet.of_material(material, count.gauge(), count.fabric)
    )
    plan = request.garment.plan(material, gauges, request.linear_density_tex)
    shaped = plan.shaped
    return GarmentResult(
        name=plan.name,
        rows=shaped.chart.rows,
        columns=shaped.chart.columns,
        chart=shaped.chart.text,
        outline=shaped.outline,
        stitches=shaped.stitches,
        around=plan.around,
        closing=plan.closing,
        regions=_regions(plan, material, request.linear_density_tex),
        gauges=[_gauge(fabric, gauge) for fabric, gauge in gauges.gauges.items()],
        worn=[_worn(place) for place in plan.worn],
        yarn_m=plan.yarn.length_m,
        yarn_g=plan.yarn.mass_g,
        notes=list(plan.notes),
        warnings=[misfit.text for misfit in plan.misfits],
        design=design_of_plan(plan, request.material, intarsia=request.intarsia),
    )


def _regions(plan: GarmentPlan, material: Material, tex: float | None) -> list[RegionResult]:
    numbers = {n.name: n for n in plan.numbers}
    results = []
    for region, fabric in zip(plan.regions, plan.fabrics, strict=True):
        n = numbers[region.name]
        cells = region.cells & plan.shaped.stitch
        spans = int(cells.sum(axis=1).max()), int(cells.sum(axis=0).max())
        gauge = plan.gauges[fabric]
        use = plan.yarn_of(region, material, tex)
        results.append(
            RegionResult(
                name=region.name,
                fill=region.fill.text,
                colour=region.colour,
                stitches=n.stitches,
                columns=spans[0],
                rows=spans[1],
                width_mm=spans[0] * gauge.stitch_course_mm,
                height_mm=spans[1] * gauge.stitch_wale_mm,
                extensibility_course_mm_per_n=n.extensibility_course_mm_per_n,
                extensibility_wale_mm_per_n=n.extensibility_wale_mm_per_n,
                modulus_course_n_per_mm=n.modulus_course_n_per_mm,
                modulus_wale_n_per_mm=n.modulus_wale_n_per_mm,
                yarn_m=use.length_m,
                yarn_g=use.mass_g,
                cells="\n".join("".join("x" if c else "." for c in row) for row in cells[::-1]),
            )
        )
    return results


def _gauge(fabric: Fabric, gauge: Gauge) -> GaugeResult:
    counts = {name: gauge.counts(length) for name, length in _LENGTHS.items()}
    return GaugeResult(
        fabric=fabric,
        stitches_per_10_cm=counts["10 cm"][0],
        rows_per_10_cm=counts["10 cm"][1],
        stitches_per_4_in=counts["4 in"][0],
        rows_per_4_in=counts["4 in"][1],
        stitches_per_5_cm=counts["5 cm"][0],
        rows_per_5_cm=counts["5 cm"][1],
        source=gauge.source,
    )


def _worn(place: Worn) -> WornResult:
    found = place.pressure
    return WornResult(
        at_mm=place.at_mm,
        part=place.part,
        rest_mm=place.rest_mm,
        worn_mm=place.worn_mm,
        ease=place.ease,
        strain=None if found is None else found.strain,
        mmhg=None if found is None else Span(low=found.mmhg.low, high=found.mmhg.high),
        kpa=None if found is None else Span(low=found.kpa.low, high=found.kpa.high),
        warnings=[place.problem] if found is None else list(found.warnings),
    )
