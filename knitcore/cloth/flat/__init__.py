"""The finite swatch: a chart of any stitches as a nonlinear sheet, pulled or sheared."""

from knitcore.cloth.flat.fields import Fields
from knitcore.cloth.flat.force_control import strain_at_force
from knitcore.cloth.flat.grid import QuarterGrid
from knitcore.cloth.flat.grid_sheet import Sheet, State
from knitcore.cloth.flat.sheet_models import EnergyModel, SheetModel
from knitcore.cloth.flat.strip import Clamps, chart_sheet, pull, strip_test
from knitcore.cloth.flat.strip_results import LockUp, StripTest, SwatchTest

__all__ = [
    "Clamps",
    "EnergyModel",
    "Fields",
    "LockUp",
    "QuarterGrid",
    "Sheet",
    "SheetModel",
    "State",
    "StripTest",
    "SwatchTest",
    "chart_sheet",
    "pull",
    "strain_at_force",
    "strip_test",
]
