"""Mechanics of knitted fabric, stitch by stitch.

Everything below is imported when it is first used, so that ``import knitcore`` costs little.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from knitcore.chart import StitchChart
    from knitcore.errors import (
        CancelledError,
        ConvergenceError,
        InputError,
        KnitcoreError,
        UnravelledError,
    )
    from knitcore.fabric import Direction, Fabric
    from knitcore.materials.library import material
    from knitcore.phases import quarter_phases
    from knitcore.prediction.curve import curve
    from knitcore.prediction.predict import predict as predict
    from knitcore.prediction.size import RelaxedSize
    from knitcore.segments import SegmentCounts, SegmentMap, segment_map
    from knitcore.swatch.strip import strip_test
    from knitcore.yarnlevel.relax import relax

_HOMES = {
    "CancelledError": "knitcore.errors.CancelledError",
    "ConvergenceError": "knitcore.errors.ConvergenceError",
    "Direction": "knitcore.fabric.Direction",
    "Fabric": "knitcore.fabric.Fabric",
    "InputError": "knitcore.errors.InputError",
    "KnitcoreError": "knitcore.errors.KnitcoreError",
    "RelaxedSize": "knitcore.prediction.size.RelaxedSize",
    "SegmentCounts": "knitcore.segments.SegmentCounts",
    "SegmentMap": "knitcore.segments.SegmentMap",
    "StitchChart": "knitcore.chart.StitchChart",
    "UnravelledError": "knitcore.errors.UnravelledError",
    "curve": "knitcore.prediction.curve.curve",
    "material": "knitcore.materials.library.material",
    "predict": "knitcore.prediction.predict.predict",
    "quarter_phases": "knitcore.phases.quarter_phases",
    "relax": "knitcore.yarnlevel.relax.relax",
    "segment_map": "knitcore.segments.segment_map",
    "strip_test": "knitcore.swatch.strip.strip_test",
}

__all__ = [
    "CancelledError",
    "ConvergenceError",
    "Direction",
    "Fabric",
    "InputError",
    "KnitcoreError",
    "RelaxedSize",
    "SegmentCounts",
    "SegmentMap",
    "StitchChart",
    "UnravelledError",
    "curve",
    "material",
    "predict",
    "quarter_phases",
    "relax",
    "segment_map",
    "strip_test",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("knitcore")
    if name not in _HOMES:
        raise AttributeError(f"module 'knitcore' has no attribute {name!r}")
    module, _, home = _HOMES[name].rpartition(".")
    found = getattr(import_module(module), home)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
