"""``knitcore fill``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option, material_option, resolve_chart
from app.cli.materials import resolve_material
from app.operations.atlas import repeats_of
from app.operations.fill import FillResult, fill_result
from knitcore.design.atlas import load_atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.design.fill import fill_field
from knitcore.formats.design import DesignFile, write_design
from knitcore.formats.stitch_maps import read_wanted_moduli


@click.command("fill")
@click.argument("target", type=click.Path(path_type=Path))
@material_option
@click.option("--atlas", "atlas_file", type=click.Path(path_type=Path), help="Otherwise up to 3x3.")
@click.option("--chart", help="Stitches without a wish stay as they are in this file.")
@click.option("--smallest-patch", type=click.IntRange(1, 100), default=4, show_default=True)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Write a design (.json).")
@json_option
def command(
    target: Path,
    material: str,
    atlas_file: Path | None,
    chart: str | None,
    smallest_patch: int,
    seed: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """Make a chart for TARGET: a CSV of row, column and wanted moduli, as `export --to csv`."""
    course, wale = read_wanted_moduli(target)
    yarn = resolve_material(material)
    atlas = load_atlas(atlas_file) if atlas_file else build_atlas(yarn, repeats_of("small"))
    kept = None if chart is None else resolve_chart(chart, None)
    field = fill_field(
        course, wale, yarn, atlas, kept=kept, smallest_patch=smallest_patch, seed=seed
    )
    result = fill_result(field)
    if out is not None:
        design = DesignFile(name=target.stem, material=material, chart=result.chart)
        out.write_text(write_design(design), encoding="utf-8")
    emit(result, _text(result), as_json=as_json)


def _text(r: FillResult) -> str:
    head = (
        f"{r.columns} columns x {r.rows} rows in {len(r.patches)} patches; "
        f"{r.off_share:.1%} of the stitches with a wish are off by more than 10 %"
    )
    return "\n".join([r.chart, head, *r.messages])
