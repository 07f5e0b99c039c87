"""``knitcore relax``."""

from __future__ import annotations

import click

from app.cli.common import (
    chart_argument,
    choice,
    emit,
    flat_option,
    given_chart,
    json_option,
    loop_lengths_option,
    material_option,
)
from app.cli.materials import resolve_material
from app.operations.relax import RelaxOptions, RelaxResult, relax_chart
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.relax import Branch


@click.command("relax")
@chart_argument
@material_option
@click.option("--loop-length-mm", type=float, help="Yarn per stitch; the material's otherwise.")
@loop_lengths_option
@flat_option
@click.option("--cell-course-mm", type=float, help="Hold a stitch at this width.")
@click.option("--cell-wale-mm", type=float, help="Hold a stitch at this height.")
@click.option("--branch", type=choice(Branch), default=Branch.MIRRORED.value, show_default=True)
@click.option("--convention", type=choice(Convention), default=Convention.PUBLISHED.value)
@click.option("--fresh", is_flag=True, help="Compute it even if the result is known.")
@json_option
def command(
    chart: str,
    size: str | None,
    material: str,
    loop_length_mm: float | None,
    loop_lengths_mm: list[list[float]] | None,
    flat: bool,
    cell_course_mm: float | None,
    cell_wale_mm: float | None,
    branch: str,
    convention: str,
    fresh: bool,
    as_json: bool,
) -> None:
    """Relax the repeat CHART at the yarn level: free of force, without friction."""
    options = RelaxOptions(
        loop_length_mm=loop_length_mm,
        loop_lengths_mm=loop_lengths_mm,
        flat=flat,
        cell_course_mm=cell_course_mm,
        cell_wale_mm=cell_wale_mm,
        branch=Branch(branch),
        convention=Convention(convention),
        fresh=fresh,
    )
    result = relax_chart(
        given_chart(chart, size, loop_lengths_mm), resolve_material(material), options
    )
    emit(result, _text(result), as_json=as_json)


def _text(r: RelaxResult) -> str:
    return "\n".join(
        [
            f"repeat          {r.repeat_columns} columns x {r.repeat_rows} rows, {r.branch} branch",
            f"stitch          {r.cell_course_mm:.3f} mm wide, {r.cell_wale_mm:.3f} mm high",
            f"energy          {r.energy_n_mm:.4f} N·mm a stitch, {100 * r.bending_share:.1f} % "
            f"bending, {100 * r.contact_share:.1f} % contact",
            f"yarn            {r.yarn_length_mm:.2f} mm a stitch; {r.yarn.provenance}",
            f"solved          {r.seconds:.2f} s CPU, {r.evaluations} evaluations, "
            f"{'converged' if r.converged else 'NOT converged'}"
            f"{'; known from before' if r.known else ''}",
            *(f"note: {note}" for note in r.notes),
        ]
    )
