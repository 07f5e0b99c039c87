"""``knitcore stretch``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import (
    chart_argument,
    check_writable,
    choice,
    direction_option,
    emit,
    json_option,
    material_option,
    resolve_piece,
)
from app.cli.materials import resolve_material
from app.operations.stretch import StretchCurve, StretchOptions, stretch_chart, stretch_curve
from app.operations.stretch_margins import stretch_margins
from knitcore.errors import InputError
from knitcore.fabric import Direction
from knitcore.swatch import EnergyModel


@click.command("stretch")
@chart_argument
@material_option
@direction_option
@click.option("--strain", required=True, type=float, help="Last strain: 0.5 is 50 %.")
@click.option("--steps", type=click.IntRange(1, 1000), default=12, show_default=True)
@click.option("--model", type=choice(EnergyModel), default=EnergyModel.FULL.value)
@click.option("--shear-modulus", type=float, help="C_xyxy in N/mm (an assumption otherwise).")
@click.option("--width-mm", type=float, help="Size course-wise; from the gauge otherwise.")
@click.option("--length-mm", type=float, help="Size wale-wise; from the gauge otherwise.")
@click.option("--out", type=click.Path(path_type=Path), help="Write fields to FILE.npz or .vtu.")
@json_option
def command(
    chart: str,
    size: str | None,
    material: str,
    direction: str,
    strain: float,
    steps: int,
    model: str,
    shear_modulus: float | None,
    width_mm: float | None,
    length_mm: float | None,
    out: Path | None,
    as_json: bool,
) -> None:
    """Pull CHART between two clamps: a simulated strip test, not a certified one."""
    if out is not None and out.suffix.lower() not in (".npz", ".vtu"):
        raise InputError("out", f"{out.name} is of no known kind.", "Use .npz or .vtu.")
    check_writable(out, "out")
    piece = resolve_piece(chart, size)
    options = StretchOptions(
        direction=Direction(direction),
        strain=strain,
        steps=steps,
        model=EnergyModel(model),
        shear_modulus_n_per_mm=shear_modulus,
        width_mm=width_mm,
        length_mm=length_mm,
    )
    yarn = resolve_material(material)
    test = stretch_chart(piece.chart, yarn, options, stitch=piece.shaped.stitch)
    if out is not None:
        from knitcore.swatch.files import write_fields

        write_fields(test, out)
    margins = stretch_margins(test, yarn, options.clamps)
    curve = stretch_curve(piece.chart, options, test, margins)
    emit(curve, _text(curve), as_json=as_json)


def _text(curve: StretchCurve) -> str:
    lines = [f"{'strain':>8} {'force N':>9} {'90 %':>17} {'N/mm':>8} {'waist':>8}"]
    rows = zip(
        curve.strain,
        curve.force_n,
        curve.force_low_n,
        curve.force_high_n,
        curve.stress_n_per_mm,
        curve.waist_strain,
        strict=True,
    )
    lines += [
        f"{e:8.3f} {f:9.3f} {low:8.3f}-{high:<8.3f} {s:8.4f} {w:8.3f}"
        for e, f, low, high, s, w in rows
    ]
    if curve.nearest_lock_up is not None:
        spot = curve.nearest_lock_up
        lines.append(
            f"nearest to lock-up: {spot.utilisation:.0%} {spot.direction}-wise in {spot.fabric}, "
            f"row {spot.row}, stitch {spot.column}"
        )
    return "\n".join([*lines, *curve.messages])
