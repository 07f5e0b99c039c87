"""The mechanics of a chart."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from app.operations.charts import MAX_TEXT, ChartInput, to_chart
from app.results.own_materials import find_material
from knitcore.answer.prediction import predict
from knitcore.answer.relaxed import RelaxedSize
from knitcore.answer.stored import known_repeat
from knitcore.chart import StitchChart
from knitcore.fabric import Direction
from knitcore.garment.inscribed import largest_rectangle
from knitcore.garment.shaped import ShapedChart, outline_marks
from knitcore.materials import Interval, Material
from knitcore.segments import segment_map

IntervalResult = tuple[float, float]


class GaugeInput(BaseModel):
    """A swatch's gauge: what you counted on your own relaxed cloth."""

    model_config = ConfigDict(extra="forbid")

    stitches_per_10_cm: float = Field(gt=0, le=1000, allow_inf_nan=False)
    rows_per_10_cm: float = Field(gt=0, le=1000, allow_inf_nan=False)

    def relaxed_size(self) -> RelaxedSize:
        """The relaxed size of one stitch."""
        return RelaxedSize.from_gauge(self.stitches_per_10_cm, self.rows_per_10_cm)


class PredictRequest(BaseModel):
    """A chart and its material."""

    model_config = ConfigDict(extra="forbid")

    chart: ChartInput
    material: str = Field(max_length=80, examples=["acrylic"])
    outline: str | None = Field(
        None,
        max_length=MAX_TEXT,
        description="Lines of x (stitch) and . (no stitch), the top row first; all stitches if "
        "left out. The constants are then those of the largest rectangle inside.",
    )
    gauge: GaugeInput | None = Field(
        None, description="Corrects the draw-in of ribs and welts; from a table otherwise."
    )


class SegmentCountsResult(BaseModel):
    """Segments of one direction by their symmetry."""

    even: int
    odd: int


class PredictResult(BaseModel):
    """Effective elastic constants of the whole chart at small strain; intervals cover 90 %."""

    rows: int = Field(description="Of the stitches that the constants are of.")
    columns: int
    segments: dict[Direction, SegmentCountsResult]
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float = Field(description="Contraction wale-wise when pulled course-wise.")
    poisson_xy: float = Field(description="Contraction course-wise when pulled wale-wise.")
    extensibility_course_mm_per_n: float
    extensibility_wale_mm_per_n: float
    modulus_course_interval_n_per_mm: IntervalResult
    modulus_wale_interval_n_per_mm: IntervalResult
    poisson_yx_interval: IntervalResult
    poisson_xy_interval: IntervalResult
    modulus_course_bounds_n_per_mm: IntervalResult = Field(description="Reuss and Voigt.")
    modulus_wale_bounds_n_per_mm: IntervalResult
    shear_modulus_n_per_mm: float = Field(description="An assumption unless it was calibrated.")
    relaxed_course_mm: float | None = Field(
        description="Mean width of a stitch at rest; null where it is not certified."
    )
    relaxed_wale_mm: float | None
    relaxed_source: str
    provenance: str = Field(
        description="measured; yarn level; estimated; composite, corrected; or composite, "
        "stretched state only"
    )
    method: str
    notes: list[str]


def predict_request(request: PredictRequest) -> PredictResult:
    """The prediction that a request asks for."""
    chart = to_chart(request.chart)
    material = find_material(request.material)
    if request.outline is None:
        return predict_chart(chart, material, request.gauge)
    shaped = ShapedChart(chart, outline_marks(request.outline))
    return predict_shaped(shaped, material, request.gauge)


def predict_shaped(
    shaped: ShapedChart, material: Material, gauge: GaugeInput | None = None
) -> PredictResult:
    """The prediction of the largest rectangle inside an outline."""
    inside = StitchChart(shaped.chart.purl[largest_rectangle(shaped.stitch)])
    found = predict_chart(inside, material, gauge)
    if shaped.stitch.all():
        return found
    size = f"{inside.columns} x {inside.rows}"
    note = f"Of the largest rectangle inside the outline, {size} stitches."
    return found.model_copy(update={"notes": [note, *found.notes]})


def predict_chart(
    chart: StitchChart, material: Material, gauge: GaugeInput | None = None
) -> PredictResult:
    """The prediction of any chart and material."""
    known = known_repeat(chart, material)
    relaxed = gauge.relaxed_size() if gauge else known.relaxed if known else None
    found = predict(chart, material, relaxed=relaxed, repeat_law=known.law if known else None)
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
        poisson_yx_interval=_pair(found.poisson_yx_interval),
        poisson_xy_interval=_pair(found.poisson_xy_interval),
        modulus_course_bounds_n_per_mm=_pair(found.modulus_course_bounds),
        modulus_wale_bounds_n_per_mm=_pair(found.modulus_wale_bounds),
        shear_modulus_n_per_mm=found.shear_modulus_n_per_mm,
        relaxed_course_mm=found.relaxed_course_mm,
        relaxed_wale_mm=found.relaxed_wale_mm,
        relaxed_source=found.relaxed_source,
        provenance=found.provenance,
        method=found.method,
        notes=[*found.notes, *(known.notes if known else ())],
    )


def _pair(interval: Interval) -> IntervalResult:
    return interval.low, interval.high
