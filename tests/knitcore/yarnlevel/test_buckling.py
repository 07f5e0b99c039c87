import numpy as np
import pytest

from knitcore.fabric import Direction
from knitcore.yarnlevel.buckling import find_buckling
from tests.knitcore.yarnlevel.synthetic import sweep

STRAIN = np.array([0.0, 0.2, 0.4, 0.6])


def test_a_jump_with_falling_stress_and_contact_is_buckling():
    stretched = sweep(
        Direction.WALE,
        STRAIN,
        -0.1 * STRAIN,
        [0.0, 0.2, 0.1, 0.3],
        contact_share=[0.2, 0.5, 0.4, 0.5],
        jumps=(2,),
        heights=[1.0, 1.0, 1.5, 1.5],
    )
    (event,) = find_buckling(stretched)
    assert event.index == 2
    assert event.strain == pytest.approx((0.2, 0.4))
    assert event.stress_n_per_mm == (0.2, 0.1)
    assert event.thickness_mm == (1.0, 1.5)


def test_a_jump_that_stiffens_is_not():
    stretched = sweep(Direction.WALE, STRAIN, -0.1 * STRAIN, [0.0, 0.1, 0.2, 0.3], jumps=(2,))
    assert find_buckling(stretched) == ()
