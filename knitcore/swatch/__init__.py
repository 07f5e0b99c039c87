"""The finite swatch: a chart of any stitches as a nonlinear sheet, pulled, sheared or relaxed."""

from knitcore.swatch.fields import Fields
from knitcore.swatch.force_control import pull_with_force, strain_at_force
from knitcore.swatch.grid import QuarterGrid
from knitcore.swatch.misfit import Misfit, misfit, relaxed_shape
from knitcore.swatch.models import Coupling, EnergyModel, SheetModel
from knitcore.swatch.results import LockUp, StripTest, SwatchTest
from knitcore.swatch.sheet import Sheet, State
from knitcore.swatch.strip import Clamps, chart_sheet, homogeneous_sheet, pull, strip_test

__all__ = [
    "Clamps",
    "Coupling",
    "EnergyModel",
    "Fields",
    "LockUp",
    "Misfit",
    "QuarterGrid",
    "Sheet",
    "SheetModel",
    "State",
    "StripTest",
    "SwatchTest",
    "chart_sheet",
    "homogeneous_sheet",
    "misfit",
    "pull",
    "pull_with_force",
    "relaxed_shape",
    "strain_at_force",
    "strip_test",
]
