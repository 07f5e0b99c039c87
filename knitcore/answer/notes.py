"""What a knitter should be told beside a prediction."""

from __future__ import annotations

import numpy as np

from knitcore.chart import StitchChart
from knitcore.fabric import PHASES, Fabric
from knitcore.materials import Material
from knitcore.phases import quarter_phases

CURL = (
    "Stockinette curls: its sides roll to the back, its top and bottom edges to the face. The "
    "moduli are those of a sheet held flat."
)
FOLDS_AT_REST = (
    "Composite of flat quarter cells: right for the stretched cloth (above about 0.05 N/mm). At "
    "rest a repeat with runs of like stitches folds and draws in, so its relaxed size and its "
    "first stretch are not certified; relax this repeat on the yarn level."
)
PATCHWORK = (
    "A patchwork: inside each region the region's own law holds (see the local moduli). The "
    "numbers for the whole chart are those of a large sheet of such patches."
)
RELAXED_ONLY_TABLED = (
    "Draw-in is taken over from the yarn level by its ratio to a pure fabric; it has no friction "
    "or set, so it is probably exaggerated. Your own gauge is better."
)

_LOOP_SPREAD = 1.15
_CURLING_SHARE = 0.25


def fabric_notes(fabric: Fabric, material: Material) -> tuple[str, ...]:
    """Notes on a pure fabric."""
    found = [CURL] if fabric is Fabric.STOCKINETTE else []
    if material.note:
        found.append(material.note)
    return tuple(found)


def composite_notes(
    repeat: StitchChart, material: Material, *, patchwork: bool, corrected: bool
) -> tuple[str, ...]:
    """Notes on a chart that mixes phases."""
    found = [PATCHWORK if patchwork else RELAXED_ONLY_TABLED if corrected else FOLDS_AT_REST]
    phases = quarter_phases(repeat, periodic=True)
    if float(np.mean(phases == Fabric.STOCKINETTE.phase)) > _CURLING_SHARE and patchwork:
        found.append(CURL)
    lengths = {PHASES[p]: material.record(PHASES[p]).loop_length_mm for p in np.unique(phases)}
    known = {fabric: length for fabric, length in lengths.items() if length is not None}
    if known and max(known.values()) > _LOOP_SPREAD * min(known.values()):
        listed = ", ".join(f"{fabric} {length:g} mm" for fabric, length in known.items())
        found.append(
            f"The fabrics of this material were knitted at different loop lengths ({listed}); a "
            "mixed chart lies between them."
        )
    if material.note:
        found.append(material.note)
    return tuple(found)
