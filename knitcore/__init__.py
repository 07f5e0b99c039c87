"""Mechanics of knitted fabric, stitch by stitch."""

from knitcore.chart import StitchChart
from knitcore.errors import (
    CancelledError,
    ConvergenceError,
    InputError,
    KnitcoreError,
    UnravelledError,
)
from knitcore.fabric import Direction, Fabric
from knitcore.phases import quarter_phases
from knitcore.segments import SegmentCounts, SegmentMap, segment_map

__all__ = [
    "CancelledError",
    "ConvergenceError",
    "Direction",
    "Fabric",
    "InputError",
    "KnitcoreError",
    "SegmentCounts",
    "SegmentMap",
    "StitchChart",
    "UnravelledError",
    "quarter_phases",
    "segment_map",
]
