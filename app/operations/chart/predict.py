"""The mechanics of a chart."""

from typing import Any

from pydantic import Field

from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.segments import SegmentCounts, segment_map
from knitcore.chart.stitch_chart import StitchChart, size_in_words
from knitcore.chart.symbol_chart import SymbolChart, knits_and_purls
from knitcore.design.certainty import Remedy, narrowings
from knitcore.draw.laid_out import size_at_rest
from knitcore.garment.shaped import ShapedChart, outline_marks
from knitcore.materials import Material
from knitcore.materials.interval_parts import Part
from knitcore.materials.yarn_per_stitch import has_loop_length, mean_yarn
from knitcore.prediction.hand import PULLS_N_PER_MM, hand_pulls
from knitcore.prediction.predict import predict as predict_chart
from knitcore.prediction.prediction import Prediction
from knitcore.prediction.stitch_effects import StitchDensities
from knitcore.prediction.swept import worth_relaxing

from ...context import Context
from ...requests.base import Ends, IntervalResult, ResultModel
from ...requests.charts import OutlineInput
from ...requests.fabrics import ElasticConstants, Extensibility, HandPullResult, StitchesRequest
from ..registry import Command, Operation


class PredictRequest(StitchesRequest):
    """A chart and its material; constants of a shaped piece are those of the largest rectangle
    inside its outline, its size is that of the whole. A chart of other stitches than knit and purl
    is a rectangle."""

    outline: OutlineInput = None
    hand: bool = Field(
        False, description="Also tell how far the chart stretches at three pulls of a hand."
    )


class NarrowingResult(ResultModel):
    """Where the interval of a number comes from, and what would narrow it."""

    quantity: str = Field(
        description="Field of the number in this result; strain_course or strain_wale for the "
        "stretch at a pull."
    )
    n_per_mm: float | None = Field(description="Force per width of a strain, else null.")
    shares: dict[Part, float] = Field(
        description="Shares of the parts in the variance of the logarithm (of a Poisson's ratio, "
        "of its own variance), the largest first."
    )
    now: Ends = Field(description="90 % interval, in the unit of the quantity.")
    act: Remedy | None = Field(
        description="What would remove the largest part that can be: a gauge counted "
        "(`gauge`), a swatch weighed (`yarn_per_stitch_mm` of a garment), or a strip pulled "
        "(`measure pull`); null if nothing helps."
    )
    how: str = Field(description="The same in words; empty if nothing helps.")
    left: Ends | None = Field(description="The interval after it.")
    fabric: Fabric | None = Field(description="Of the strip to pull.")
    direction: Direction | None = Field(description="In which it is pulled.")


class SegmentCountsResult(ResultModel, SegmentCounts):
    """Segments of one direction by their symmetry."""


class OtherStitchesResult(ResultModel):
    """Stitches of a chart that are neither knit nor purl, as shares of all."""

    yarn_overs: float
    slips: float
    tucks: float
    crossings: float = Field(description="Pairs of stitches that cross: a 2/2 cable has 4.")
    leans: float = Field(description="Wales by which the mean stitch of lace leans.")
    longest_float_mm: float = Field(
        description="Longest stretch of yarn behind or in front of slipped stitches, at rest."
    )
    longest_float_interval_mm: Ends
    yarn_m: float | None = Field(
        description="Yarn of the chart, without cast-on and tails; null if the material has no "
        "loop length."
    )
    yarn_interval_m: Ends | None


class PredictResult(ElasticConstants, Extensibility, IntervalResult):
    """Effective elastic constants of the whole chart at small strain, with 90 % intervals."""

    rows: int = Field(description="Size of the chart that the constants describe.")
    columns: int
    segments: dict[Direction, SegmentCountsResult]
    modulus_course_interval_n_per_mm: Ends
    modulus_wale_interval_n_per_mm: Ends
    poisson_yx_interval: Ends
    poisson_xy_interval: Ends
    modulus_course_bounds_n_per_mm: Ends = Field(
        description="Reuss and Voigt bounds, widened where folds require it."
    )
    modulus_wale_bounds_n_per_mm: Ends
    shear_modulus_n_per_mm: float = Field(
        description="Shear modulus; an assumption unless it was calibrated."
    )
    relaxed_course_mm: float = Field(description="Mean width of a stitch at rest.")
    relaxed_wale_mm: float = Field(description="Mean height of a stitch at rest.")
    relaxed_course_interval_mm: Ends
    relaxed_wale_interval_mm: Ends
    relaxed_source: str
    yarn_per_stitch_mm: float | None = Field(
        description="Yarn in the mean stitch; null if the material has no loop length."
    )
    yarn_per_stitch_interval_mm: Ends | None
    other_stitches: OtherStitchesResult | None = Field(
        description="Null where all stitches are knits and purls."
    )
    width_mm: float = Field(description="Width of the whole piece at rest, at its widest.")
    height_mm: float = Field(description="Height of the whole piece at rest, at its highest.")
    width_interval_mm: Ends
    height_interval_mm: Ends
    provenance: str = Field(
        description="Source of the constants: measured; estimated; swept; learned; learned with "
        "known size; or learned with other stitches."
    )
    method: str
    worth_relaxing: str | None = Field(
        description="Chart of the repeat whose relaxation (`relax`, some seconds) has a `gauge` "
        "with which these numbers would be more certain; null if there is none."
    )
    notes: list[str]
    hand: list[HandPullResult] = Field(description="By growing pull; empty unless asked for.")
    narrowing: list[NarrowingResult] = Field(
        description="What the intervals come from, and what would narrow them."
    )


def predict(request: PredictRequest, context: Context) -> PredictResult:
    """Effective constants with their 90 % intervals and their source."""
    stitches, material = request.stitches(context)
    whole = stitches if isinstance(stitches, StitchChart) else stitches.plain
    shaped = ShapedChart.rectangle(whole)
    if request.outline is not None:
        shaped = ShapedChart(knits_and_purls(stitches), outline_marks(request.outline))
    chart, notes = shaped.rectangle_inside(), []
    described = chart if isinstance(stitches, StitchChart) else stitches
    if not shaped.is_rectangle:
        notes.append(
            "All but the size is of the largest rectangle inside the outline, "
            f"{chart.columns} x {chart.rows} stitches."
        )
    predicted = predict_chart(described, material, request.relaxed_size)
    segments = segment_map(chart)
    to_relax = worth_relaxing(chart, material, predicted)
    given = {
        "rows": chart.rows,
        "columns": chart.columns,
        "segments": {direction: segments.counts(direction) for direction in Direction},
        "worth_relaxing": None if to_relax is None else to_relax.text,
        **(yarn := _yarn(described, material)),
        "other_stitches": None
        if isinstance(described, StitchChart)
        else _others(described, predicted) | _yarn_of_all(described, yarn),
        "notes": [*notes, *predicted.notes],
        "narrowing": narrowings(described, material, predicted),
        "hand": hand_pulls(material, predicted) if request.hand else [],
    }
    whole_piece = vars(size_at_rest(shaped, material, predicted))
    return PredictResult.model_validate(predicted.to_dict() | whole_piece | given)


def _yarn(chart: StitchChart | SymbolChart, material: Material) -> dict[str, Any]:
    """Yarn in the mean stitch, or nulls."""
    known = has_loop_length(material)
    mean, ends = mean_yarn(chart, material) if known else (None, None)
    return {"yarn_per_stitch_mm": mean, "yarn_per_stitch_interval_mm": ends}


def _yarn_of_all(chart: SymbolChart, yarn: dict[str, Any]) -> dict[str, Any]:
    """Yarn of a chart, from that in its mean stitch."""
    mean, ends = yarn["yarn_per_stitch_mm"], yarn["yarn_per_stitch_interval_mm"]
    if mean is None:
        return {"yarn_m": None, "yarn_interval_m": None}
    metres = chart.cells.size / 1000
    return {"yarn_m": mean * metres, "yarn_interval_m": [end * metres for end in ends]}


def _others(chart: SymbolChart, predicted: Prediction) -> dict[str, Any]:
    """Densities of a chart's other stitches, and its longest float."""
    passed = chart.graph.longest_float()
    wales = passed + 1 if passed else 0
    return vars(StitchDensities.of(chart)) | {
        "longest_float_mm": wales * predicted.relaxed_course_mm,
        "longest_float_interval_mm": [wales * mm for mm in predicted.course.relaxed_interval_mm],
    }


def _lines(r: PredictResult) -> list[str]:
    course, wale = r.segments.values()
    low_x, high_x = r.modulus_course_interval_n_per_mm
    low_y, high_y = r.modulus_wale_interval_n_per_mm
    return [
        f"{size_in_words(r.columns, r.rows)}",
        f"segments        course {course.even} even, {course.odd} odd   "
        f"wale {wale.even} even, {wale.odd} odd",
        f"Young's modulus course {r.modulus_course_n_per_mm:.4f} N/mm "
        f"(90 %: {low_x:.4f} to {high_x:.4f})",
        f"                wale   {r.modulus_wale_n_per_mm:.4f} N/mm "
        f"(90 %: {low_y:.4f} to {high_y:.4f})",
        f"extensibility   course {r.extensibility_course_mm_per_n:.2f} mm/N   "
        f"wale {r.extensibility_wale_mm_per_n:.2f} mm/N",
        f"Poisson's ratio yx {r.poisson_yx:.3f}   xy {r.poisson_xy:.3f}",
        f"stitch at rest  {_relaxed(r)}",
        f"size at rest    {r.width_mm / 10:.1f} x {r.height_mm / 10:.1f} cm",
        *_yarn_line(r),
        *_others_line(r),
        *(_hand_line(pull) for pull in r.hand),
        *_narrowing_lines(r),
        f"source          {r.provenance} ({r.method})",
    ]


def _hand_line(pull: HandPullResult) -> str:
    along = []
    for direction, of in (("course", pull.course), ("wale", pull.wale)):
        low, high = of.strain_interval
        along.append(f"{direction} {of.strain:.0%} ({low:.0%} to {high:.0%}, {of.word})")
    return f"{pull.pull + ' pull':<16}{'   '.join(along)} at {pull.n_per_mm:g} N/mm"


def _narrowing_lines(r: PredictResult) -> list[str]:
    """A line for each act, with the intervals that it would leave."""
    shown = dict(_SHORT) if r.hand else {k: v for k, v in _SHORT.items() if k[1] is None}
    lines: dict[str, list[str]] = {}
    for of in r.narrowing:
        name = shown.get((of.quantity, of.n_per_mm))
        if of.left is not None and name:
            low, high = of.left
            lines.setdefault(of.how, []).append(f"{name} {low:.3g} to {high:.3g}")
    return [f"to narrow       {how}: {', '.join(left)}" for how, left in lines.items()]


def _yarn_line(r: PredictResult) -> list[str]:
    if r.yarn_per_stitch_mm is None or r.yarn_per_stitch_interval_mm is None:
        return []
    low, high = r.yarn_per_stitch_interval_mm
    return [
        f"yarn            {r.yarn_per_stitch_mm:.2f} mm a stitch (90 %: {low:.2f} to {high:.2f})"
    ]


def _others_line(r: PredictResult) -> list[str]:
    of = r.other_stitches
    if of is None:
        return []
    low, high = of.longest_float_interval_mm
    floats = f", floats up to {of.longest_float_mm:.1f} mm (90 %: {low:.1f} to {high:.1f})"
    counts = {"yarn overs": of.yarn_overs, "slips": of.slips, "tucks": of.tucks}
    shown = [f"{share:.0%} {name}" for name, share in counts.items() if share]
    crossings = [f"{of.crossings:.2f} crossings a stitch"] if of.crossings else []
    lines = [f"other stitches  {', '.join([*shown, *crossings])}{floats * (high > 0)}"]
    if of.yarn_m is not None and of.yarn_interval_m is not None:
        least, most = of.yarn_interval_m
        lines.append(f"yarn of all     {of.yarn_m:.3g} m (90 %: {least:.3g} to {most:.3g})")
    return lines


def _relaxed(r: PredictResult) -> str:
    (low_x, high_x), (low_y, high_y) = r.relaxed_course_interval_mm, r.relaxed_wale_interval_mm
    return (
        f"{r.relaxed_course_mm:.2f} x {r.relaxed_wale_mm:.2f} mm (90 %: {low_x:.2f} to "
        f"{high_x:.2f} x {low_y:.2f} to {high_y:.2f}; {r.relaxed_source})"
    )


_SHORT = {
    ("relaxed_course_mm", None): "stitch width",
    ("relaxed_wale_mm", None): "stitch height",
    ("modulus_course_n_per_mm", None): "modulus course",
    ("modulus_wale_n_per_mm", None): "modulus wale",
    ("strain_course", PULLS_N_PER_MM["hand"]): "hand pull course",
    ("strain_wale", PULLS_N_PER_MM["hand"]): "hand pull wale",
    ("yarn_per_stitch_mm", None): "yarn",
}
"""Words for the numbers that the command prints."""
OPERATION = Operation(
    predict,
    tag="mechanics",
    summary="Moduli and extensibility of a chart",
    example={"chart": "KKPP", "material": "acrylic"},
    command=Command(_lines),
)
