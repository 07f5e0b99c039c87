"""``knitcore rs``."""

from __future__ import annotations

import click

from app.cli.common import emit, json_option, material_option
from app.operations.rs import RSResult, rs_material


@click.command("rs")
@material_option
@json_option
def command(material: str, as_json: bool) -> None:
    """The reduced-symmetry model of the four fabrics (acrylic or cotton)."""
    result = rs_material(material)
    emit(result, _text(result), as_json=as_json)


def _text(result: RSResult) -> str:
    lines = [f"{'':24}{'Y N/mm':>9} {'published':>10}   segment"]
    for fabric, found in result.fabrics.items():
        for direction, s in found.segments.items():
            published = "" if s.published_n_per_mm is None else f"{s.published_n_per_mm:.3f}"
            angle = "" if s.angle_rad is None else f", phi {s.angle_rad:.3f}"
            lines.append(
                f"{fabric:13}{direction:11}{s.modulus_n_per_mm:9.4f} {published:>10}   "
                f"{s.parity}: lambda {s.separation_mm:.3f} mm, L {s.length_mm:.3f} mm, "
                f"v {s.slope:.3f}{angle}"
            )
    return "\n".join(lines)
