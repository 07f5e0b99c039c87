"""The mechanics of a chart."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from app.operations.charts import ChartInput, to_chart
from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.materials import Interval, Material
from knitcore.materials import material as find_material
from knitcore.mechanics.prediction import predict
from knitcore.segments import segment_map


class PredictRequest(BaseModel):
    """A chart and its material."""

    model_config = ConfigDict(extra="forbid")

    chart: ChartInput
    material: str = Field(max_length=80, examples=["acrylic"])


class SegmentCountsResult(BaseModel):
    """Segments of one direction by their symmetry."""

    even: int
    odd: int


class PredictResult(BaseModel):
    """Effective elastic constants of the whole chart at small strain."""

    rows: int
    columns: int
    segments: dict[Direction, SegmentCountsResult]
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float = Field(description="Contraction wale-wise when pulled course-wise.")
    poisson_xy: float = Field(description="Contraction course-wise when pulled wale-wise.")
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_interval_n_per_mm: tuple[float, float] = Field(description="90 % interval.")
    modulus_wale_interval_n_per_mm: tuple[float, float]
    provenance: str = Field(
        description="measured; yarn level; composite, corrected; or composite, stretched state only"
    )
    method: str
    notes: list[str]


def predict_request(request: PredictRequest) -> PredictResult:
    """The prediction that a request asks for."""
    return predict_chart(to_chart(request.chart), find_material(request.material))


def predict_chart(chart: StitchChart, material: Material) -> PredictResult:
    """The prediction of any chart and material."""
    found = predict(chart, material)
    segments = segment_map(chart)
    counts = {direction: segments.counts(direction) for direction in Direction}
    return PredictResult(
        rows=chart.rows,
        columns=chart.columns,
        segments={d: SegmentCountsResult(even=c.even, odd=c.odd) for d, c in counts.items()},
        modulus_course_n_per_mm=found.modulus_course_n_per_mm,
        modulus_wale_n_per_mm=found.modulus_wale_n_per_mm,
        poisson_yx=found.poisson_yx,
        poisson_xy=found.poisson_xy,
        extensibility_course_mm_per_n=found.extensibility_course_mm_per_n,
        extensibility_wale_mm_per_n=found.extensibility_wale_mm_per_n,
        modulus_course_interval_n_per_mm=_pair(found.modulus_course_interval),
        modulus_wale_interval_n_per_mm=_pair(found.modulus_wale_interval),
        provenance=found.provenance,
        method=found.method,
        notes=list(found.notes),
    )


def _pair(interval: Interval) -> tuple[float, float]:
    return interval.low, interval.high
