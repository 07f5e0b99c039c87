"""A measured bias strip, whose data are no part of the product."""

from pathlib import Path

import numpy as np
import pytest

from studies.graded_jersey import BOTH, STRAINS, band, graded


@pytest.mark.parametrize(("coupled", "at_30_percent"), [(False, 0.37), (True, 0.66)])
def test_one_shear_modulus_has_the_force_of_a_measured_bias_strip(
    study_data: Path, *, coupled: bool, at_30_percent: float
) -> None:
    """Jersey needs a shear modulus of a quarter to a half of the mean of Young's moduli. Where
    stretch along the rows stiffens the columns, the force then holds up to 20 %.
    """
    test = graded(study_data / "graded", poisson=0.3, coupled=coupled)
    ratio = test.matching_ratio(100.0)
    assert 0.25 < ratio < 0.5
    forces = np.array(test.bias_force(ratio, 100.0, STRAINS)) / test.force_n
    assert forces[:2] == pytest.approx(1.0, abs=0.1)
    assert (abs(forces[2] - 1) < 0.15) == coupled
    assert forces[3] == pytest.approx(at_30_percent, abs=0.05)


def test_halves_side_by_side_carry_their_measured_force(study_data: Path) -> None:
    """Cloth of two loop lengths, by laws fitted to either alone."""
    folder = study_data / "graded"
    low, high = (
        graded(folder, poisson=0.3, ends=(end,)).side_by_side_force(STRAINS[:3]) for end in BOTH
    )
    least, most = (band(folder, "discont4.5to6.5_ww", STRAINS[:3], (end,)) for end in BOTH)
    assert np.all(np.minimum(low, high) < most)
    assert np.all(np.maximum(low, high) > least)
