import numpy as np
import pytest

from knitcore.fabric import Direction
from knitcore.yarnlevel.shares import overtaking_strain
from tests.knitcore.yarnlevel.synthetic import sweep

STRAIN = np.array([0.0, 0.2, 0.4])


@pytest.mark.parametrize(
    ("share", "strain"), [((0.2, 0.4, 0.6), 0.3), ((0.6, 0.7, 0.8), 0.0), ((0.1, 0.2, 0.3), None)]
)
def test_strain_at_which_contact_overtakes_bending(share, strain):
    stretched = sweep(Direction.COURSE, STRAIN, -0.1 * STRAIN, STRAIN, contact_share=share)
    found = overtaking_strain(stretched)
    assert found == (None if strain is None else pytest.approx(strain))
