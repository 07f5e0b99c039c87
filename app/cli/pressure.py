"""``knitcore pressure``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import choice, emit, json_option
from app.cli.materials import resolve_material
from app.operations.pressure import (
    PressureOptions,
    PressureResult,
    pressure_of_law,
    pressure_of_material,
)
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.formats.law_files import load_law


@click.command("pressure")
@click.option("--law", type=click.Path(path_type=Path), help="LAW.json (see `knitcore fit`).")
@click.option("--material", help="Library id or material file, with --fabric.")
@click.option("--fabric", type=choice(Fabric))
@click.option(
    "--direction", required=True, type=choice(Direction), help="Which runs around the limb."
)
@click.option("--rest-mm", type=float, help="Circumference of the unworn tube.")
@click.option("--worn-mm", type=float, required=True, help="Circumference of the limb.")
@click.option("--target-mmhg", type=float, help="Instead of --rest-mm: size a tube for it.")
@json_option
def command(
    law: Path | None,
    material: str | None,
    fabric: str | None,
    direction: str,
    rest_mm: float | None,
    worn_mm: float,
    target_mmhg: float | None,
    as_json: bool,
) -> None:
    """Pressure of a knitted tube on a limb, as an interval; never a medical class."""
    options = PressureOptions(
        direction=Direction(direction), rest_mm=rest_mm, worn_mm=worn_mm, target_mmhg=target_mmhg
    )
    if (law is None) == (material is None):
        raise InputError("law", "one of --law and --material is needed.", "Give exactly one.")
    if law is not None:
        result = pressure_of_law(load_law(law), options)
    else:
        result = pressure_of_material(
            resolve_material(material or ""), Fabric(fabric) if fabric else None, options
        )
    emit(result, _text(result), as_json=as_json)


def _text(r: PressureResult) -> str:
    lines = [
        f"pressure  {r.mmhg.low:.1f} to {r.mmhg.high:.1f} mmHg "
        f"({r.kpa.low:.2f} to {r.kpa.high:.2f} kPa), axially free to fixed",
        f"strain    {r.strain:.3f} around the limb ({r.lock_up_share:.0%} of the lock-up)",
    ]
    if r.mmhg_with_law_spread is not None:
        spread = r.mmhg_with_law_spread
        lines.append(f"          {spread.low:.1f} to {spread.high:.1f} mmHg with the law's spread")
    if r.rest_mm_for_target is not None:
        sizes = r.rest_mm_for_target
        lines.append(f"size      {sizes.low:.1f} to {sizes.high:.1f} mm unworn; middle shown above")
    return "\n".join([*lines, *(f"warning: {w}" for w in r.warnings)])
