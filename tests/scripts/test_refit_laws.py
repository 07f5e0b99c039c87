"""Published laws over the strain between the clamps."""

import numpy as np
import pytest

from knitcore import Direction, Fabric, material
from knitcore.law.uniaxial import uniaxial_response
from scripts.refit_laws import ClampCorrection, converted


@pytest.mark.parametrize("fabric", list(Fabric))
@pytest.mark.parametrize("direction", list(Direction))
def test_a_converted_law_has_the_published_stress_at_the_published_strain(
    fabric: Fabric, direction: Direction
) -> None:
    law = material("cotton", laws="published").law(fabric)
    ratio, waist = 1.2, 0.9
    mine = converted(law, ClampCorrection(ratio, waist))
    strain = np.linspace(0.0, 0.7 * mine.lock_up_strain(direction), 8)
    theirs = uniaxial_response(law, direction, ratio * strain)
    ours = uniaxial_response(mine, direction, strain)
    np.testing.assert_allclose(ours.stress, theirs.stress, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(
        ours.transverse_strain, waist * theirs.transverse_strain, rtol=1e-9, atol=1e-12
    )
