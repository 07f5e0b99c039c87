"""``knitcore atlas``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option, material_option
from app.cli.materials import resolve_material
from app.operations.atlas import AtlasResult, Extent, atlas_result, make_atlas
from knitcore.errors import InputError


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
@json_option
def command(material: str, out: Path, repeats: Extent, as_json: bool) -> None:
    """Predict all repeats of a material; interrupted, it goes on where it stopped."""
    if out.suffix != ".npz" or not out.parent.is_dir():
        raise InputError("out", f"{out} cannot be written.", "Name a .npz file in a folder.")

    def progress(done: int, total: int) -> None:
        if done % 50 == 0 or done == total:
            click.echo(f"\r{done} of {total} repeats", nl=done == total, err=True)

    shown = None if as_json else progress
    atlas = atlas_result(make_atlas(resolve_material(material), repeats, out, shown))
    emit(atlas, _text(atlas, out), as_json=as_json)


def _text(atlas: AtlasResult, out: Path) -> str:
    course, wale = atlas.modulus_course_n_per_mm, atlas.modulus_wale_n_per_mm
    return (
        f"{out}: {len(atlas.repeats)} repeats of {atlas.material}; "
        f"course {min(course):.4f} to {max(course):.4f} N/mm, "
        f"wale {min(wale):.4f} to {max(wale):.4f} N/mm"
    )
