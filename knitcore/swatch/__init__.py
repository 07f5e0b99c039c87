"""The finite swatch: a chart of any stitches as a nonlinear sheet, pulled, sheared or relaxed."""

from knitcore.swatch.fields import Fields
from knitcore.swatch.grid import QuarterGrid
from knitcore.swatch.misfit import Misfit, misfit, relaxed_shape
from knitcore.swatch.models import Coupling, EnergyModel, SheetModel
from knitcore.swatch.other_tests import biaxial_test, pull_with_force, trellis_test
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
    "Misfit",
    "QuarterGrid",
    "Sheet",
    "SheetModel",
    "State",
    "StripTest",
    "SwatchTest",
    "TrellisTest",
    "biaxial_test",
    "chart_sheet",
    "homogeneous_sheet",
    "misfit",
    "pull",
    "pull_with_force",
    "relaxed_shape",
    "strip_test",
    "trellis_test",
]
