"""Ease and pressure: how large a tube must be knitted to press a limb by a target."""

from __future__ import annotations

from dataclasses import dataclass

from knitcore.fabric import Direction, Fabric
from knitcore.garment.gauge import Gauge
from knitcore.materials import Material
from knitcore.mechanics.pressure import (
    Interval,
    LimbPressure,
    limb_pressure,
    rest_circumference,
)


@dataclass(frozen=True)
class TubeFit:
    """A tube of a whole number of stitches (or rows) around a limb.

    Attributes
    ----------
    count : stitches if courses run around the limb, rows if wales do.
    rest_mm : circumference of the unworn tube.
    ease : rest over worn circumference, minus one.
    pressure : as an interval.
    rest_range_mm : rest circumferences that may reach the target, from axially free to fixed.
    """

    count: int
    rest_mm: float
    ease: float
    pressure: LimbPressure
    rest_range_mm: Interval


def fit_tube(
    material: Material,
    fabric: Fabric,
    direction: Direction,
    worn_mm: float,
    mmhg: float,
    *,
    multiple: int = 1,
) -> TubeFit:
    """The tube in the middle of those that may reach a target pressure.

    Parameters
    ----------
    material, fabric : of the tube.
    direction : which material direction runs around the limb.
    worn_mm : circumference of the limb.
    mmhg : target pressure.
    multiple : the count is a multiple of this, so that a repeat closes.

    Raises
    ------
    InputError
        If the target or circumference cannot be used, or no whole number of repeats reaches it.
    """
    law = material.law(fabric)
    wanted = rest_circumference(law, direction, worn_mm, mmhg)
    gauge = Gauge.of_material(material, fabric)
    course = direction is Direction.COURSE
    size = gauge.stitch_course_mm if course else gauge.stitch_wale_mm
    middle = (wanted.low + wanted.high) / 2
    count = max(round(middle / size / multiple), 1) * multiple
    rest = count * size
    return TubeFit(
        count=count,
        rest_mm=rest,
        ease=rest / worn_mm - 1,
        pressure=limb_pressure(law, direction, rest, worn_mm),
        rest_range_mm=wanted,
    )
