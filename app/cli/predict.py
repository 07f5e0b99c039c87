"""``knitcore predict``."""

from __future__ import annotations

import click

from app.cli.common import (
    chart_argument,
    emit,
    gauge_options,
    json_option,
    material_option,
    resolve_gauge,
    resolve_piece,
)
from app.cli.materials import resolve_material
from app.operations.predict import PredictResult, predict_shaped


@click.command("predict")
@chart_argument
@material_option
@gauge_options
@json_option
def command(
    chart: str,
    size: str | None,
    material: str,
    stitches_per_10_cm: float | None,
    rows_per_10_cm: float | None,
    as_json: bool,
) -> None:
    """Moduli, Poisson's ratios and extensibility of CHART."""
    gauge = resolve_gauge(stitches_per_10_cm, rows_per_10_cm)
    shaped = resolve_piece(chart, size).shaped
    result = predict_shaped(shaped, resolve_material(material), gauge)
    emit(result, _text(result), as_json=as_json)


def _text(r: PredictResult) -> str:
    course, wale = r.segments.values()
    low_x, high_x = r.modulus_course_interval_n_per_mm
    low_y, high_y = r.modulus_wale_interval_n_per_mm
    return "\n".join(
        [
            f"{r.columns} columns x {r.rows} rows",
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
            f"source          {r.provenance} ({r.method})",
            *(f"note: {note}" for note in r.notes),
        ]
    )


def _relaxed(r: PredictResult) -> str:
    if r.relaxed_course_mm is None or r.relaxed_wale_mm is None:
        return "not certified: knit a swatch and give its gauge"
    return f"{r.relaxed_course_mm:.2f} x {r.relaxed_wale_mm:.2f} mm ({r.relaxed_source})"
