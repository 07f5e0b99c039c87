"""The reduced-symmetry model of the four fabrics."""

from pydantic import Field

from knitcore.chart.fabric import Direction, Fabric
from knitcore.materials.law_uncertainty import RS_ERRORS, RS_LOG_SD, log_interval
from knitcore.mechanics.elastica import Parity
from knitcore.mechanics.reduced_symmetry import rs_fabrics

from ...context import Context
from ...requests.base import Ends, IntervalResult, RequestModel, ResultModel
from ...requests.charts import MaterialName
from ...requests.fabrics import Moduli
from ..registry import Command, Operation


class RSRequest(RequestModel):
    """A yarn whose shape the paper gives: acrylic or cotton."""

    material: MaterialName


class RSSegment(ResultModel):
    """The connecting segments of one direction."""

    parity: Parity
    separation_mm: float = Field(description="Distance of the segment's ends, lambda.")
    length_mm: float = Field(description="Length L of the yarn between them.")
    slope: float = Field(description="Slope v of the ends' tangent across the line between them.")
    angle_rad: float | None = Field(description="Tilt phi out of the cloth; odd segments only.")
    delta: float
    rigidity_n_per_mm: float
    modulus_n_per_mm: float
    modulus_interval_n_per_mm: Ends = Field(description="90 % interval for the knitted fabric.")
    published_n_per_mm: float | None = Field(description="The paper's value for this modulus.")


class RSFabricResult(Moduli):
    """A pure fabric in the model."""

    segments: dict[Direction, RSSegment]


class RSResult(IntervalResult):
    """The four fabrics of a yarn."""

    material: str
    fabrics: dict[Fabric, RSFabricResult]


def rs(request: RSRequest, context: Context) -> RSResult:
    """Moduli from segments as springs in series and in parallel, with the paper's values."""
    del context
    fabrics = {}
    for fabric, model in rs_fabrics(request.material).items():
        segments = {d: model.segment(d) for d in Direction}
        fabrics[fabric] = RSFabricResult.of(
            model,
            segments={
                d: RSSegment.of(
                    s.geometry,
                    rigidity_n_per_mm=s.rigidity_n_per_mm,
                    modulus_n_per_mm=s.modulus_n_per_mm,
                    published_n_per_mm=s.published_n_per_mm,
                    modulus_interval_n_per_mm=log_interval(s.modulus_n_per_mm, RS_LOG_SD),
                )
                for d, s in segments.items()
            },
        )
    return RSResult.of(request, fabrics=fabrics, interval_source=RS_ERRORS)


def _lines(result: RSResult) -> list[str]:
    lines = [f"{'':24}{'Y N/mm':>9} {'published':>10}   segment"]
    for fabric, model in result.fabrics.items():
        for direction, s in model.segments.items():
            published = "" if s.published_n_per_mm is None else f"{s.published_n_per_mm:.3f}"
            angle = "" if s.angle_rad is None else f", phi {s.angle_rad:.3f}"
            lines.append(
                f"{fabric:13}{direction:11}{s.modulus_n_per_mm:9.4f} {published:>10}   "
                f"{s.parity}: lambda {s.separation_mm:.3f} mm, L {s.length_mm:.3f} mm, "
                f"v {s.slope:.3f}{angle}"
            )
    factor = log_interval(1.0, RS_LOG_SD).high
    return [*lines, f"90 % interval of Y: a factor of {factor:.1f} either way."]


OPERATION = Operation(
    rs,
    method="GET",
    path="/rs/{material}",
    tag="mechanics",
    summary="Moduli from the shape of the yarn",
    command=Command(_lines),
)
