"""A garment plan as a design document: chart, outline, regions, fills and intarsia yarns."""

from __future__ import annotations

import re

from knitcore.formats.design import DesignFile
from knitcore.formats.layout import DesignRegion, motif_text, runs_of
from knitcore.garment.plan import FABRIC_COLOURS, GarmentPlan

YARN_NAMES = dict(zip(FABRIC_COLOURS.values(), ("blue", "orange", "green", "purple"), strict=True))
"""One colour a fabric, as the study's glove; its seed was pink."""


def design_of_plan(plan: GarmentPlan, material: str, *, intarsia: bool = False) -> DesignFile:
    """The document of a plan, editable like any chart.

    Parameters
    ----------
    plan : from a template.
    material : its identifier.
    intarsia : whether each fabric has a yarn of its own.
    """
    regions = [
        DesignRegion(
            id=re.sub(r"[^a-z0-9]+", "-", region.name.lower()),
            name=region.name,
            colour=region.colour,
            yarn=YARN_NAMES.get(region.colour, region.name) if intarsia else None,
            fill=motif_text(region.fill),
            runs=runs_of(region.cells & plan.shaped.stitch),
        )
        for region in plan.regions
    ]
    direction = (
        "The rows run around the limb."
        if plan.around == "course"
        else ("The rows run along the limb, the columns (wales) around it.")
    )
    return DesignFile(
        name=plan.name[:1].upper() + plan.name[1:],
        material=material,
        chart=plan.shaped.chart.text,
        note="\n".join((direction, f"To close: {plan.closing}.", *plan.notes)),
        outline=None if plan.shaped.stitch.all() else plan.shaped.outline,
        regions=regions,
    )
