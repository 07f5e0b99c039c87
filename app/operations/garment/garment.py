"""Garments from measurements."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import size_in_words
from knitcore.formats.designs.design_file import DesignFile, write_design
from knitcore.formats.designs.garment_design import design_of_plan
from knitcore.garment.gauge import Gauge, GaugeSet
from knitcore.garment.plan import GarmentPlan
from knitcore.garment.worn_piece import Worn
from knitcore.materials import Material
from knitcore.materials.law_uncertainty import log_interval
from knitcore.materials.yarn_per_stitch import MeasuredYarn

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Ends, IntervalResult, ResultModel
from ...requests.charts import CellLines, ChartLines, RepeatText
from ...requests.fabrics import Extensibility, HandPullResult, Moduli, YarnPerStitch
from ...requests.garments import LENGTHS, AnyTemplate, KnitterRequest
from ...requests.sizes import SizeResult, SizeSteps, size_lines, sizes_of
from ..registry import Command, Operation

MATERIAL_ERRORS = (
    "Sizes: the material's gauge, with one aspect ratio of stitches for all yarns (8 %); "
    "a gauge of your own makes them more certain."
)
SWATCH_ERRORS = (
    "Sizes: a counted gauge (3 %), and for fabrics other than the swatch's the aspect ratio "
    "of stitches (8 %)."
)


class GarmentRequest(KnitterRequest):
    """A template with measurements, and the yarn."""

    garment: AnyTemplate
    linear_density_tex: float | None = Field(
        None, gt=0, lt=1e5, description="Linear density of the yarn (g/km), for its mass."
    )
    yarn_per_stitch_mm: YarnPerStitch = Field(
        None,
        description="Yarn in a stitch of the swatch in the gauge's fabric, or in stockinette: "
        "unravelled, or weighed (1,000,000 × g ÷ tex ÷ stitches); the material's by default.",
    )
    intarsia: bool = Field(False, description="Knit each fabric with a yarn of its own.")
    sizes: SizeSteps | None = Field(
        None, description="Steps between sizes, for a table of them in the result and the design."
    )

    def gauges(self, material: Material) -> GaugeSet:
        """The gauges of the four fabrics, with the yarn in a stitch of the swatch."""
        gauges = super().gauges(material)
        if (mm := self.yarn_per_stitch_mm) is None:
            return gauges
        fabric = self.gauge.fabric if self.gauge else Fabric.STOCKINETTE
        return replace(gauges, measured_yarn=MeasuredYarn(mm, fabric))


class RegionResult(Moduli, Extensibility):
    """One region: its repeat, colour and size, and the numbers of its fabric."""

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
    hand: HandPullResult = Field(description="Stretch of its fabric at the pull of a hand.")
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
    notes: list[str] = Field(description="For the knitter.")
    warnings: list[str] = Field(
        description="What the plan cannot do, and borders between regions of different gauge."
    )
    sizes: list[SizeResult] = Field([], description="The garment in every size, where asked.")
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
    yarn: dict[str, Any] = {"material": material, "gauges": gauges, "linear_density_tex": tex}
    plan = request.garment.plan(**yarn)
    sizes = (
        sizes_of(request.garment, request.sizes, lambda template: template.plan(**yarn))
        if request.sizes
        else []
    )
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
        interval_source=f"{SWATCH_ERRORS if request.gauge else MATERIAL_ERRORS} Yarn: "
        f"{plan.yarn.source}.",
        warnings=[*plan.cautions, *(misfit.text for misfit in plan.misfits)],
        sizes=sizes,
        design=request.pass_to(design_of_plan, plan, notes=tuple(size_lines(sizes))),
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
    for name, length in LENGTHS.items():
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
        click.option("--per", type=click.Choice(list(LENGTHS)), default="10 cm"),
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
@click.option(
    "--sizes",
    nargs=2,
    type=float,
    metavar="WIDER LONGER",
    help="A table of sizes, each so many percent wider and longer than the one before.",
)
def _garment_fields(
    template: str,
    settings: tuple[str, ...],
    gauge: str | None,
    per: str,
    sizes: tuple[float, float] | None,
) -> dict[str, object]:
    fields = read_measured(template, settings, gauge, per)
    if sizes is not None:
        fields["sizes"] = {"wider_percent": sizes[0], "longer_percent": sizes[1]}
    return fields


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
        f"{'region':20} {'stitches':>8} {'course':>8} {'wale':>8}  stretch at a hand's pull",
    ]
    lines += [
        f"{region.name:20} {region.stitches:8} {region.hand.course.strain:8.0%} "
        f"{region.hand.wale.strain:8.0%}"
        for region in r.regions
    ]
    lines += [_pressure(place) for place in r.worn]
    return [*lines, *size_lines(r.sizes)]


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
        names={"garment": None, "gauge": None, "sizes": None, "linear_density_tex": "--tex"},
        fields=_garment_fields,
        run=_command,
    ),
)
