"""Drape of isotropic sheets: a plate that hardly bends, and cloth as measured by Cusick."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from knitcore.base.errors import InputError
from knitcore.cloth.space.drape import DISC_MM, PIECE_MM, drape
from knitcore.cloth.space.even_cloth import EvenCloth

WEIGHT = 2e-6


def _isotropic(bending_length_mm: float) -> EvenCloth:
    """A plate without contraction across: D₆₆ is half of D, G half of C. Its stiffness in
    the plane is so low that rectangles of 7.5 mm do not lock, and still stretches by 1 % only."""
    rigidity = WEIGHT * bending_length_mm**3
    return EvenCloth(
        stitch_mm=(2.0, 2.0),
        membrane_n_per_mm=(0.02, 0.02, 0.0, 0.01),
        rigidity_n_mm=(rigidity, rigidity),
        twist_n_mm=0.5 * rigidity,
        curvature_per_mm=(0.0, 0.0),
        thickness_mm=1.0,
        weight_n_per_mm2=WEIGHT,
    )


def _ring_fall(cloth: EvenCloth) -> float:
    """Fall of the rim of a ring clamped inside, small deflection (Timoshenko, Woinowsky-Krieger,
    "Theory of plates and shells", chapter 3): w = q r⁴ / 64 D + A + B ln r + C r² + E r² ln r."""
    inner, outer = 0.5 * DISC_MM, 0.5 * PIECE_MM
    load = cloth.weight_n_per_mm2 / cloth.rigidity_n_mm[0]
    deflection = np.array([1.0, np.log(inner), inner**2, inner**2 * np.log(inner)])
    slope = np.array([0.0, 1 / inner, 2 * inner, inner * (2 * np.log(inner) + 1)])
    bending = np.array([0.0, -1 / outer**2, 2.0, 2 * np.log(outer) + 3])
    shear = np.array([0.0, 0.0, 0.0, 4 / outer])
    own = load * np.array([inner**4 / 64, inner**3 / 16, 3 * outer**2 / 16, outer / 2])
    a, b, c, e = np.linalg.solve([deflection, slope, bending, shear], -own)
    edge = load * outer**4 / 64 + a + b * np.log(outer) + c * outer**2
    return float(edge + e * outer**2 * np.log(outer))


def test_a_stiff_plate_falls_as_in_theory() -> None:
    cloth = _isotropic(150.0)
    found = drape(cloth, across=30, starts=(0,))
    assert found.converged
    assert -found.corners_mm[15, -1, 2] == pytest.approx(_ring_fall(cloth), rel=0.1)
    assert found.coefficient > 0.99


def test_softer_cloth_drapes_more_and_has_more_folds() -> None:
    found = [drape(_isotropic(length), across=16, starts=(6,)) for length in (15.0, 30.0, 60.0)]
    assert all(one.converged for one in found)
    assert all(low.coefficient < high.coefficient for low, high in pairwise(found))
    assert found[0].folds >= 4
    assert found[-1].folds <= 2


@pytest.mark.slow
@pytest.mark.parametrize("bending_length_cm", [1.0, 2.0])
def test_isotropic_cloth_drapes_as_cusick_measured(bending_length_cm: float) -> None:
    """His regression over 130 fabrics, DC = 35.6 c − 3.61 c² − 2.59 A + 0.0461 A² + 17.0 per cent,
    with a shear angle A of 10°, within 7 of 100."""
    c, angle = bending_length_cm, 10.0
    expected = 35.6 * c - 3.61 * c**2 - 2.59 * angle + 0.0461 * angle**2 + 17.0
    found = drape(_isotropic(10.0 * c), across=40, starts=(6,))
    assert found.converged
    assert 100.0 * found.coefficient == pytest.approx(expected, abs=7.0)


def test_outside_the_piece_there_is_nothing() -> None:
    found = drape(_isotropic(30.0), across=12, starts=(4,))
    assert np.isnan(found.corners_mm[0, 0]).all()
    assert np.isfinite(found.corners_mm[6]).all()


@pytest.mark.parametrize(("disc", "across"), [(300.0, 20), (180.0, 200)])
def test_impossible_tests_are_refused(disc: float, across: int) -> None:
    with pytest.raises(InputError):
        drape(_isotropic(30.0), disc_mm=disc, across=across)
