"""The finite swatch: a chart of any stitches as a nonlinear sheet, pulled, sheared or relaxed."""

from knitcore.swatch.fields import Fields
from knitcore.swatch.grid import QuarterGrid
from knitcore.swatch.models import Coupling, EnergyModel, SheetModel
from knitcore.swatch.results import BiaxialTest, LockUp, StripTest, SwatchTest, TrellisTest
from knitcore.swatch.sheet import Sheet, State
from knitcore.swatch.strip import Clamps, chart_sheet, homogeneous_sheet, pull, strip_test

__all__ = [
    "BiaxialTest",
    "Clamps",
    "Coupling",
    "EnergyModel",
    "Fields",
    "LockUp",
    "QuarterGrid",
    "Sheet",
    "SheetModel",
    "State",
    "StripTest",
    "SwatchTest",
    "TrellisTest",
    "chart_sheet",
    "homogeneous_sheet",
    "pull",
    "strip_test",
]
