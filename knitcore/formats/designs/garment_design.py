"""A garment plan as a design document: chart, outline, regions, fills and intarsia yarns."""

import re
from collections.abc import Iterator

from knitcore.chart.fabric import Direction
from knitcore.formats.designs.design_file import DesignFile
from knitcore.formats.designs.layout import DesignRegion, runs_of
from knitcore.garment.plan import FABRIC_COLOURS, GarmentPlan

YARN_NAMES = dict(zip(FABRIC_COLOURS.values(), ("blue", "orange", "green", "purple"), strict=True))
"""Name of each fabric's yarn, by its colour in the paper's glove (which had pink for seed)."""


def design_of_plan(
    plan: GarmentPlan, material: str, *, intarsia: bool = False, notes: tuple[str, ...] = ()
) -> DesignFile:
    """The document of a plan, editable like any chart.

    Parameters
    ----------
    plan : from a template.
    material : its identifier.
    intarsia : whether each fabric has a yarn of its own.
    notes : for the knitter, after the plan's own.
    """
    regions = [
        DesignRegion(
            id=re.sub(r"[^a-z0-9]+", "-", region.name.lower()),
            name=region.name,
            colour=region.colour,
            yarn=YARN_NAMES.get(region.colour, region.name) if intarsia else None,
            fill=region.fill.key,
            runs=runs_of(region.cells & plan.shaped.stitch),
        )
        for region in plan.regions
    ]
    return DesignFile(
        name=plan.name[:1].upper() + plan.name[1:],
        material=material,
        chart=plan.shaped.chart.text,
        note="\n".join([*_notes(plan), *notes]),
        outline=None if plan.shaped.is_rectangle else plan.shaped.outline,
        regions=regions,
    )


def _notes(plan: GarmentPlan) -> Iterator[str]:
    """Notes for the knitter."""
    if plan.around is Direction.COURSE:
        yield "Knit from the bottom row up; the rows run around the limb."
    else:
        yield "Knit sideways: the rows run along the limb, so the knitting closes around it."
    gauges = []
    for fabric in dict.fromkeys(plan.fabrics):
        stitches, rows = plan.gauges[fabric].counts()
        gauges.append(f"{fabric} {stitches:.0f} sts × {rows:.0f} rows")
    yield f"Gauge per 10 cm: {', '.join(gauges)}."
    yield f"Yarn: {plan.yarn.length_m:.0f} m, without cast-on, tails and swatch."
    yield f"To close: {plan.closing}."
    yield from plan.notes
