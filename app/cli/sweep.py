"""``knitcore sweep``."""

from __future__ import annotations

import click

from app.cli.common import (
    chart_argument,
    choice,
    direction_option,
    emit,
    flat_option,
    given_chart,
    json_option,
    loop_lengths_option,
    material_option,
)
from app.cli.materials import resolve_material
from app.operations.sweep import SweepOptions, SweepResult, sweep_chart
from knitcore.fabric import Direction
from knitcore.yarnlevel.conventions import Convention
from knitcore.yarnlevel.relax import Branch


@click.command("sweep")
@chart_argument
@material_option
@direction_option
@click.option("--max-strain", required=True, type=float, help="Largest strain: 0.5 is 50 %.")
@click.option("--points", type=click.IntRange(2, 400), default=25, show_default=True)
@click.option("--loop-length-mm", type=float, help="Yarn per stitch; the material's otherwise.")
@loop_lengths_option
@flat_option
@click.option("--slide-quenching", is_flag=True, help="No sliding where the yarn touches at rest.")
@click.option("--branch", type=choice(Branch), default=Branch.MIRRORED.value, show_default=True)
@click.option("--convention", type=choice(Convention), default=Convention.PUBLISHED.value)
@click.option("--fresh", is_flag=True, help="Compute it even if the result is known.")
@json_option
def command(
    chart: str,
    size: str | None,
    material: str,
    direction: str,
    max_strain: float,
    points: int,
    loop_length_mm: float | None,
    loop_lengths_mm: list[list[float]] | None,
    flat: bool,
    slide_quenching: bool,
    branch: str,
    convention: str,
    fresh: bool,
    as_json: bool,
) -> None:
    """Stretch the repeat CHART at the yarn level, free across, and fit its law."""
    options = SweepOptions(
        direction=Direction(direction),
        max_strain=max_strain,
        points=points,
        loop_length_mm=loop_length_mm,
        loop_lengths_mm=loop_lengths_mm,
        flat=flat,
        slide_quenching=slide_quenching,
        branch=Branch(branch),
        convention=Convention(convention),
        fresh=fresh,
    )
    result = sweep_chart(
        given_chart(chart, size, loop_lengths_mm), resolve_material(material), options
    )
    emit(result, _text(result), as_json=as_json)


def _text(r: SweepResult) -> str:
    columns = zip(r.strain, r.transverse_strain, r.stress_n_per_mm, r.energy_n_mm, strict=True)
    lines = ["strain   across   stress N/mm   energy N·mm"]
    lines += [f"{a:6.3f}  {b:7.3f}  {c:11.5f}  {d:12.5f}" for a, b, c, d in columns]
    if r.law is not None:
        lines.append(
            f"law up to {r.law.max_stress_n_per_mm:g} N/mm: Y course "
            f"{r.law.modulus_course_n_per_mm:.4f}, wale {r.law.modulus_wale_n_per_mm:.4f} N/mm, "
            f"Poisson yx {r.law.poisson_yx:.3f}, xy {r.law.poisson_xy:.3f}"
        )
    return "\n".join([*lines, *(f"note: {note}" for note in r.notes)])
