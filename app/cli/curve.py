"""``knitcore curve``."""

from __future__ import annotations

import click
import numpy as np

from app.cli.common import (
    chart_argument,
    direction_option,
    emit,
    gauge_options,
    json_option,
    material_option,
    resolve_chart,
    resolve_gauge,
)
from app.cli.materials import resolve_material
from app.operations.curve import curve_of_chart
from knitcore.fabric import Direction


@click.command("curve")
@chart_argument
@material_option
@direction_option
@click.option(
    "--max-stress",
    type=click.FloatRange(0, 100, min_open=True),
    default=0.3,
    show_default=True,
    help="Last stress in N/mm.",
)
@click.option("--points", type=click.IntRange(2, 500), default=31, show_default=True)
@gauge_options
@json_option
def command(
    chart: str,
    size: str | None,
    material: str,
    direction: str,
    max_stress: float,
    points: int,
    stitches_per_10_cm: float | None,
    rows_per_10_cm: float | None,
    as_json: bool,
) -> None:
    """Stress-strain curve of CHART: a pure fabric, rib, welt or repeat of up to 256 stitches."""
    result = curve_of_chart(
        resolve_chart(chart, size),
        resolve_material(material),
        Direction(direction),
        np.linspace(0, max_stress, points).tolist(),
        resolve_gauge(stitches_per_10_cm, rows_per_10_cm),
    )
    lines = [f"{'N/mm':>8} {'strain':>8}   90 % interval"]
    columns = (result.stress_n_per_mm, result.strain, result.strain_low, result.strain_high)
    lines += [
        f"{s:8.4f} {e:8.4f}   {a:.4f} to {b:.4f}" for s, e, a, b in zip(*columns, strict=True)
    ]
    emit(result, "\n".join([*lines, f"source: {result.provenance}"]), as_json=as_json)
