"""``knitcore compare``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import choice, direction_option, emit, json_option
from app.operations.field import (
    CompareResult,
    FrameErrorResult,
    chosen_frames,
    compare_field,
    law_and_model,
)
from knitcore.fabric import Direction, Fabric
from knitcore.swatch.comparison import Edges
from knitcore.swatch.measured import load_field
from knitcore.swatch.models import EnergyModel


@click.command("compare")
@click.argument("field", type=click.Path(path_type=Path))
@click.option("--law", type=click.Path(path_type=Path), help="Law file, such as `calibrate` wrote.")
@click.option("--material", help="Library id, instead of --law.")
@click.option("--fabric", type=choice(Fabric), help="Fabric of the material.")
@direction_option
@click.option("--edges", type=choice(Edges), default=Edges.MEASURED.value, show_default=True)
@click.option("--model", type=choice(EnergyModel), help="full, or what the law file says.")
@click.option("--frame", "frames", type=int, multiple=True, help="Picture to use (repeatable).")
@json_option
def command(
    field: Path,
    law: Path | None,
    material: str | None,
    fabric: str | None,
    direction: str,
    edges: str,
    model: str | None,
    frames: tuple[int, ...],
    as_json: bool,
) -> None:
    """Compare a law with the measured displacement FIELD (.npz)."""
    chosen, sheet_model = law_and_model(
        law,
        material,
        Fabric(fabric) if fabric else None,
        EnergyModel(model) if model else None,
    )
    measured = chosen_frames(load_field(field), frames)
    result = compare_field(measured, chosen, Direction(direction), Edges(edges), sheet_model)
    emit(result, _text(result), as_json=as_json)


def _text(r: CompareResult) -> str:
    return "\n".join(
        [f"{r.model} model, {r.edges} edges", *errors_table(r.frames), *r.messages],
    )


def errors_table(frames: list[FrameErrorResult]) -> list[str]:
    """Lines of a table, in percent of the width."""
    head = f"{'frame':>6} {'stretch':>8} {'ux rms':>7} {'ux max':>7} {'uy rms':>7} {'uy max':>7}"
    return [
        head + "   (% of width)",
        *(
            f"{f.frame:6d} {f.applied_stretch:8.3f} {f.ux_rms_percent_width:7.2f} "
            f"{f.ux_max_percent_width:7.2f} {f.uy_rms_percent_width:7.2f} "
            f"{f.uy_max_percent_width:7.2f}"
            for f in frames
        ),
    ]
