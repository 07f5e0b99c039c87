"""``knitcore garment``."""

from __future__ import annotations

import json
from pathlib import Path

import click

from app.cli.common import emit, json_option, material_option
from app.cli.materials import resolve_material
from app.operations.garment import GarmentRequest, GarmentResult, garment_result
from knitcore.errors import InputError
from knitcore.formats.design import DesignFile, write_design


@click.command("garment")
@click.argument("template", type=click.Choice(["wrist-brace", "sock-leg", "limb", "glove"]))
@material_option
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="NAME=VALUE",
    help="A measurement such as wrist_mm=170, or profile=[[0,200],[150,260]]; repeatable.",
)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Write a design (.json).")
@json_option
def command(
    template: str, material: str, settings: tuple[str, ...], out: Path | None, as_json: bool
) -> None:
    """Plan a garment from a TEMPLATE and measurements."""
    values: dict[str, object] = {"template": template}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals:
            raise InputError("set", f"{setting!r} sets nothing.", "Write NAME=VALUE.")
        try:
            values[name] = json.loads(value)
        except json.JSONDecodeError:
            values[name] = value
    request = GarmentRequest.model_validate({"garment": values, "material": material})
    result = garment_result(request.garment.plan(resolve_material(material)))
    if out is not None:
        design = DesignFile(
            name=result.name, material=material, chart=result.chart, outline=result.outline
        )
        out.write_text(write_design(design), encoding="utf-8")
    emit(result, _text(result), as_json=as_json)


def _text(r: GarmentResult) -> str:
    lines = [
        f"{r.name}: {r.columns} columns x {r.rows} rows, {r.stitches} stitches, "
        f"{r.yarn_m:.0f} m of yarn; {r.closing}",
        f"{'region':20} {'stitches':>8} {'course':>8} {'wale':>8}  mm/N",
    ]
    lines += [
        f"{region.name:20} {region.stitches:8} {region.extensibility_course_mm_per_n:8.2f} "
        f"{region.extensibility_wale_mm_per_n:8.2f}"
        for region in r.regions
    ]
    return "\n".join([*lines, *r.notes, *(f"warning: {w}" for w in r.warnings)])
