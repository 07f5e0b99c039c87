"""A yarn without a tester, from ball band, gauge, weight, ten stitches and photos of a swatch."""

from pathlib import Path

import click
from pydantic import Field

from knitcore.chart.fabric import Direction, Fabric
from knitcore.formats.read.law_files import law_from_mapping
from knitcore.materials.estimate.estimate import Estimate
from knitcore.materials.estimate.without_tester import (
    INTERVAL_SOURCE,
    KnownSwatch,
    Step,
    UntestedYarn,
    points_of_law,
    yarn_without_tester,
)
from knitcore.materials.material_document import MaterialDocument
from knitcore.materials.material_files import save_material_file
from knitcore.materials.uses import Serves, uses_of

from ...cli.options import out_option
from ...context import Context
from ...requests.base import Ends, IntervalResult, RequestModel, ResultModel
from ...requests.stretch_points import Gauge, PointModel, points_in
from ..registry import Command, Operation


class SwatchRequest(RequestModel):
    """A swatch as anyone can measure it; all but fabric and gauge may be left out."""

    fabric: Fabric
    stitches_per_10_cm: Gauge
    rows_per_10_cm: Gauge
    weight_g: float | None = Field(None, description="Weight of the whole swatch.")
    width_mm: float | None = Field(None, description="Width of the swatch at rest.")
    height_mm: float | None = Field(None, description="Height of the swatch at rest.")
    ten_stitches_mm: float | None = Field(
        None, description="Yarn in ten stitches: unravel them and measure."
    )
    tex: float | None = Field(
        None, description="Linear density on the ball band, g/km: 50 g of 100 m are 500 tex."
    )
    wraps_per_inch: float | None = Field(None, description="Wraps of the yarn around a ruler.")
    fibre: str = Field("", max_length=200, description="Fibre on the ball band.")
    name: str = Field("Own yarn", min_length=1, max_length=80, description="Name of the yarn.")
    points: list[PointModel] = Field(
        default_factory=list, max_length=12, description="Points of `measure photos`."
    )
    law: dict[str, float] | None = Field(
        None, description="Constants of a law fitted to tests of this fabric, in place of points."
    )


class KnownValue(ResultModel):
    """A value with its 90 % interval."""

    value: float
    value_interval: Ends


class StepResult(ResultModel):
    """State of knowledge after a measurement; of the swatch's fabric where it names none."""

    name: str
    loop_length_mm: KnownValue
    bending_modulus_n_mm2: KnownValue
    strain_at_0_1_n_per_mm: dict[Direction, KnownValue]
    modulus_n_per_mm: dict[Direction, KnownValue]
    other_fabrics_factor: float = Field(
        description="Mean factor of the intervals of the other fabrics' extension."
    )


class UseResult(ResultModel):
    """A use of a yarn, and what is missing for it."""

    name: str
    serves: Serves
    missing: str


class SwatchResult(IntervalResult):
    """All four fabrics of the yarn, and what each measurement brought."""

    steps: list[StepResult]
    uses: list[UseResult]
    material: MaterialDocument = Field(description="A material file of the four fabrics.")
    notes: list[str]


def swatch(request: SwatchRequest, context: Context) -> SwatchResult:
    """Laws of a yarn's four fabrics from the library's yarns and what was measured, step by step.

    Raises
    ------
    InputError
        If a number is impossible, or what was measured contradicts itself.
    """
    del context
    return _result(_untested(request), request)


def _untested(request: SwatchRequest) -> UntestedYarn:
    known = request.pass_to(KnownSwatch)
    if request.law is not None:
        law = law_from_mapping(request.law).law
        return yarn_without_tester(known, points_of_law(request.fabric, law), source="tests")
    return yarn_without_tester(known, [point.point() for point in request.points])


def _result(yarn: UntestedYarn, request: SwatchRequest) -> SwatchResult:
    material = yarn.material("own-yarn", request.name, request.fibre)
    return SwatchResult(
        steps=[_step(step) for step in yarn.steps],
        uses=[UseResult.of(use) for use in uses_of(material)],
        material=MaterialDocument.from_material(material),
        notes=list(yarn.notes),
        interval_source=INTERVAL_SOURCE,
    )


def _step(step: Step) -> StepResult:
    return StepResult(
        name=step.name,
        loop_length_mm=_estimate(step.loop_length_mm),
        bending_modulus_n_mm2=_estimate(step.bending_modulus_n_mm2),
        strain_at_0_1_n_per_mm={d: _estimate(e) for d, e in step.strain_at_load.items()},
        modulus_n_per_mm={d: _estimate(e) for d, e in step.modulus.items()},
        other_fabrics_factor=step.other_strains,
    )


def _estimate(estimate: Estimate) -> KnownValue:
    return KnownValue(value=estimate.value, value_interval=(estimate.low, estimate.high))


@click.option(
    "--points",
    "files",
    multiple=True,
    metavar="POINTS.json",
    type=click.Path(path_type=Path),
    help="Points of `knitcore measure photos --out`, one file for each direction.",
)
@out_option("--out", help="Write a material file.")
def _command(
    request: SwatchRequest, context: Context, files: tuple[Path, ...], out: Path | None
) -> SwatchResult:
    del context
    points = [point for file in files for point in points_in(file)]
    request = request.model_copy(update={"points": points})
    yarn = _untested(request)
    if out is not None:
        identifier = out.stem.lower().replace(" ", "-")
        save_material_file(yarn.material(identifier, request.name, request.fibre), out)
    return _result(yarn, request)


def _lines(r: SwatchResult) -> list[str]:
    lines = [
        f"{'after':27} {'yarn in a stitch mm':22} {'bending mN·mm²':18}"
        f" {'extension at 0.1 N/mm, rows':29} columns"
    ]
    for step in r.steps:
        course, wale = (step.strain_at_0_1_n_per_mm[d] for d in Direction)
        lines.append(
            f"{step.name:27} {_shown(step.loop_length_mm, '.1f'):22}"
            f" {_shown(step.bending_modulus_n_mm2, '.0f', 1000):18}"
            f" {_shown(course, '.0%'):29} {_shown(wale, '.0%')}"
        )
    lines.append("")
    for use in r.uses:
        missing = f": {use.missing}" if use.missing else ""
        lines.append(f"{use.serves:8} {use.name}{missing}")
    return lines


def _shown(estimate: KnownValue, form: str, factor: float = 1.0) -> str:
    numbers = estimate.value, *estimate.value_interval
    value, low, high = (format(factor * number, form) for number in numbers)
    return f"{value} ({low} to {high})"


OPERATION = Operation(
    swatch,
    path="/measure/swatch",
    tag="measure",
    summary="A yarn without a tester, from what anyone can measure of a swatch",
    example={
        "fabric": "stockinette",
        "stitches_per_10_cm": 20.0,
        "rows_per_10_cm": 28.0,
        "ten_stitches_mm": 150.0,
        "tex": 400.0,
    },
    command=Command(_lines, names={"points": None, "law": None}, run=_command),
)


class UsesRequest(RequestModel):
    """A yarn before it is kept."""

    material: MaterialDocument


class UsesResult(ResultModel):
    """Uses of the yarn, the commonest first."""

    uses: list[UseResult]


def uses(request: UsesRequest, context: Context) -> UsesResult:
    """List what a yarn serves for, and what is missing for the rest."""
    del context
    return UsesResult(uses=[UseResult.of(use) for use in uses_of(request.material.to_material())])


_LAW = {"modulus_course": 0.2, "modulus_wale": 0.4, "poisson_yx": 0.3, "poisson_xy": 0.5}
_EXAMPLE = {
    "identifier": "mine",
    "name": "Mine",
    "fabrics": {
        "stockinette": {
            "law": _LAW | {"alpha_xx": 1.5, "alpha_yy": 2.0, "beta_xx": 0.01, "beta_yy": 0.05},
            "stitch_course_mm": 5.0,
            "stitch_wale_mm": 3.6,
        }
    },
}
USES = Operation(
    uses,
    path="/measure/uses",
    tag="measure",
    summary="What a yarn serves for, before it is kept",
    example={"material": _EXAMPLE},
)
