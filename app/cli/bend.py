"""``knitcore bend``."""

from __future__ import annotations

import click

from app.cli.common import chart_argument, emit, json_option, material_option, resolve_repeat
from app.cli.materials import resolve_material
from app.operations.bend import BendOptions, BendResult, bend_chart


@click.command("bend")
@chart_argument
@material_option
@click.option("--loop-length-mm", type=float, help="Yarn per stitch; the material's otherwise.")
@click.option("--linear-density-g-per-m", type=float, help="Of the yarn; gives bending lengths.")
@json_option
def command(
    chart: str,
    size: str | None,
    material: str,
    loop_length_mm: float | None,
    linear_density_g_per_m: float | None,
    as_json: bool,
) -> None:
    """Bending rigidity, curl and shear of the repeat CHART, without friction."""
    options = BendOptions(
        loop_length_mm=loop_length_mm, linear_density_g_per_m=linear_density_g_per_m
    )
    result = bend_chart(resolve_repeat(chart, size), resolve_material(material), options)
    emit(result, _text(result), as_json=as_json)


def _text(r: BendResult) -> str:
    shear = (
        "unknown" if r.shear_modulus_n_per_mm is None else f"{r.shear_modulus_n_per_mm:.4f} N/mm"
    )
    lines = [
        "                          along rows  along columns",
        f"curling moment [N]        {r.moment_course_n:10.4f} {r.moment_wale_n:14.4f}",
        f"bending rigidity [N·mm]   {r.bending_course_n_mm:10.4f} {r.bending_wale_n_mm:14.4f}",
        f"  other size held [N·mm]  {r.bending_held_course_n_mm:10.4f} "
        f"{r.bending_held_wale_n_mm:14.4f}",
    ]
    if r.bending_length_course_mm is not None and r.bending_length_wale_mm is not None:
        lines.append(
            f"bending length [mm]       {r.bending_length_course_mm:10.1f} "
            f"{r.bending_length_wale_mm:14.1f}"
        )
    return "\n".join(
        [
            *lines,
            f"shear modulus   {shear}",
            f"thickness       {r.thickness_mm:.2f} mm",
            f"free edges      {r.curl}",
            f"source          {r.provenance}",
            *(f"note: {note}" for note in r.notes),
        ]
    )
