"""``knitcore find``."""

from __future__ import annotations

import re
from pathlib import Path

import click

from app.cli.common import emit, json_option
from app.cli.materials import resolve_material
from app.operations.atlas import (
    FindResult,
    TargetInput,
    find_in,
    repeats_of,
)
from knitcore.design.atlas import Atlas, build_atlas, load_atlas
from knitcore.design.find import Quantity
from knitcore.errors import InputError

_TARGET = re.compile(r"([a-z_]+)=([\d.eE+-]+)(?:~([\d.]+)%)?(?:\*([\d.]+))?")
_SHORT = {
    "course": Quantity.MODULUS_COURSE,
    "wale": Quantity.MODULUS_WALE,
    "anisotropy": Quantity.ANISOTROPY,
}


@click.command("find")
@click.option("--material", "materials", multiple=True, help="Library id or file; repeatable.")
@click.option("--atlas", "atlases", multiple=True, type=click.Path(path_type=Path))
@click.option(
    "--target",
    "targets",
    multiple=True,
    required=True,
    metavar="QUANTITY=VALUE[~TOLERANCE%][*WEIGHT]",
    help="Such as course=0.1~10% or extensibility_wale_mm_per_n=20*2; repeatable.",
)
@click.option("--count", type=click.IntRange(1, 100), default=10, show_default=True)
@json_option
def command(
    materials: tuple[str, ...],
    atlases: tuple[Path, ...],
    targets: tuple[str, ...],
    count: int,
    as_json: bool,
) -> None:
    """Rank the repeats of atlases (or of materials, up to 3x3) by how near they come."""
    tables: list[Atlas] = [load_atlas(file) for file in atlases]
    tables += [build_atlas(resolve_material(m), repeats_of("small")) for m in materials]
    if not tables:
        raise InputError("material", "there is nothing to search.", "Add --material or --atlas.")
    result = find_in(tables, [_target(text).target() for text in targets], count)
    emit(result, _text(result), as_json=as_json)


def _target(text: str) -> TargetInput:
    match = _TARGET.fullmatch(text.strip())
    if match is None or match[1] not in {*_SHORT, *Quantity}:
        names = ", ".join([*_SHORT, *(q for q in Quantity if q not in _SHORT)])
        raise InputError(
            "target", f"{text!r} cannot be read.", f"Write QUANTITY=VALUE~10%; known: {names}."
        )
    name, value, tolerance, weight = match.groups()
    return TargetInput(
        quantity=_SHORT.get(name) or Quantity(name),
        value=float(value),
        tolerance=float(tolerance) / 100 if tolerance else 0.10,
        weight=float(weight) if weight else 1.0,
    )


def _text(r: FindResult) -> str:
    lines = [r.message, ""]
    for c in r.candidates:
        values = "  ".join(
            f"{q} {v:.4g} ({c.deviations[q]:+.0%}; {c.intervals[q][0]:.3g} to "
            f"{c.intervals[q][1]:.3g})"
            for q, v in c.values.items()
        )
        lines.append(
            f"{c.chart.replace(chr(10), '/'):20} {c.material}: {values}; "
            f"{c.transfers_per_stitch:.2f} transfers a stitch, curl {c.curl:+.2f}; {c.provenance}"
        )
    return "\n".join(lines)
