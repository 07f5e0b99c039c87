"""``knitcore calibrate``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import choice, direction_option, emit, json_option
from app.cli.compare import errors_table
from app.cli.materials import resolve_material
from app.operations.field import (
    CalibrateResult,
    calibrate_field,
    calibrate_result,
    chosen_frames,
    save_calibration,
)
from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.swatch.measured import load_field


@click.command("calibrate")
@click.argument("field", type=click.Path(path_type=Path))
@click.argument("more_tests", nargs=-1, metavar="", type=click.Path(path_type=Path))
@click.option("--material", required=True, help="Library id or a material file: the law to start.")
@click.option("--fabric", required=True, type=choice(Fabric))
@direction_option
@click.option(
    "--tests",
    multiple=True,
    metavar="TEST...",
    type=click.Path(path_type=Path),
    help="Stretch tests: of the direction (forces), or course and wale (forces and start).",
)
@click.option("--frame", "frames", type=int, multiple=True, help="Picture to use (repeatable).")
@click.option("--out", required=True, type=click.Path(path_type=Path), help="LAW.json to write.")
@json_option
def command(
    field: Path,
    more_tests: tuple[Path, ...],
    material: str,
    fabric: str,
    direction: str,
    tests: tuple[Path, ...],
    frames: tuple[int, ...],
    out: Path,
    as_json: bool,
) -> None:
    """Fit shear modulus and couplings to the measured displacement FIELD (.npz)."""
    if more_tests and not tests:
        raise InputError("tests", f"{more_tests[0]} is unexpected.", "Put --tests before tests.")
    if not out.parent.is_dir():
        raise InputError("out", f"{out.parent} is no folder.", "Name a file in one that exists.")
    pull = Direction(direction)
    measured = load_field(field)
    law = resolve_material(material).law(Fabric(fabric))
    used = chosen_frames(measured, frames)
    found = calibrate_field(used, law, pull, [*tests, *more_tests])
    numbers = ", ".join(str(number) for number in found.frames)
    source = f"{material} {fabric}, calibrated {direction}-wise on {field.name}, frames {numbers}"
    save_calibration(found, source, out)
    result = calibrate_result(measured, found, pull)
    emit(result, _text(result, out), as_json=as_json)


def _text(r: CalibrateResult, out: Path) -> str:
    lines = [
        f"{name:20} {value:8.4f} ± {r.standard_errors[name]:.4f}"
        for name, value in r.parameters.items()
    ]
    lines += errors_table(r.comparison)
    if r.force_ratio:
        low, high = min(r.force_ratio), max(r.force_ratio)
        lines.append(f"simulated / measured force: {low:.2f} to {high:.2f}")
    return "\n".join([*lines, f"written to {out}"])
