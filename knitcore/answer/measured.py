"""Pure fabrics: their own law and gauge."""

from __future__ import annotations

from knitcore.answer.answer import Answer, Source
from knitcore.answer.relaxed import RelaxedSize
from knitcore.fabric import Fabric
from knitcore.materials import Material, Origin

CURL = (
    "Stockinette curls: its sides roll to the back, its top and bottom edges to the face. The "
    "moduli are those of a sheet held flat."
)

GAUGE_LOG_SD = 0.08
"""Standard deviation of the logarithm of a pure fabric's size: one aspect ratio is used for all
yarns, and those of two yarns differ by up to 17 % (``materials/data/aspect.csv``)."""

_SOURCES = {Origin.SIMULATED: Source.SWEPT, Origin.ESTIMATED: Source.ESTIMATED}


def measured(fabric: Fabric, material: Material) -> Answer:
    """Answer for a pure fabric, from the record of the material.

    Raises
    ------
    InputError
        If the material has no such fabric.
    """
    record = material.record(fabric)
    spread = record.uncertainty
    size = RelaxedSize(record.stitch_course_mm, record.stitch_wale_mm, GAUGE_LOG_SD)
    notes = [CURL] if fabric is Fabric.STOCKINETTE else []
    return Answer.of_law(
        record.law,
        size,
        spread=spread,
        provenance=_SOURCES.get(record.origin, Source.MEASURED),
        method=f"law of {fabric}, {record.origin}; uncertainty: {spread.source}",
        relaxed_source="gauge of the pure fabric",
        notes=(*notes, *([material.note] if material.note else [])),
    )
