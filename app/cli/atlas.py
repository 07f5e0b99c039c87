"""``knitcore atlas``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path

import click

from app.cli.common import emit, json_option, material_option
from app.cli.materials import resolve_material
from app.operations.atlas import AtlasResult, Extent, atlas_result, repeats_of
from knitcore.design.atlas_build import build_atlas
from knitcore.design.atlas_yarn import improve_atlas
from knitcore.errors import InputError

MOST_STITCHES = 8


@click.command("atlas")
@material_option
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="FILE.npz")
@click.option(
    "--repeats",
    type=click.Choice(["small", "all"]),
    default="all",
    show_default=True,
    help="small: up to 3x3; all: up to 4x4; both with a choice of larger ones.",
)
@click.option(
    "--yarn-level",
    is_flag=True,
    help="Then relax and stretch repeats on the yarn level, small ones first.",
)
@click.option(
    "--most-stitches",
    type=click.IntRange(1, 64),
    default=MOST_STITCHES,
    show_default=True,
    help="Of the largest repeat that goes to the yarn level.",
)
@click.option("--workers", type=click.IntRange(1), help="Processes; all cores if left out.")
@click.option("--scheduler", metavar="tcp://…", help="Address of a Dask cluster to work on.")
@json_option
def command(
    material: str,
    out: Path,
    repeats: Extent,
    yarn_level: bool,
    most_stitches: int,
    workers: int | None,
    scheduler: str | None,
    as_json: bool,
) -> None:
    """Predict all repeats of a material; stopped at any point, it goes on where it was."""
    if out.suffix != ".npz" or not out.parent.is_dir():
        raise InputError("out", f"{out} cannot be written.", "Name a .npz file in a folder.")
    yarn = resolve_material(material)
    atlas = build_atlas(
        yarn,
        repeats_of(repeats),
        file=out,
        workers=workers,
        scheduler=scheduler,
        progress=None if as_json else _teller("repeats"),
    )
    if yarn_level:
        atlas = improve_atlas(
            yarn,
            out,
            most_stitches=most_stitches,
            workers=workers,
            scheduler=scheduler,
            progress=None if as_json else _teller("repeats on the yarn level"),
        )
    result = atlas_result(atlas)
    emit(result, _text(result, out), as_json=as_json)


def _teller(what: str) -> Callable[[int, int], None]:
    def progress(done: int, total: int) -> None:
        click.echo(f"\r{done} of {total} {what}", nl=done == total, err=True)

    return progress


def _text(atlas: AtlasResult, out: Path) -> str:
    course, wale = atlas.modulus_course_n_per_mm, atlas.modulus_wale_n_per_mm
    sources = ", ".join(f"{n} {source}" for source, n in Counter(atlas.provenance).most_common())
    return (
        f"{out}: {len(atlas.repeats)} repeats of {atlas.material}; "
        f"course {min(course):.4f} to {max(course):.4f} N/mm, "
        f"wale {min(wale):.4f} to {max(wale):.4f} N/mm; laws: {sources}"
    )
