"""Laws of the library in simulated tests, against the authors' tests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from knitcore.chart.fabric import Direction, Fabric
from knitcore.fit.measured_strip import MeasuredStrip
from knitcore.fit.strip_fit import flattening
from knitcore.materials import material
from knitcore.measure.uniaxial_files import read_stretch_test


@pytest.mark.parametrize("fabric", Fabric)
def test_the_library_reproduces_acrylics_raw_tests(study_data: Path, fabric: Fabric) -> None:
    """Force within 10 % at 0.05, 0.1 and 0.2 N/mm; waist within 0.05, and within 0.02 beside what
    the cloth widens as it becomes flat at the start of the pull.
    """
    law = material("acrylic").law(fabric)
    for direction, axis in zip(Direction, "XY", strict=True):
        path = study_data / "uniaxial" / f"outputData_Acrylic Yarn {fabric.title()} {axis}.h5"
        test = read_stretch_test(path)
        if fabric is Fabric.GARTER and direction is Direction.COURSE:
            test = test.with_width(59.5)  # the file repeats the clamp's size for the width
        strip = MeasuredStrip.of(test, direction)
        stress, waist = strip.means
        at = np.interp((0.05, 0.1, 0.2), stress, strip.strain)
        force, narrowing = strip.simulate(law, at)
        assert force / (0.05, 0.1, 0.2) == pytest.approx(np.ones(3), abs=0.1)
        measured = np.interp(at, strip.strain, waist)
        assert narrowing == pytest.approx(measured, abs=0.05)
        flat = flattening(strip.simulate(law)[1], waist)
        assert narrowing + flat == pytest.approx(measured, abs=0.02)
