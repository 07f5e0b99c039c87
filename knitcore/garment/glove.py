"""The therapeutic glove (Note 10): one flat piece, knitted sideways around the hand and grafted.

Columns run from the forearm to the finger tips, rows around the hand: half of the thumb, the
fingers' backs from index to little finger, their fronts back to the index, and the other half of
the thumb, which is grafted to the first row. Stockinette lies around the wrist along its stiff
direction, the wales; ribs let the fingers bend, garter the hand close, seed the thumb move both
ways. Between fingers a few rows end at the crotch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from knitcore.errors import InputError
from knitcore.fabric import Direction, Fabric
from knitcore.garment.gauge import Gauge
from knitcore.garment.plan import GarmentPlan, Part, make_plan
from knitcore.materials import Material

CROTCH_ROWS = 2
PALM_TOLERANCE = 0.10


@dataclass(frozen=True)
class Finger:
    """Length from its crotch, and circumference, in mm."""

    length_mm: float
    circumference_mm: float


@dataclass(frozen=True)
class Hand:
    """Measurements of a hand in mm; the defaults are an adult's.

    Attributes
    ----------
    cuff_mm : garter edge on the forearm.
    wrist_mm : length of the wrist support.
    palm_mm : from the support to the crotch of the fingers.
    thumb_crotch_mm : from the support to the crotch of the thumb.
    palm_circumference_mm : around the knuckles, without the thumb.
    thumb : from its crotch.
    fingers : index, middle, ring and little finger.
    """

    cuff_mm: float = 12.0
    wrist_mm: float = 55.0
    palm_mm: float = 80.0
    thumb_crotch_mm: float = 45.0
    palm_circumference_mm: float = 205.0
    thumb: Finger = Finger(55.0, 65.0)
    fingers: tuple[Finger, ...] = (
        Finger(70.0, 64.0),
        Finger(78.0, 64.0),
        Finger(72.0, 60.0),
        Finger(57.0, 53.0),
    )

    def __post_init__(self) -> None:
        lengths = {
            "cuff_mm": self.cuff_mm,
            "wrist_mm": self.wrist_mm,
            "palm_mm": self.palm_mm,
            "thumb_crotch_mm": self.thumb_crotch_mm,
            "palm_circumference_mm": self.palm_circumference_mm,
            "thumb": min(self.thumb.length_mm, self.thumb.circumference_mm),
        }
        for name, value in lengths.items():
            if not (math.isfinite(value) and 5 <= value <= 600):
                raise InputError(name, f"{value:g} mm is no part of a hand.", "Give 5 to 600 mm.")
        if len(self.fingers) != 4 or not all(
            5 <= value <= 300 for f in self.fingers for value in (f.length_mm, f.circumference_mm)
        ):
            raise InputError("fingers", "four fingers are needed.", "Give lengths and girths.")
        if self.thumb_crotch_mm >= self.palm_mm:
            raise InputError(
                "thumb_crotch_mm",
                "the thumb's crotch lies beyond the fingers'.",
                f"Give less than palm_mm, {self.palm_mm:g} mm.",
            )


def glove(
    hand: Hand,
    material: Material,
    *,
    ease: float = -0.10,
    linear_density_tex: float | None = None,
) -> GarmentPlan:
    """The plan of a glove.

    Stitches along the hand come from the gauge of each part's own fabric, rows around it from the
    fingers' (rib) and the thumb's (seed); what does not fit is told as misfits.

    Raises
    ------
    InputError
        If measurements or ease cannot be used, or the material lacks a fabric.
    """
    if not (math.isfinite(ease) and -0.4 <= ease <= 0.3):
        raise InputError("ease", f"{ease:g} is no ease of a glove.", "Give -0.4 to 0.3.")
    gauges = {fabric: Gauge.of_material(material, fabric) for fabric in Fabric}
    cuff = gauges[Fabric.GARTER].stitches_for(hand.cuff_mm)
    support = cuff + gauges[Fabric.STOCKINETTE].stitches_for(hand.wrist_mm)
    palm = gauges[Fabric.GARTER]
    thumb_crotch = support + palm.stitches_for(hand.thumb_crotch_mm)
    crotch = max(support + palm.stitches_for(hand.palm_mm), thumb_crotch + 1)

    thumb_rows = gauges[Fabric.SEED].rows_for(hand.thumb.circumference_mm / 2 * (1 + ease))
    thumb_tip = thumb_crotch + gauges[Fabric.SEED].stitches_for(hand.thumb.length_mm)
    rib = gauges[Fabric.RIB]
    ends: list[tuple[str, int]] = [("thumb", thumb_tip)] * thumb_rows
    ends += [("hand", thumb_crotch)] * CROTCH_ROWS
    backs = [
        (rib.rows_for(f.circumference_mm / 2 * (1 + ease)), crotch + rib.stitches_for(f.length_mm))
        for f in hand.fingers
    ]
    for side in (backs, backs[::-1]):
        for index, (rows, tip) in enumerate(side):
            ends += [("finger", tip)] * rows
            if index < len(side) - 1:
                ends += [("hand", crotch)] * CROTCH_ROWS
    ends += [("hand", thumb_crotch)] * CROTCH_ROWS + [("thumb", thumb_tip)] * thumb_rows

    tips = np.array([tip for _, tip in ends])
    kinds = np.array([kind for kind, _ in ends])[:, None]
    column = np.broadcast_to(np.arange(int(tips.max())), (len(ends), int(tips.max())))
    stitch = column < tips[:, None]
    beyond = column >= support
    is_thumb = beyond & (kinds == "thumb")
    is_finger = (column >= crotch) & (kinds == "finger")
    parts = (
        Part("cuff", column < cuff, Fabric.GARTER),
        Part("wrist support", (column >= cuff) & ~beyond, Fabric.STOCKINETTE),
        Part("hand", beyond & ~is_thumb & ~is_finger, Fabric.GARTER),
        Part("thumb", is_thumb, Fabric.SEED),
        Part("fingers", is_finger, Fabric.RIB),
    )
    return make_plan(
        "therapeutic glove",
        stitch,
        parts,
        material,
        around=Direction.WALE,
        closing="graft the last row to the first along the thumb; seam the finger tips and sides",
        notes=_notes(hand, ends, gauges[Fabric.GARTER], ease),
        linear_density_tex=linear_density_tex,
    )


def _notes(hand: Hand, ends: list[tuple[str, int]], garter: Gauge, ease: float) -> tuple[str, ...]:
    notes = [
        "The wrist support is stockinette; the study knitted it on 2.0 mm needles and the rest on "
        "2.75 mm ones, which is a material of its own: measure it.",
    ]
    rows = sum(kind != "thumb" for kind, _ in ends)
    wanted = garter.rows_for(hand.palm_circumference_mm * (1 + ease))
    if abs(rows / wanted - 1) > PALM_TOLERANCE:
        notes.append(
            f"The fingers need {rows} rows around the hand, its circumference {wanted} rows of "
            "garter: ease the palm, or change the fingers' circumferences."
        )
    return tuple(notes)
