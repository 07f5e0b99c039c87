"""``knitcore shape``."""

from __future__ import annotations

import csv
from pathlib import Path

import click
import numpy as np
from numpy.typing import NDArray

from app.cli.common import choice, emit, json_option, material_option
from app.cli.materials import resolve_material
from app.operations.atlas import repeats_of
from app.operations.shape import ShapeResult, shape_result
from knitcore.design.atlas import load_atlas
from knitcore.design.atlas_build import build_atlas
from knitcore.design.shape import fill_shape
from knitcore.errors import InputError
from knitcore.fabric import Direction
from knitcore.formats.design import DesignFile, write_design


@click.command("shape")
@click.argument("profile", type=click.Path(path_type=Path))
@material_option
@click.option("--across", type=click.IntRange(3), required=True, help="Stitches of a line.")
@click.option("--strain", type=float, required=True, help="From clamp to clamp: 0.3 is 30 %.")
@click.option(
    "--direction", type=choice(Direction), default=Direction.WALE.value, show_default=True
)
@click.option("--atlas", "atlas_file", type=click.Path(path_type=Path), help="Otherwise up to 3x3.")
@click.option("--smallest-band", type=click.IntRange(1, 100), default=4, show_default=True)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Write a design (.json).")
@json_option
def command(
    profile: Path,
    material: str,
    across: int,
    strain: float,
    direction: str,
    atlas_file: Path | None,
    smallest_band: int,
    seed: int,
    out: Path | None,
    as_json: bool,
) -> None:
    """Make a chart that, stretched, has the widths of PROFILE.

    PROFILE is a CSV with a column `width`: stretched width over width at rest, one line across the
    pull after the other from the bottom (or the left); an empty one is no wish.
    """
    yarn = resolve_material(material)
    atlas = load_atlas(atlas_file) if atlas_file else build_atlas(yarn, repeats_of("small"))
    found = fill_shape(
        _read(profile),
        across,
        Direction(direction),
        strain,
        yarn,
        atlas,
        smallest_band=smallest_band,
        seed=seed,
    )
    result = shape_result(found)
    if out is not None:
        design = DesignFile(name=profile.stem, material=material, chart=result.chart)
        out.write_text(write_design(design), encoding="utf-8")
    emit(result, _text(result), as_json=as_json)


def _read(file: Path) -> NDArray[np.float64]:
    try:
        with file.open(newline="", encoding="utf-8") as stream:
            names, *rows = csv.reader(stream)
        column = [name.strip() for name in names].index("width")
        values = [row[column].strip() if row else "" for row in rows]  # an empty line is no wish
        return np.array([float(value) if value else np.nan for value in values])
    except FileNotFoundError:
        raise InputError("profile", f"there is no file {file}.", "Check its name.") from None
    except (IndexError, ValueError):
        raise InputError(
            "profile", f"{file.name} is no profile.", "Give a column `width` of numbers."
        ) from None


def _text(r: ShapeResult) -> str:
    bands = ", ".join(f"{b.lines} of {b.repeat}" for b in r.bands)
    head = (
        f"{r.columns} columns x {r.rows} rows; widths {r.rms:.1%} off (rms), {r.largest:.1%} at "
        f"most; {r.force_n:.2f} N; from the first line: {bands}"
    )
    return "\n".join([r.chart, head, *r.messages])
