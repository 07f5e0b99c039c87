"""``knitcore find``."""

from __future__ import annotations

import re
from pathlib import Path

import click

from app.cli.common import emit, json_option
from app.cli.materials import resolve_material
from app.operations.atlas import cached_atlas, repeats_of
from app.operations.find import (
    CandidateResult,
    FindResult,
    LimbInput,
    TargetInput,
    find_result,
    nearest_elsewhere,
)
from knitcore.design.atlas import Atlas, load_atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.design.cost import CostLimits
from knitcore.design.find import find_fabric
from knitcore.design.targets import Quantity
from knitcore.errors import InputError
from knitcore.materials import load_library

_TARGET = re.compile(
    r"([a-z_]+)(?:@(?:([\d.]+)/([\d.]+)|([\d.]+)))?=(-?[\d.]+(?:[eE][+-]?\d+)?)"
    r"(?:~([\d.]+)(%)?)?(?:\*([\d.]+))?"
)
_SHORT = {
    "course": Quantity.MODULUS_COURSE,
    "wale": Quantity.MODULUS_WALE,
    "anisotropy": Quantity.ANISOTROPY,
    "pressure_course": Quantity.PRESSURE_COURSE,
    "pressure_wale": Quantity.PRESSURE_WALE,
}


@click.command("find")
@click.option("--material", "materials", multiple=True, help="Library id or file; repeatable.")
@click.option("--atlas", "atlases", multiple=True, type=click.Path(path_type=Path))
@click.option(
    "--target",
    "targets",
    multiple=True,
    required=True,
    metavar="QUANTITY[@LOAD|@REST/WORN]=VALUE[~TOLERANCE%][*WEIGHT]",
    help="Such as course=0.1~10%, stretch_wale@0.05=0.4 or pressure_course@180/240=20~15%*2.",
)
@click.option("--most-transfers", type=float, help="Loops moved between the beds, per stitch.")
@click.option("--most-crossings", type=float, help="Yarn between face and back, per stitch.")
@click.option("--most-curl", type=float, help="Knits minus purls over all stitches, either way.")
@click.option(
    "--elsewhere", is_flag=True, help="If nothing reaches it, look into the library's other yarns."
)
@click.option("--count", type=click.IntRange(1, 100), default=10, show_default=True)
@json_option
def command(
    materials: tuple[str, ...],
    atlases: tuple[Path, ...],
    targets: tuple[str, ...],
    most_transfers: float | None,
    most_crossings: float | None,
    most_curl: float | None,
    elsewhere: bool,
    count: int,
    as_json: bool,
) -> None:
    """Rank the repeats of atlases (or of materials, up to 3x3) by how near they come."""
    wanted = [_target(text).target() for text in targets]
    limits = CostLimits(most_transfers, most_crossings, most_curl)
    tables: list[Atlas] = [load_atlas(file) for file in atlases]
    tables += [build_atlas(resolve_material(m), repeats_of("small")) for m in materials]
    if not tables:
        raise InputError("material", "there is nothing to search.", "Add --material or --atlas.")
    found = find_fabric(tables, wanted, count=count, limits=limits)
    others = []
    if elsewhere and not found.reached:
        asked = {table.material for table in tables}
        names = [name for name in load_library() if name not in asked]
        others = nearest_elsewhere(
            [cached_atlas(name, "small", None) for name in names], wanted, limits
        )
    result = find_result(tables, found, others)
    emit(result, _text(result), as_json=as_json)


def _target(text: str) -> TargetInput:
    match = _TARGET.fullmatch(text.strip())
    if match is None or match[1] not in {*_SHORT, *Quantity}:
        names = ", ".join([*_SHORT, *(q for q in Quantity if q not in _SHORT.values())])
        raise InputError(
            "target", f"{text!r} cannot be read.", f"Write QUANTITY=VALUE~10%; known: {names}."
        )
    name, rest, worn, load, value, tolerance, percent, weight = match.groups()
    given = {"load_n_per_mm": float(load)} if load else {}
    return TargetInput(
        quantity=_SHORT.get(name) or Quantity(name),
        value=float(value),
        tolerance=float(tolerance) / (100 if percent else 1) if tolerance else 0.10,
        weight=float(weight) if weight else 1.0,
        limb=LimbInput(rest_mm=float(rest), worn_mm=float(worn)) if rest else None,
        **given,
    )


def _text(r: FindResult) -> str:
    lines = [r.message, "", *map(_line, r.candidates)]
    if r.elsewhere:
        lines += ["", "In other yarns:", *map(_line, r.elsewhere)]
    return "\n".join(lines)


def _line(c: CandidateResult) -> str:
    values = "  ".join(_value(c, label) for label in c.values)
    return (
        f"{c.chart.replace(chr(10), '/'):20} {c.material}: {values}; "
        f"{c.transfers_per_stitch:.2f} transfers and {c.crossings_per_stitch:.2f} crossings a "
        f"stitch, curl {c.curl:+.2f}; {c.provenance}"
    )


def _value(c: CandidateResult, label: str) -> str:
    value, off, (low, high) = c.values[label], c.deviations[label], c.intervals[label]
    if value is None or off is None:
        return f"{label} beyond the lock-up"
    shown = f"{off:+.2f}" if label.startswith("poisson") else f"{off:+.0%}"
    ends = [("beyond the curve" if end is None else f"{end:.3g}") for end in (low, high)]
    return f"{label} {value:.4g} ({shown}; {ends[0]} to {ends[1]})"
