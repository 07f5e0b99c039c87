"""``knitcore predict``."""

from __future__ import annotations

import click

from app.cli.common import chart_argument, emit, json_option, material_option, resolve_chart
from app.cli.materials import resolve_material
from app.operations.predict import PredictResult, predict_chart


@click.command("predict")
@chart_argument
@material_option
@json_option
def command(chart: str, size: str | None, material: str, as_json: bool) -> None:
    """Moduli, Poisson's ratios and extensibility of CHART."""
    result = predict_chart(resolve_chart(chart, size), resolve_material(material))
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
            f"source          {r.provenance} ({r.method})",
            *(f"note: {note}" for note in r.notes),
        ]
    )
