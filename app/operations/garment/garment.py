"""Garments from measurements."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, Literal

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import size_in_words
from knitcore.formats.designs.design_file import DesignFile, write_design
from knitcore.formats.designs.garment_design import design_of_plan
from knitcore.garment.gauge import Gauge, GaugeLength, GaugeSet
from knitcore.garment.glove import Finger, Hand, glove
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.templates import Girth, limb_tube, sock_leg, wrist_brace
from knitcore.garment.worn_piece import Fit, Worn
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import log_interval

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Ends, IntervalResult, RequestModel, ResultModel
from ...requests.charts import CellLines, ChartLines, MaterialName, RepeatText
from ...requests.fabrics import Extensibility, LawsRequest, Moduli
from ..registry import Command, Operation

Length = Annotated[float, Field(gt=0, le=2000)]
OfHand = Annotated[float, Field(gt=0, le=500)]
Ease = Annotated[float, Field(ge=-0.6, le=1)]
TargetProfile = Annotated[
    list[tuple[float, Annotated[float, Field(gt=0, le=300)]]] | None,
    Field(
        min_length=1,
        max_length=100,
        description="Graded target pressure: pairs [position_mm, mmHg] along the limb; takes "
        "precedence over one target.",
    ),
]
TargetPressure = Annotated[
    float | None,
    Field(gt=0, le=300, description="Target pressure; takes precedence over the ease."),
]


class GaugeCount(RequestModel):
    """A gauge counted on a swatch."""

    stitches: float = Field(gt=0, le=1000)
    rows: float = Field(gt=0, le=1000)
    per: Literal["10 cm", "4 in", "5 cm"] = "10 cm"
    fabric: Fabric = Field(Fabric.STOCKINETTE, description="Repeat of the swatch.")

    def gauge(self) -> Gauge:
        """The gauge as an object of the library."""
        return Gauge.of_count(self.stitches, self.rows, _LENGTHS[self.per])


_LENGTHS = {
    "10 cm": GaugeLength.TEN_CM,
    "4 in": GaugeLength.FOUR_INCHES,
    "5 cm": GaugeLength.FIVE_CM,
}


class Template(RequestModel):
    """Tightness of a garment."""

    ease: Ease = -0.15
    target_mmhg: TargetPressure = None

    @property
    def fit(self) -> Fit:
        """The fit as an object of the library."""
        return Fit(self.ease, self.target_mmhg)


class WristBrace(Template):
    """A brace, knitted sideways and grafted."""

    template: Literal["wrist-brace"]
    wrist_mm: Length
    length_mm: Length
    edge_mm: Annotated[float, Field(ge=0, le=500)] = 15.0
    support: Fabric = Fabric.STOCKINETTE
    edge: Fabric = Fabric.GARTER

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan, for a material, gauges and a linear density."""
        return self.pass_to(wrist_brace, fit=self.fit, **yarn)


class Graded(Template):
    """A tube along a limb, whose pressure may change along it."""

    mmhg_profile: TargetProfile = None
    body: Fabric = Fabric.STOCKINETTE
    hem: Fabric = Fabric.RIB

    @property
    def fit(self) -> Fit:
        """The fit as an object of the library."""
        return Fit(self.ease, self.mmhg_profile or self.target_mmhg)


class SockLeg(Graded):
    """The leg of a sock."""

    template: Literal["sock-leg"]
    ankle_mm: Length
    calf_mm: Length
    length_mm: Length

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        return self.pass_to(sock_leg, fit=self.fit, **yarn)


class Limb(Graded):
    """A sleeve for any limb."""

    template: Literal["limb"]
    profile: list[tuple[float, Length]] = Field(
        min_length=2,
        max_length=200,
        description="Pairs [position_mm, circumference_mm] along the limb.",
    )
    hem_mm: Annotated[float, Field(ge=0, le=500)] = 40.0

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        girths = [Girth(at, around) for at, around in self.profile]
        return self.pass_to(limb_tube, "sleeve", girths, fit=self.fit, **yarn)


class FingerSize(RequestModel):
    """Measurements of one finger."""

    length_mm: OfHand
    circumference_mm: OfHand


_HAND = Hand()


class Glove(Template):
    """The therapeutic glove; measurements default to an adult's hand."""

    template: Literal["glove"]
    cuff_mm: OfHand = _HAND.cuff_mm
    wrist_mm: OfHand = _HAND.wrist_mm
    wrist_circumference_mm: OfHand = _HAND.wrist_circumference_mm
    palm_mm: OfHand = _HAND.palm_mm
    thumb_crotch_mm: OfHand = _HAND.thumb_crotch_mm
    palm_circumference_mm: OfHand = _HAND.palm_circumference_mm
    gusset_mm: Annotated[float, Field(ge=0, le=200)] = _HAND.gusset_mm
    gusset_girth_mm: Annotated[float, Field(ge=0, le=100)] = _HAND.gusset_girth_mm
    thumb: FingerSize | None = None
    fingers: list[FingerSize] | None = Field(None, min_length=4, max_length=4)
    ease: Ease = -0.10

    @property
    def hand(self) -> Hand:
        """The hand as an object of the library."""
        fingers = self.fingers and tuple(finger.pass_to(Finger) for finger in self.fingers)
        thumb = self.thumb and self.thumb.pass_to(Finger)
        return self.pass_to(Hand, thumb=thumb or _HAND.thumb, fingers=fingers or _HAND.fingers)

    def plan(self, **yarn: Any) -> GarmentPlan:
        """The garment's plan for a yarn."""
        return glove(self.hand, ease=self.ease, mmhg=self.target_mmhg, **yarn)


MATERIAL_ERRORS = (
    "Sizes: the material's gauge, with one aspect ratio of stitches for all yarns (8 %); "
    "a gauge of your own makes them more certain. Yarn: the paper's ± on loop lengths (5 %)."
)
SWATCH_ERRORS = (
    "Sizes: a counted gauge (3 %), and for fabrics other than the swatch's the aspect ratio "
    "of stitches (8 %). Yarn: the paper's ± on loop lengths (5 %)."
)


class KnitterRequest(LawsRequest):
    """The yarn, and how somebody knits it."""

    material: MaterialName
    gauge: GaugeCount | None = Field(
        None, description="The knitter's gauge; the material's by default."
    )

    def gauges(self, material: Material) -> GaugeSet:
        """The gauges of the four fabrics."""
        if self.gauge is None:
            return GaugeSet.of_material(material)
        return GaugeSet.of_material(material, self.gauge.gauge(), self.gauge.fabric)


class GarmentRequest(KnitterRequest):
    """A template with measurements, and the yarn."""

    garment: Annotated[WristBrace | SockLeg | Limb | Glove, Field(discriminator="template")]
    linear_density_tex: float | None = Field(
        None, gt=0, lt=1e5, description="Linear density of the yarn (g/km), for its mass."
    )
    intarsia: bool = Field(False, description="Knit each fabric with a yarn of its own.")


class RegionResult(Moduli, Extensibility):
    """One region: its repeat, colour and size, and the initial moduli of its fabric."""

    name: str
    fill: RepeatText
    colour: str
    stitches: int
    columns: int = Field(description="Stitches of its longest row.")
    rows: int = Field(description="Rows of its longest column.")
    width_mm: float = Field(
        description="Size at rest of that many stitches of its fabric, without neighbours."
    )
    height_mm: float
    width_interval_mm: Ends = Field(
        description="90 % interval of the width, from that of the gauge."
    )
    height_interval_mm: Ends
    yarn_m: float
    yarn_g: float | None
    cells: CellLines


class GaugeResult(ResultModel):
    """The gauge of a fabric."""

    fabric: Fabric
    stitches_per_10_cm: float
    rows_per_10_cm: float
    stitches_per_4_in: float
    rows_per_4_in: float
    stitches_per_5_cm: float
    rows_per_5_cm: float
    source: str


class WornResult(ResultModel):
    """Pressure at one place along the limb."""

    at_mm: float
    part: str
    rest_mm: float
    worn_mm: float
    ease: float
    strain: float | None
    mmhg: Ends | None
    kpa: Ends | None
    warnings: list[str]


class GarmentResult(IntervalResult):
    """A garment as a chart with an outline."""

    name: str
    rows: int
    columns: int
    chart: ChartLines
    outline: CellLines
    stitches: int
    around: Direction = Field(description="The material direction around the limb.")
    closing: str
    regions: list[RegionResult]
    gauges: list[GaugeResult]
    worn: list[WornResult]
    yarn_m: float
    yarn_g: float | None
    yarn_interval_m: Ends = Field(description="90 % interval of the yarn's length.")
    yarn_interval_g: Ends | None
    notes: list[str]
    warnings: list[str] = Field(description="Notes on borders between regions of different gauge.")
    design: DesignFile = Field(description="The garment as a project file, ready to edit.")


def garment(request: GarmentRequest, context: Context) -> GarmentResult:
    """Outline, regions, fills, yarn and warnings of a template with measurements.

    Raises
    ------
    InputError
        If a measurement or the material cannot be used.
    """
    material = context.material(request.material)
    gauges = request.gauges(material)
    tex = request.linear_density_tex
    plan = request.garment.plan(material=material, gauges=gauges, linear_density_tex=tex)
    return GarmentResult.of(
        plan,
        rows=plan.shaped.chart.rows,
        columns=plan.shaped.chart.columns,
        chart=plan.shaped.chart.text,
        outline=plan.shaped.outline,
        stitches=plan.shaped.stitches,
        regions=_regions(plan, material, tex),
        gauges=[_gauge(fabric, gauge) for fabric, gauge in gauges.gauges.items()],
        worn=[_worn(place) for place in plan.worn],
        yarn_m=plan.yarn.length_m,
        yarn_g=plan.yarn.mass_g,
        yarn_interval_m=plan.yarn.length_interval_m,
        yarn_interval_g=plan.yarn.mass_interval_g,
        interval_source=SWATCH_ERRORS if request.gauge else MATERIAL_ERRORS,
        warnings=[misfit.text for misfit in plan.misfits],
        design=request.pass_to(design_of_plan, plan),
    )


def _regions(plan: GarmentPlan, material: Material, tex: float | None) -> list[RegionResult]:
    numbers = {n.name: n for n in plan.numbers}
    results = []
    for region, fabric in zip(plan.regions, plan.fabrics, strict=True):
        cells = region.cells & plan.shaped.stitch
        columns, rows = int(cells.sum(axis=1).max()), int(cells.sum(axis=0).max())
        gauge = plan.gauges[fabric]
        use = plan.yarn_of(region, material, tex)
        results.append(
            RegionResult.of(
                numbers[region.name],
                fill=region.fill.key,
                colour=region.colour,
                columns=columns,
                rows=rows,
                width_mm=columns * gauge.stitch_course_mm,
                height_mm=rows * gauge.stitch_wale_mm,
                width_interval_mm=log_interval(columns * gauge.stitch_course_mm, gauge.log_sd),
                height_interval_mm=log_interval(rows * gauge.stitch_wale_mm, gauge.log_sd),
                yarn_m=use.length_m,
                yarn_g=use.mass_g,
                cells="\n".join("".join("x" if c else "." for c in row) for row in cells[::-1]),
            )
        )
    return results


def _gauge(fabric: Fabric, gauge: Gauge) -> GaugeResult:
    counts = {}
    for name, length in _LENGTHS.items():
        per = name.replace(" ", "_")
        counts[f"stitches_per_{per}"], counts[f"rows_per_{per}"] = gauge.counts(length)
    return GaugeResult.of(gauge, fabric=fabric, **counts)


def _worn(place: Worn) -> WornResult:
    if (pressure := place.pressure) is None:
        return WornResult.of(place, strain=None, mmhg=None, kpa=None, warnings=[place.problem])
    return WornResult.of(place, **vars(pressure))


def measured_options(command: Callable[..., dict[str, object]]) -> Callable[..., dict[str, object]]:
    """Options of a garment's measurements; :func:`read_measured` reads them."""
    for option in (
        click.option("--per", type=click.Choice(list(_LENGTHS)), default="10 cm"),
        click.option("--gauge", metavar="STSxROWS", help="The knitter's own gauge, such as 22x30."),
        click.option(
            "--set",
            "settings",
            multiple=True,
            metavar="NAME=VALUE",
            help="A measurement such as wrist_mm=170, or profile=[[0,200],[150,260]]; repeatable.",
        ),
    ):
        command = option(command)
    return command


def read_measured(
    template: str, settings: tuple[str, ...], gauge: str | None, per: str
) -> dict[str, object]:
    """Fields ``garment`` and ``gauge`` of a request.

    Raises
    ------
    InputError
        If a setting is none.
    """
    values: dict[str, object] = {"template": template}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals:
            raise InputError("set", f"{setting!r} is not a setting.", "Write NAME=VALUE.")
        try:
            values[name] = json.loads(value)
        except json.JSONDecodeError:
            values[name] = value
    fields: dict[str, object] = {"garment": values}
    if gauge is not None:
        stitches, _, rows = gauge.lower().replace("×", "x").partition("x")
        fields["gauge"] = {"stitches": stitches, "rows": rows, "per": per}
    return fields


@click.argument("template", type=click.Choice(["wrist-brace", "sock-leg", "limb", "glove"]))
@measured_options
def _garment_fields(
    template: str, settings: tuple[str, ...], gauge: str | None, per: str
) -> dict[str, object]:
    return read_measured(template, settings, gauge, per)


@out_option("-o", "--out", help="Write a design (.json).")
def _command(request: GarmentRequest, context: Context, out: Path | None) -> GarmentResult:
    result = garment(request, context)
    if out is not None:
        out.write_text(write_design(result.design), encoding="utf-8")
    return result


def _lines(r: GarmentResult) -> list[str]:
    lines = [
        f"{r.name}: {size_in_words(r.columns, r.rows)}, {r.stitches} stitches, "
        f"{r.yarn_m:.0f} m of yarn ({r.yarn_interval_m[0]:.0f} to {r.yarn_interval_m[1]:.0f}); "
        f"{r.closing}",
        f"{'region':20} {'stitches':>8} {'course':>8} {'wale':>8}  mm/N",
    ]
    lines += [
        f"{region.name:20} {region.stitches:8} {region.extensibility_course_mm_per_n:8.2f} "
        f"{region.extensibility_wale_mm_per_n:8.2f}"
        for region in r.regions
    ]
    lines += [_pressure(place) for place in r.worn]
    return lines


def _pressure(place: WornResult) -> str:
    sizes = (
        f"{place.part} at {place.at_mm:.0f} mm: {place.rest_mm:.0f} mm on {place.worn_mm:.0f} mm"
    )
    if place.mmhg is None:
        return f"{sizes}; {place.warnings[0]}"
    low, high = place.mmhg
    return f"{sizes} exerts {low:.1f} to {high:.1f} mmHg"


OPERATION = Operation(
    garment,
    tag="garments",
    summary="A garment from measurements",
    example={
        "garment": {"template": "wrist-brace", "wrist_mm": 165.0, "length_mm": 80.0},
        "material": "acrylic",
    },
    command=Command(
        _lines,
        names={"garment": None, "gauge": None, "linear_density_tex": "--tex"},
        fields=_garment_fields,
        run=_command,
    ),
)
