"""The library of materials, with the user's own."""

from __future__ import annotations

import click

from knitcore.materials import load_library, load_variants, offered_materials

from ...context import Context
from ...requests.base import NoRequest, ResultModel
from ...service.identity import current_user
from ...service.results.own_materials import added_by, own_materials
from ..registry import Command, Operation
from .material import (
    MaterialDetail,
    MaterialRequest,
    MaterialSummary,
    material,
    summary,
)


class Materials(ResultModel):
    """The library."""

    materials: list[MaterialSummary]


def materials(request: NoRequest, context: Context) -> Materials:
    """The user's own materials, the paper's yarns and their variants, and those of extensions."""
    del request
    library = {**load_library(), **load_variants(), **offered_materials()}
    known = {**own_materials(context.data_dir), **library}
    yours = added_by(current_user.get(), context.data_dir)
    return Materials(
        materials=[
            summary(material, added_by_you=name in yours) for name, material in known.items()
        ]
    )


@click.argument("name", metavar="MATERIAL", required=False)
def _command(request: NoRequest, context: Context, name: str | None) -> Materials | MaterialDetail:
    if name is None:
        return materials(request, context)
    return material(MaterialRequest(identifier=name), context)


def _lines(listed: Materials | MaterialDetail) -> list[str]:
    if isinstance(listed, Materials):
        return [f"{m.id:24} {m.name}: {m.description}" for m in listed.materials]
    lines = [f"{listed.name} ({listed.id}): {listed.description}"]
    if listed.bending_modulus_n_mm2 is not None:
        deviation = listed.bending_modulus_sd_n_mm2
        spread = "" if deviation is None else f" ± {1000 * deviation:.3g}"
        lines.append(f"bending modulus {1000 * listed.bending_modulus_n_mm2:.4g}{spread} mN mm²")
    for fabric, record in listed.fabrics.items():
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
    return lines


OPERATION = Operation(
    materials,
    method="GET",
    tag="materials",
    summary="The library of materials",
    command=Command(
        _lines,
        more="MATERIAL is an id or a file.",
        run=_command,
    ),
)
