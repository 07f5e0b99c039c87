"""``knitcore materials``."""

from __future__ import annotations

from pathlib import Path

import click

from app.cli.common import emit, json_option
from app.operations.materials import (
    MaterialDetail,
    Materials,
    describe_material,
    list_materials,
)
from app.results.own_materials import find_material
from knitcore.materials import Material
from knitcore.materials.files import load_material_file

FILE_KINDS = (".json", ".yaml", ".yml")


def resolve_material(name: str) -> Material:
    """A material by its library id, or from a file.

    Raises
    ------
    InputError
        If there is neither.
    """
    if Path(name).suffix.lower() in FILE_KINDS:
        return load_material_file(name)
    return find_material(name)


@click.command("materials")
@click.argument("material", required=False)
@json_option
def command(material: str | None, as_json: bool) -> None:
    """List the library, or explain one MATERIAL (an id or a file)."""
    if material is None:
        library = list_materials()
        emit(library, _list(library), as_json=as_json)
    else:
        detail = describe_material(resolve_material(material))
        emit(detail, _explain(detail), as_json=as_json)


def _list(library: Materials) -> str:
    return "\n".join(f"{m.id:24} {m.name}: {m.description}" for m in library.materials)


def _explain(detail: MaterialDetail) -> str:
    lines = [f"{detail.name} ({detail.id}): {detail.description}", *detail.notes]
    if detail.bending_modulus_n_mm2 is not None:
        deviation = detail.bending_modulus_sd_n_mm2
        spread = "" if deviation is None else f" ± {1000 * deviation:.3g}"
        lines.append(f"bending modulus {1000 * detail.bending_modulus_n_mm2:.4g}{spread} mN mm²")
    for fabric, record in detail.fabrics.items():
        lines += [
            "",
            f"{fabric}: {record.setting or record.origin}",
            f"  Young's modulus   course {record.modulus_course_n_per_mm:.4f}   "
            f"wale {record.modulus_wale_n_per_mm:.4f} N/mm",
            f"  Poisson's ratio   yx {record.poisson_yx:.3f}   xy {record.poisson_xy:.3f}",
            f"  lock-up strain    course {record.lock_up_strain_course:.2f}   "
            f"wale {record.lock_up_strain_wale:.2f}",
            f"  stitch            {record.stitch_course_mm:.2f} x {record.stitch_wale_mm:.2f} mm",
        ]
        lines += [
            f"  table {f.table}, {f.quantity}: printed {f.printed}, used {f.used:g} ({f.reason})"
            for f in record.figures
            if f.reason
        ]
    return "\n".join(lines)
