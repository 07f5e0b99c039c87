"""``knitcore garment``."""

from __future__ import annotations

import json
from pathlib import Path

import click

from app.cli.common import emit, json_option, material_option
from app.cli.materials import resolve_material
from app.operations.garment import GarmentRequest, GarmentResult, WornResult, plan_garment
from knitcore.errors import InputError
from knitcore.formats.design import write_design


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
@click.option("--gauge", metavar="STSxROWS", help="The knitter's own, such as 22x30.")
@click.option("--per", type=click.Choice(["10 cm", "4 in", "5 cm"]), default="10 cm")
@click.option("--tex", type=float, help="Linear density of the yarn (g/km), for its mass.")
@click.option("--intarsia", is_flag=True, help="Give each fabric a yarn of its own.")
@click.option("-o", "--out", type=click.Path(path_type=Path), help="Write a design (.json).")
@json_option
def command(
    template: str,
    material: str,
    settings: tuple[str, ...],
    gauge: str | None,
    per: str,
    tex: float | None,
    intarsia: bool,
    out: Path | None,
    as_json: bool,
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
    asked: dict[str, object] = {"garment": values, "material": material, "intarsia": intarsia}
    if gauge is not None:
        stitches, _, rows = gauge.lower().replace("×", "x").partition("x")
        asked["gauge"] = {"stitches": stitches, "rows": rows, "per": per}
    request = GarmentRequest.model_validate(asked | {"linear_density_tex": tex})
    result = plan_garment(request, resolve_material(material))
    if out is not None:
        out.write_text(write_design(result.design), encoding="utf-8")
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
    lines += [_pressure(place) for place in r.worn]
    return "\n".join([*lines, *r.notes, *(f"warning: {w}" for w in r.warnings)])


def _pressure(place: WornResult) -> str:
    sizes = (
        f"{place.part} at {place.at_mm:.0f} mm: {place.rest_mm:.0f} mm on {place.worn_mm:.0f} mm"
    )
    if place.mmhg is None:
        return f"{sizes}; {place.warnings[0]}"
    return f"{sizes} presses {place.mmhg.low:.1f} to {place.mmhg.high:.1f} mmHg"
